/**
 * The connection, off the page's thread: socket, decoding, replies by id, reconnecting.
 *
 * From the page: {kind: 'open', server, scene}, {kind: 'remember', scene}, {kind: 'retry'}, {kind: 'request', key, message}.
 * To the page:
 *   {kind: 'state', state: 'connecting'}
 *   {kind: 'state', state: 'open'}
 *   {kind: 'state', state: 'lost', reason, retryMs}       tries again by itself
 *   {kind: 'state', state: 'refused', reason, scenes}     there is no such scene; waits for another 'open'
 *   {kind: 'message', message}                            a server message that is no reply
 *   {kind: 'reply', key, message | error}
 *   {kind: 'frame', frame, arrivedMs, bytes}              its arrays are transferred
 */
import {Backoff} from './backoff.js';
import {connect, decodeFrame} from './protocol/weft.js';

const kBeatMs = 5000;       // between two pings
const kSilenceMs = 12000;   // no answer for so long: the connection is dead, whatever the socket thinks
const kListMs = 4000;

const now = () => performance.timeOrigin + performance.now();

const backoff = new Backoff();
let server = null;
let scene = null;
let connection = null;
let attempt = 0;       // counts openings; whatever belongs to an older one is ignored
let retryTimer = null;
let beatTimer = null;

self.addEventListener('message', ({data}) => {
  switch (data.kind) {
    case 'open':
      ({server, scene} = data);
      backoff.reset();
      open();
      break;
    case 'remember':
      scene = data.scene;
      break;
    case 'retry':
      if (retryTimer !== null) open();
      break;
    case 'request':
      request(data.key, data.message);
      break;
  }
});

/** The scenes' names, or null when they cannot be had: another origin may not let a page read them. */
async function listScenes() {
  try {
    const address = `${server.replace(/^ws/, 'http')}/v1/scenes`;
    const answer = await fetch(address, {signal: AbortSignal.timeout(kListMs)});
    return answer.ok ? (await answer.json()).scenes : null;
  } catch {
    return null;
  }
}

async function open() {
  clearTimeout(retryTimer);
  retryTimer = null;
  const mine = ++attempt;
  tell('connecting');
  let reached = false;
  try {
    if (scene === null) {
      const scenes = await listScenes();
      if (mine !== attempt) return;
      if (!scenes?.length) throw new Error('list');
      scene = scenes[0].name;
    }
    const opened = await connect(`${server}/v1/scenes/${encodeURIComponent(scene)}`, {
      onMessage: (message) => mine === attempt && self.postMessage({kind: 'message', message}),
      onFrame: (frame, bytes) => mine === attempt && passOn(frame, bytes),
      onClose: (event) => mine === attempt && reached && lost(reasonOf(event)),
    });
    if (mine !== attempt) return opened.close();
    connection = opened;
    reached = true;
    backoff.reset();
    tell('open');
    beat(mine);
  } catch {
    if (mine === attempt) await failed(mine);
  }
}

/** A connection did not come about: for good, when the server answers but has no such scene. */
async function failed(mine) {
  const scenes = await listScenes();
  if (mine !== attempt) return;
  if (scenes && scene !== null && !scenes.some(({name}) => name === scene)) {
    tell('refused', {reason: `This server has no scene “${scene}”. Choose one from the list.`, scenes});
  } else {
    lost(`No answer from ${new URL(server).host}.`);
  }
}

function lost(reason) {
  attempt += 1;
  clearTimeout(beatTimer);
  connection?.close();
  connection = null;
  const retryMs = backoff.next();
  retryTimer = setTimeout(open, retryMs);
  tell('lost', {reason, retryMs});
}

function reasonOf({code}) {
  return code === 1001 ? 'The server is stopping.' : 'The connection was lost.';
}

/** Asks for an answer every few seconds: measures the round trip, and notices a connection that died without a word. */
async function beat(mine) {
  const sent = performance.now();
  const silence = setTimeout(() => mine === attempt && lost('The server has fallen silent.'), kSilenceMs);
  try {
    await connection.request({op: 'ping', t: sent});
    self.postMessage({kind: 'message', message: {op: 'round_trip', ms: performance.now() - sent}});
  } catch {
    return;  // closed: onClose tells
  } finally {
    clearTimeout(silence);
  }
  if (mine === attempt) beatTimer = setTimeout(() => mine === attempt && beat(mine), kBeatMs);
}

async function request(key, message) {
  try {
    if (!connection) throw Object.assign(new Error('not connected'), {code: 'closed'});
    self.postMessage({kind: 'reply', key, message: await connection.request(message)});
  } catch (error) {
    self.postMessage({kind: 'reply', key, error: {message: error.message, code: error.code ?? 'closed', path: error.path}});
  }
}

function passOn(frame, bytes) {
  const buffers = frame.cloths.map(({positions}) => positions.buffer);
  self.postMessage({kind: 'frame', frame, bytes, arrivedMs: now()}, buffers);
}

function tell(state, more = {}) {
  self.postMessage({kind: 'state', state, ...more});
}
