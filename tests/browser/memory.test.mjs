// Minutes of a page that is used: what its heaps keep, the page's and its worker's, and its elements stay what they were.
// WEFT_MINUTES=3 node --test memory.test.mjs
import assert from 'node:assert/strict';
import {test} from 'node:test';
import {hide, openScene, startServer, stats, until} from './harness.mjs';

const kMinutes = Number(process.env.WEFT_MINUTES ?? 10);
const kWarm = 0.3;  // the share of the time after which the page has made all that it keeps: compiled code, textures, caches
/** Less than 64 bytes for each of 60 frames a second: an object that a frame leaves behind is larger. */
const kMostBytes = 64 * 60 * 60 * kMinutes * (1 - kWarm);

/** Of a heap's snapshot what a page's own objects are. Compiled code and the browser's lists of its own timings come and go. */
const kOwn = new Set(['object', 'array', 'string', 'concatenated string', 'sliced string', 'closure', 'regexp', 'number', 'symbol', 'bigint']);
const kBuffers = 'system / JSArrayBufferData';

/** The bytes of the page's own objects and buffers; a snapshot begins with a collection of all garbage. */
async function ownBytes(hand) {
  let text = '';
  const add = ({chunk}) => (text += chunk);
  hand.on('HeapProfiler.addHeapSnapshotChunk', add);
  await hand.send('HeapProfiler.takeHeapSnapshot', {reportProgress: false});
  hand.off('HeapProfiler.addHeapSnapshotChunk', add);
  const {snapshot: {meta}, nodes, strings} = JSON.parse(text);
  const [type, name, size] = ['type', 'name', 'self_size'].map((field) => meta.node_fields.indexOf(field));
  let sum = 0;
  for (let at = 0; at < nodes.length; at += meta.node_fields.length) {
    if (kOwn.has(meta.node_types[type][nodes[at + type]]) || strings[nodes[at + name]] === kBuffers) sum += nodes[at + size];
  }
  return sum;
}

/** What is kept after a collection of all garbage, by the page and its workers. */
async function kept(hand, workers) {
  const heapOf = async (send) => {
    for (let i = 0; i < 2; ++i) await send('HeapProfiler.collectGarbage');
    return (await send('Runtime.getHeapUsage')).usedSize;
  };
  const theirs = await Promise.all([...workers.values()].map(heapOf));
  const bytes = await ownBytes(hand);
  const {nodes, jsEventListeners: listeners} = await hand.send('Memory.getDOMCounters');
  return {bytes, workers: theirs.reduce((sum, each) => sum + each, 0), nodes, listeners};
}

/** The workers of a page as functions that send a command of the protocol: a map that grows and shrinks with them. */
async function workersOf(hand) {
  const workers = new Map(), waiting = new Map();
  let last = 0;
  hand.on('Target.attachedToTarget', ({sessionId}) => workers.set(sessionId, (method) => new Promise((resolve) => {
    waiting.set(++last, resolve);
    hand.send('Target.sendMessageToTarget', {sessionId, message: JSON.stringify({id: last, method})});
  })));
  hand.on('Target.detachedFromTarget', ({sessionId}) => workers.delete(sessionId));
  hand.on('Target.receivedMessageFromTarget', ({message}) => {
    const {id, result} = JSON.parse(message);
    waiting.get(id)?.(result);
    waiting.delete(id);
  });
  await hand.send('Target.setAutoAttach', {autoAttach: true, waitForDebuggerOnStart: false, flatten: false});
  return workers;
}

/** What a viewer does in some seconds, and leaves as it was. */
async function use(page) {
  for (const key of ['1', '3', '2']) {
    await page.keyboard.press(key);
    const {frames} = await stats(page);
    await until(page, (before) => weft.stats.frames > before + 20, frames);
  }
  await page.fill('#wind-speed', '9');
  await until(page, () => weft.stats.wind.speed === 9);
  await page.click('#ball-add');
  await until(page, () => weft.stats.balls.length === 1);
  await page.click('#ball-throw');
  await until(page, () => weft.stats.balls[0]?.motion === 'dynamic');
  await page.click('#ball-remove');
  await until(page, () => weft.stats.balls.length === 0);
  await page.click('#wireframe');
  await page.click('#wireframe');
  await page.focus('#stage');
  await page.keyboard.press('r');
  await until(page, () => weft.stats.wind.speed !== 9);
  await hide(page, true);
  await until(page, () => !weft.stats.connected);
  await hide(page, false);
  await until(page, () => weft.stats.connected);
}

/** To the gallery, to another scene and back. */
async function goRound(page) {
  await page.click('#scenes');
  await page.waitForSelector('.card[data-scene=curtain][data-frames]');
  await page.click('.card[data-scene=curtain]');
  await until(page, () => weft.stats.connected && weft.stats.scene === 'curtain' && weft.stats.cloths.length > 0);
  await page.selectOption('#scene', 'flag');
  await until(page, () => weft.stats.connected && weft.stats.scene === 'flag' && weft.stats.cloths.length > 0);
}

test(`${kMinutes} minutes leave nothing behind`, async () => {
  const server = await startServer(['flag', 'curtain']);
  const {page, witness} = await openScene(server, 'flag');
  const hand = await page.context().newCDPSession(page);
  const workers = await workersOf(hand);
  const begin = Date.now(), at = (share) => begin + share * kMinutes * 60_000;
  let first = null, rounds = 0;
  while (Date.now() < at(1)) {
    await use(page);
    if (++rounds % 5 === 0) await goRound(page);
    if (first === null && Date.now() > at(kWarm) && rounds % 5 === 0) first = await kept(hand, workers);
  }
  await goRound(page);
  const last = await kept(hand, workers);
  console.log(`${rounds} rounds, ${(await stats(page)).frames} frames since the last; kept`, first, last);
  assert.ok(workers.size > 0, 'the worker is counted');
  assert.ok(last.bytes - first.bytes < kMostBytes, `the page keeps ${last.bytes - first.bytes} bytes more`);
  assert.ok(last.workers - first.workers < kMostBytes, `its workers keep ${last.workers - first.workers} bytes more`);
  assert.ok(last.nodes <= first.nodes + 50, `${last.nodes - first.nodes} elements more`);
  assert.ok(last.listeners <= first.listeners + 20, `${last.listeners - first.listeners} listeners more`);
  assert.deepEqual(witness.errors, []);
});
