// One scene held to several levels, side by side: what the server simulates, what the page tells of it, one camera for all.
import assert from 'node:assert/strict';
import {before, test} from 'node:test';
import {setTimeout as sleep} from 'node:timers/promises';
import {distanceBetween, splitsOf, withoutHeld} from '../../web/split/levels.js';
import {hide, kPatienceMs, openPage, openScene, startServer, until, viewersAre} from './harness.mjs';

const named = (...names) => names.map((name) => ({name}));

test('a split has the scenes that are held, where the scene itself is served; the gallery has the others', () => {
  const scenes = named('a', 'a-level-4', 'a-level-6', 'b-level-5', 'c', 'c-level-9');
  assert.deepEqual([...splitsOf(scenes)], [['a', [{scene: 'a-level-6', level: 6}, {scene: 'a-level-4', level: 4}]]]);
  assert.deepEqual(withoutHeld(scenes), named('a', 'b-level-5', 'c', 'c-level-9'));
});

test('two levels are compared at the nodes that both have', () => {
  const sheet = (nodes, raise) => ({
    rows: nodes, cols: nodes, origin: [0, raise, 0],
    positions: Float32Array.from({length: 3 * nodes * nodes}, (_, i) => (i % 3 === 0 ? (Math.floor(i / 3) % nodes) / (nodes - 1) : 0)),
  });
  assert.equal(distanceBetween(sheet(5, 0), sheet(3, 0)), 0);
  assert.equal(distanceBetween(sheet(5, 0.5), sheet(3, 0)), 0.5);  // all nodes by 0.5 m
  assert.equal(distanceBetween(sheet(5, 0), sheet(4, 0)), null);
});

let server, page, witness;
before(async () => {
  server = await startServer(['zheng2020-distance', 'fan', 'curtain'], {options: ['--split', '6,5,4']});
  ({page, witness} = await openScene(server, 'zheng2020-distance', {viewport: {width: 900, height: 420}}));
});

const told = () => page.$$eval('#split-panes figure', (figures) => figures.map((figure) =>
  [figure.querySelector('h2').textContent, ...[...figure.querySelectorAll('dd')].map(({textContent}) => textContent)]));
/** Waits until a condition holds for what is told: a list of [level, nodes, time of a step, time, distance]. */
async function tells(condition) {
  const endMs = Date.now() + kPatienceMs;
  let all;
  while ((all = await told()).length === 0 || !condition(all)) {
    if (Date.now() > endMs) throw new Error(`never told: ${condition}; told is ${JSON.stringify(all)}`);
    await sleep(50);
  }
  return all;
}

test('the scene leads to its levels, each with its nodes, its time and the time of a step', async () => {
  await page.click('#split');
  assert.equal(new URL(page.url()).searchParams.get('split'), 'zheng2020-distance');
  const all = await tells((panes) => panes.every(([, nodes, step]) => nodes !== '–' && / ms$/.test(step)));
  // 2^L + 1 nodes a side.
  assert.deepEqual(all.map(([level, nodes]) => [level, nodes]), [['Level 6', '4,225'], ['Level 5', '1,089'], ['Level 4', '289']]);
  await viewersAre(server, 3);
});

test('begun anew together, the coarser ones tell how far they are from the finest', async () => {
  await page.click('#split-reset');
  const all = await tells((panes) => panes.every(([, , , time]) => parseFloat(time) < 5) && panes.slice(1).every(([, , , , apart]) => / mm at \d/.test(apart)));
  assert.equal(all[0][4], '–');
});

test('paused, all stand still; and go on', async () => {
  await page.click('#split-pause');
  await sleep(1500);  // three times as long as between two looks
  const stood = (await told()).map(([, , , time]) => time);
  await sleep(1500);
  assert.deepEqual((await told()).map(([, , , time]) => time), stood);
  await page.click('#split-pause');
  await tells((panes) => panes.every(([, , , time], i) => time !== stood[i]));
});

test('all are seen from where the viewer goes with one of them', async () => {
  const shots = async () => Promise.all([0, 1, 2].map((i) => page.locator('#split-panes canvas').nth(i).screenshot()));
  const differ = (some, others) => some.map((shot, i) => !shot.equals(others[i]));
  await page.click('#split-pause');
  // The last frames may be on their way, and are moved to in steps: from two equal looks on nothing moves by itself.
  let before = await shots();
  for (let last = null; last === null || differ(last, before).includes(true);) {
    await sleep(500);
    [last, before] = [before, await shots()];
  }
  const box = await page.locator('#split-panes canvas').nth(1).boundingBox();
  await page.mouse.move(box.x + 80, box.y + 80);
  await page.mouse.wheel(0, 600);
  const endMs = Date.now() + kPatienceMs;
  let moved = [];
  while (!(moved = differ(await shots(), before)).every(Boolean) && Date.now() < endMs) await sleep(100);
  assert.deepEqual(moved, [true, true, true]);
  await page.click('#split-pause');
});

test('hidden it is not connected, and back in the gallery neither; there the held ones are no cards', async () => {
  await hide(page, true);
  await viewersAre(server, 0);
  await hide(page, false);
  await viewersAre(server, 3);
  await page.click('#split-back');
  await until(page, () => weft.stats.connected && weft.stats.scene === 'zheng2020-distance');
  await viewersAre(server, 1);
  await page.click('#scenes');
  await page.waitForSelector('.card');
  assert.deepEqual(await page.$$eval('.card', (cards) => cards.map(({dataset}) => dataset.scene)), ['zheng2020-distance', 'fan', 'curtain']);
});

test('a scene that is not held to levels is told', async () => {
  const {page: other} = await openPage(`${server.address}/?quality=low&split=nonsense`);
  await other.waitForSelector('#banner:not([hidden]) >> text=This server does not hold “nonsense” to several levels');
  await other.close();
});

test('the console is clean', () => assert.deepEqual(witness.errors, []));
