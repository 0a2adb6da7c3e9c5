/**
 * The connection, off the page's thread: socket, decoding and reconnecting (all of them protocol/clients/js), and what a page
 * needs beside: a plain word when there is no such scene, a pulse.
 *
 * From the page:
 *   {kind: 'open', server, scene, token}   connect; token null: none
 *   {kind: 'rest'}                  disconnect, and wait for another 'open'
 *   {kind: 'retry'}                 do not wait any longer
 *   {kind: 'request', key, message}
 *   {kind: 'taken'}                 the last frame has been taken: only then comes the next
 * To the page:
 *   {kind: 'state', state: 'connecting'}
 *   {kind: 'state', state: 'open'}
 *   {kind: 'state', state: 'lost', reason, retryMs}      tries again by itself
 *   {kind: 'state', state: 'refused', reason, scenes}    there is no such scene; waits for another 'open'
 *   {kind: 'state', state: 'locked', reason}             a token is needed, or another; waits for another 'open'
 *   {kind: 'state', state: 'resting'}                    as asked
 *   {kind: 'message', message}      a server message that is no reply, or {op: 'round_trip', ms}, or {op: 'surface', scene, obstacle,
 *                                   surface}: what one of the scene's meshes looks like
 *   {kind: 'reply', key, message | error}
 *   {kind: 'frame', frame, arrivedMs, ageMs, bytes}      its arrays are transferred; ageMs: since it was sent off, NaN before a pong
 */
import {WeftClient} from '../protocol/weft.js';
import {kUnknownToken, kNoToken, listScenes} from './scenes.js';

const kBeatMs = 5000;  // between two pings

/** The platform's socket, counting what comes. */
class CountingSocket extends WebSocket {
  static bytes = 0;
  constructor(...address) {
    super(...address);
    this.addEventListener('message', ({data}) => (CountingSocket.bytes += data.byteLength ?? data.length));
  }
}

let server = null;
let scene = null;
let token = null;
let client = null;       // whatever an older one says is ignored
let waits = false;       // between attempts, so that 'retry' means something
let taken = () => {};

self.addEventListener('message', ({data}) => {
  switch (data.kind) {
    case 'open':
      ({server, scene, token} = data);
      open();
      break;
    case 'rest':
      rest();
      break;
    case 'retry':
      if (waits) open();
      break;
    case 'request':
      request(data.key, data.message);
      break;
    case 'taken':
      taken();
      break;
  }
});

function open() {
  client?.close();
  const mine = (client = new WeftClient(`${server}/v1/scenes/${encodeURIComponent(scene)}`, {
    WebSocket: CountingSocket,
    client: 'weft page',
    token: token ?? undefined,
    reconnect: true,
    coarser: true,
    compact: true,
    local: true,
    onmessage: (message) => {
      if (mine !== client) return;
      self.postMessage({kind: 'message', message});
      if (message.op === 'scene') passOnSurfaces(mine, message);
    },
    onframe: (frame) => mine === client && passOn(frame),
    onstate: (state, why) => mine === client && follow(mine, state, why),
  }));
  waits = false;
  tell('connecting');
  mine.open().catch(() => {});  // fails only by close(), which is ours
}

/** Until another 'open' nothing is received, sent or tried. */
function rest() {
  client?.close();
  waits = false;
  taken();
  tell('resting');
}

/** Nothing is tried any more until the page gives another token. */
function lock(mine) {
  mine.close();
  waits = false;
  tell('locked', {reason: token ? kUnknownToken : kNoToken});
}

/** Asks for what the scene's meshes look like. One that does not come is not drawn. */
async function passOnSurfaces(mine, {name, obstacles = []}) {
  for (const [obstacle, {shape}] of obstacles.entries()) {
    if (shape !== 'mesh' && shape !== 'convex') continue;
    const surface = await mine.surface(obstacle).catch(() => null);
    if (mine !== client || mine.scene.name !== name) return;
    if (surface) self.postMessage({kind: 'message', message: {op: 'surface', scene: name, obstacle, surface}});
  }
}

async function follow(mine, state, {code, error, delay}) {
  if (state === 'open') {
    waits = false;
    tell('open');
    beat(mine);
  } else if (state === 'waiting' && error) {
    lost(delay, `No answer from ${new URL(server).host}.`);
    // A socket does not say why it was refused; the list does.
    const {scenes, locked} = await listScenes(server, token);
    if (mine !== client || mine.connected || !waits) return;
    if (locked) return lock(mine);
    if (!scenes || scenes.some(({name}) => name === scene)) return;
    mine.close();
    waits = false;
    tell('refused', {reason: `This server has no scene “${scene}”. Choose one from the list.`, scenes});
  } else if (state === 'waiting') {
    lost(delay, code === 1001 ? 'The server is stopping.' : 'The connection was lost.');
  }
}

function lost(retryMs, reason) {
  waits = true;
  taken();
  tell('lost', {reason, retryMs});
}

/** Asks for an answer every few seconds: measures the round trip, and notices a connection that died without a word. */
async function beat(mine) {
  try {
    const ms = await mine.ping();
    if (mine === client) self.postMessage({kind: 'message', message: {op: 'round_trip', ms}});
  } catch (error) {
    if (mine !== client || error.code !== 'timeout') return;  // closed: `follow` hears of it
    lost(0, 'The server has fallen silent.');
    open();
    return;
  }
  setTimeout(() => mine === client && mine.connected && beat(mine), kBeatMs);
}

async function request(key, message) {
  const {op, ...members} = message;
  try {
    const answer = op === 'scene.join' ? await join(members.scene) : await client.send(op, members);
    self.postMessage({kind: 'reply', key, message: answer});
  } catch ({message: text, code, path}) {
    self.postMessage({kind: 'reply', key, error: {message: text, code, path}});
  }
}

async function join(name) {
  const answer = await client.joinScene(name);
  scene = name;
  return answer;
}

/** Done when the page has taken the frame: until then newer ones replace each other here instead of queueing up there. */
function passOn(frame) {
  const arrivedMs = performance.timeOrigin + performance.now();
  const buffers = frame.cloths.map(({positions}) => positions.buffer);
  self.postMessage({kind: 'frame', frame, arrivedMs, ageMs: client.age(frame), bytes: CountingSocket.bytes}, buffers);
  CountingSocket.bytes = 0;
  return new Promise((resolve) => (taken = resolve));
}

function tell(state, more = {}) {
  self.postMessage({kind: 'state', state, ...more});
}
