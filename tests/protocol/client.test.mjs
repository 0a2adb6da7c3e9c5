// The JavaScript client against a small server of its own: what it sends, acknowledges, refuses, and how it comes back.
import assert from 'node:assert/strict';
import { once } from 'node:events';
import { cpSync, mkdtempSync, rmSync, symlinkSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { afterEach, test } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';

import { WebSocket, WebSocketServer } from 'ws';

import { backoff, connect, WeftClient, WeftError } from '../../protocol/clients/js/weft.js';
import { frames, fromHex, serverMessages } from './vectors.mjs';

const welcome = serverMessages.good.find(({ op }) => op === 'welcome');
const scene = serverMessages.good.find(({ op }) => op === 'scene');
const frameBytes = (name) => fromHex(frames.good.find((vector) => vector.name === name).hex);

/** A frame whose header says step `f`, sent at `serverMs`. */
function frameOf(f, serverMs = 4115200) {
  const bytes = frameBytes('small');
  new DataView(bytes.buffer).setUint32(16, f, true);
  new DataView(bytes.buffer).setUint32(32, serverMs, true);
  return bytes;
}

const open = [];
afterEach(async () => {
  for (const end of open.splice(0).reverse()) await end();
});

/**
 * A server that greets and answers as `answer(message, socket)` says; null: not at all. `received` holds all messages.
 * `expect(op)` gives the next message of that op, waiting for it where it has not come yet.
 */
async function serve({ answer = () => ({}), afterHello = () => {}, afterConnection = () => {}, greet = true, port = 0, ...options } = {}) {
  const server = new WebSocketServer({ host: '127.0.0.1', port, handleProtocols: () => 'weft.v1', ...options });
  await once(server, 'listening');
  const stop = async () => {
    for (const socket of server.clients) socket.terminate();
    if (server.address()) await new Promise((resolve) => { server.close(resolve); });
  };
  open.push(stop);
  const received = [], waiting = [], sockets = [];
  const deliver = () => {
    for (const wait of [...waiting]) {
      const at = received.findIndex(({ op }) => op === wait.op);
      if (at < 0) continue;
      waiting.splice(waiting.indexOf(wait), 1);
      wait.resolve(received.splice(at, 1)[0]);
    }
  };
  server.on('connection', (socket, request) => {
    sockets.push(Object.assign(socket, { path: request.url }));
    socket.on('message', (data) => {
      const message = JSON.parse(data);
      received.push(message);
      const extra = message.op === 'hello' ? { caps: message.caps ?? [] } : answer(message, socket);
      if (message.id && extra) socket.send(JSON.stringify({ op: 'ok', re: message.id, f: 1, ...extra }));
      if (message.op === 'hello') afterHello(socket);
      deliver();
    });
    if (greet) for (const message of [welcome, scene]) socket.send(JSON.stringify(message));
    afterConnection(socket);
  });
  return {
    url: `ws://127.0.0.1:${server.address().port}/v1/scenes/flag`, port: server.address().port, sockets, received, stop,
    expect: (op) => new Promise((resolve) => { waiting.push({ op, resolve }); deliver(); }),
  };
}

/** A client that is closed when the test ends. */
async function join(server, options = {}) {
  const client = await connect(server.url, { WebSocket, ...options });
  open.push(async () => client.close());
  return client;
}

test('connects with hello, and knows the welcome and the scene', async () => {
  const server = await serve();
  const client = await join(server, { client: 'test', window: 3 });
  assert.deepEqual(client.welcome, welcome);
  assert.deepEqual(client.scene, scene);
  assert.equal(client.connected, true);
  assert.deepEqual(await server.expect('hello'), { op: 'hello', id: 1, client: 'test', caps: ['flow.ack'], window: 3 });
  assert.equal(server.sockets[0].protocol, 'weft.v1');
});

test('asks for coarser levels only if told to', async () => {
  const server = await serve();
  await join(server, { coarser: true, window: 0 });
  assert.deepEqual(await server.expect('hello'), { op: 'hello', id: 1, caps: ['flow.level'] });
});

test('asks for compact frames only if told to', async () => {
  const server = await serve();
  await join(server, { compact: true, window: 0 });
  assert.deepEqual(await server.expect('hello'), { op: 'hello', id: 1, caps: ['grid.rice'] });
});

test('closed while its socket is made, it makes no connection', async () => {
  const server = await serve();
  const states = [];
  const client = new WeftClient(server.url, { WebSocket, onstate: (state) => states.push(state) });
  const opening = client.open();
  client.close();
  await assert.rejects(opening, { code: 'closed' });
  const after = await join(server);
  assert.equal(server.sockets.filter((socket) => socket.readyState === 1).length, 1);  // this one alone
  assert.equal(client.connected, false);
  assert.ok(!states.includes('open'), states.join());
  after.close();
});

test('in Node the package ws is taken from where the client is installed', { skip: 'WebSocket' in globalThis && 'the platform has a WebSocket' }, async () => {
  const folder = mkdtempSync(path.join(tmpdir(), 'weft-client-'));
  open.push(async () => rmSync(folder, { recursive: true }));
  cpSync(new URL('../../protocol/clients/js', import.meta.url), folder, { recursive: true, filter: (name) => !name.endsWith('node_modules') });
  symlinkSync(fileURLToPath(new URL('../node_modules', import.meta.url)), path.join(folder, 'node_modules'));
  const installed = await import(pathToFileURL(path.join(folder, 'weft.js')).href);
  const server = await serve();
  const client = await installed.connect(server.url);
  open.push(async () => client.close());
  assert.deepEqual(client.welcome, welcome);
});

test('the surface of a mesh is asked for beside the scene', async () => {
  const asked = [], surface = { vertices: [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1], triangles: [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3] };
  const http = createServer((request, response) => {
    asked.push(request.url);
    response.statusCode = request.url.endsWith('/1') ? 200 : 404;
    response.end(request.url.endsWith('/1') ? JSON.stringify(surface) : 'there is no such mesh');
  }).listen(0, '127.0.0.1');
  open.push(() => http.closeAllConnections() ?? http.close());
  const client = await join(await serve({ port: null, server: http }));
  assert.deepEqual(await client.surface(1), surface);
  await assert.rejects(client.surface(2), { code: 'not_found', message: 'there is no such mesh' });
  assert.deepEqual(asked, [1, 2].map((obstacle) => `/v1/scenes/${scene.name}/meshes/${obstacle}`));
});

test('each method sends its operation', async () => {
  const answers = { 'ball.add': { ball: 7 }, 'cloth.grab': { grab: 3 }, 'obstacle.grab': { grab: 4 }, 'scene.list': { scenes: [{ name: 'flag' }] }, ping: { op: 'pong' } };
  const server = await serve({ answer: ({ op }) => answers[op] ?? {} });
  const client = await join(server, { window: 0 });
  await client.camera({ distance: 5 });
  await client.camera({ eye: [0, 1, 2] });
  await client.camera({ eye: [0, 1, 2], target: [0, 1, 0], halfAngle: 0.5 });
  assert.equal(await client.addBall([0, 1, 2], 0.2), 7);
  await client.addBall([0, 1, 2], 0.2, { friction: 0.5 });
  await client.moveBall(7, [1, 1, 1]);
  await client.throwBall(7, [0, 0, -6]);
  await client.removeBall(7);
  await client.moveObstacle(0, [0, 1, 0]);
  await client.moveObstacle(1, [0, 1, 0], { quaternion: [0, 1, 0, 0] });
  await client.throwObstacle(0, [0, 1, 0]);
  await client.throwObstacle(1, [0, 1, 0], { spin: [0, 2, 0] });
  assert.equal(await client.grab(0, 0.5, 1, { maxForce: 20 }), 3);
  assert.equal(await client.grabObstacle(2), 4);
  assert.equal(await client.grabObstacle(1, { point: [0, 0.1, 0], position: [0, 1, 0], maxForce: 20 }), 4);
  await client.moveGrab(3, [0, 1, 0]);
  await client.release(3);
  await client.pin(0, 0.5, 1);
  await client.unpin(0, 0.5, 1);
  await client.tuneCloth(1, { structural: 250, rigidity: [1e-5, 2e-5, 0] });
  await client.setFriction(0.4, { ball: 7 });
  await client.setFriction(0.5, { obstacle: 0 });
  await client.setFriction(0);
  await client.setEffect('gravity', false);
  await client.tuneEffect('gravity', { acceleration: [0, -1.62, 0] });
  await client.setWind([0, 0, -1], 3);
  await client.setWind([0, 0, -1], 3, { gusts: 0.25 });
  await client.setWind([0, 0, -1], 3, { turbulence: 0.5 });
  await client.setWind([0, 0, -1], 3, { timeScale: 2, lengthScale: 0.2 });
  await client.setWindZone(1, [0, 0, -2]);
  await client.setQuality({ maxError: 0.01 });
  await client.setQuality({ maxMs: 2 });
  await client.setQuality();
  await client.askCost();
  await client.pause();
  await client.step(2);
  await client.resume();
  await client.reset();
  assert.deepEqual(await client.listScenes(), [{ name: 'flag' }]);
  assert.ok(await client.ping() >= 0);
  await client.joinScene('curtain');
  const sent = server.received.map(({ id, ...message }) => message);
  assert.equal(typeof sent.at(-2).t, 'number');
  delete sent.at(-2).t;
  assert.deepEqual(sent, [
    { op: 'camera', distance: 5 }, { op: 'camera', eye: [0, 1, 2] },
    { op: 'camera', eye: [0, 1, 2], target: [0, 1, 0], half_angle: 0.5 }, { op: 'ball.add', position: [0, 1, 2], radius: 0.2 },
    { op: 'ball.add', position: [0, 1, 2], radius: 0.2, friction: 0.5 },
    { op: 'ball.move', ball: 7, position: [1, 1, 1] }, { op: 'ball.throw', ball: 7, velocity: [0, 0, -6] }, { op: 'ball.remove', ball: 7 },
    { op: 'obstacle.move', obstacle: 0, position: [0, 1, 0] }, { op: 'obstacle.move', obstacle: 1, position: [0, 1, 0], quaternion: [0, 1, 0, 0] },
    { op: 'obstacle.throw', obstacle: 0, velocity: [0, 1, 0] }, { op: 'obstacle.throw', obstacle: 1, velocity: [0, 1, 0], spin: [0, 2, 0] },
    { op: 'cloth.grab', cloth: 0, u: 0.5, v: 1, max_force: 20 }, { op: 'obstacle.grab', obstacle: 2 },
    { op: 'obstacle.grab', obstacle: 1, point: [0, 0.1, 0], position: [0, 1, 0], max_force: 20 }, { op: 'grab.move', grab: 3, position: [0, 1, 0] }, { op: 'grab.release', grab: 3 },
    { op: 'cloth.pin', cloth: 0, u: 0.5, v: 1 }, { op: 'cloth.unpin', cloth: 0, u: 0.5, v: 1 },
    { op: 'cloth.tune', cloth: 1, parameters: { structural: 250, rigidity: [1e-5, 2e-5, 0] } },
    { op: 'friction.set', friction: 0.4, ball: 7 }, { op: 'friction.set', friction: 0.5, obstacle: 0 }, { op: 'friction.set', friction: 0 },
    { op: 'effect.set', effect: 'gravity', on: false },
    { op: 'effect.tune', effect: 'gravity', parameters: { acceleration: [0, -1.62, 0] } },
    { op: 'wind.set', direction: [0, 0, -1], speed: 3 }, { op: 'wind.set', direction: [0, 0, -1], speed: 3, gusts: 0.25 },
    { op: 'wind.set', direction: [0, 0, -1], speed: 3, turbulence: 0.5 },
    { op: 'wind.set', direction: [0, 0, -1], speed: 3, time_scale: 2, length_scale: 0.2 }, { op: 'wind.zone.set', zone: 1, velocity: [0, 0, -2] }, { op: 'quality', max_error: 0.01 }, { op: 'quality', max_ms: 2 },
    { op: 'quality' }, { op: 'cost' }, { op: 'pause' }, { op: 'step', count: 2 }, { op: 'resume' }, { op: 'reset' },
    { op: 'scene.list' }, { op: 'ping' }, { op: 'scene.join', scene: 'curtain' }]);
  assert.deepEqual(server.received.map(({ id }) => id), sent.map((_, i) => i + 1), 'ids are counted');
});

test('an error becomes a WeftError with code and path, and the connection goes on', async () => {
  const refusal = { op: 'error', code: 'range', path: '/speed', message: '/speed is 1000; allowed: 0..100 (m/s)' };
  const server = await serve({ answer: ({ op }) => (op === 'wind.set' ? refusal : {}) });
  const client = await join(server);
  await assert.rejects(client.setWind([0, 0, -1], 1000), (error) => error instanceof WeftError && error.code === 'range' &&
    error.path === '/speed' && error.message === refusal.message);
  assert.equal((await client.pause()).op, 'ok');
});

test('answers find their requests in any order', async () => {
  const held = [];
  const server = await serve({ answer: (message, socket) => { held.push({ message, socket }); return null; } });
  const client = await join(server, { window: 0 });
  const answers = Promise.all([client.send('ping', { t: 1 }), client.send('ping', { t: 2 })]);
  await server.expect('ping');
  await server.expect('ping');
  for (const { message, socket } of held.reverse()) socket.send(JSON.stringify({ op: 'pong', re: message.id, t: message.t, f: 1, time: 0 }));
  assert.deepEqual((await answers).map(({ t }) => t), [1, 2]);
});

test('a ping tells how old frames are', async () => {
  const server = await serve({ answer: ({ id, t }) => ({ op: 'pong', re: id, t, f: 1, time: 0, server_ms: 2 ** 32 - 50 }) });
  const client = await join(server, { window: 0 });
  const frame = (serverMs) => ({ stamp: { serverMs } });
  assert.ok(Number.isNaN(client.age(frame(0))));
  const roundTrip = await client.ping();
  const since = client.age(frame(2 ** 32 - 50));  // the pong's own time
  assert.ok(since >= 0 && since <= roundTrip + 1000, `${since}`);
  assert.ok(Math.abs(client.age(frame(2 ** 32 - 60050)) - since - 60000) < 5000);
  assert.ok(Math.abs(client.age(frame(59950)) - since + 60000) < 5000);  // its clock has wrapped round since
});

test('frames are decoded, handed over and acknowledged in turn', async () => {
  const server = await serve();
  const seen = [];
  const client = await join(server, { onframe: (frame) => { seen.push(frame.stamp.f); } });
  for (const f of [5, 6]) {
    server.sockets[0].send(frameOf(f));
    assert.deepEqual(await server.expect('ack'), { op: 'ack', f });
  }
  assert.deepEqual(seen, [5, 6]);
  assert.equal(client.frame.stamp.f, 6);
});

test('while a handler is busy the newest frame replaces older ones, and nothing is acknowledged', async () => {
  const server = await serve();
  const seen = [];
  let release;
  const busy = new Promise((resolve) => { release = resolve; });
  const client = await join(server, { onframe: (frame) => { seen.push(frame.stamp.f); return frame.stamp.f === 1 ? busy : undefined; } });
  for (const f of [1, 2, 3, 4]) server.sockets[0].send(frameOf(f));
  await client.pause();  // answered after the frames: they have all come
  assert.deepEqual(seen, [1]);
  assert.equal(server.received.filter(({ op }) => op === 'ack').length, 0);
  release();
  assert.deepEqual(await server.expect('ack'), { op: 'ack', f: 1 });
  assert.deepEqual(await server.expect('ack'), { op: 'ack', f: 4 });
  assert.deepEqual(seen, [1, 4]);
});

test('what waited until the program read again is passed over for a newer frame, if there is one', async () => {
  const server = await serve();
  const seen = [];
  await join(server, { onframe: (frame) => { seen.push(frame.stamp.f); } });
  // The server's clock wraps round before the third; behind the last one nothing comes.
  for (const [f, serverMs] of [[1, 2 ** 32 - 2000], [2, 2 ** 32 - 7000], [3, 0], [4, 2 ** 32 - 5000]]) {
    server.sockets[0].send(frameOf(f, serverMs));
    assert.deepEqual(await server.expect('ack'), { op: 'ack', f });
  }
  while (seen.length < 3) await new Promise((resolve) => { setTimeout(resolve, 10); });
  assert.deepEqual(seen, [1, 3, 4]);
});

test('a frame right behind the answer to hello is acknowledged, even with a window of one', async () => {
  const server = await serve({ afterHello: (socket) => socket.send(frameOf(9)) });
  await join(server, { window: 1 });
  assert.deepEqual(await server.expect('ack'), { op: 'ack', f: 9 });
});

test('without flow control nothing is acknowledged', async () => {
  const server = await serve();
  const client = await join(server, { window: 0 });
  server.sockets[0].send(frameOf(3));
  assert.equal((await client.nextFrame()).stamp.f, 3);
  await client.pause();
  assert.deepEqual(server.received.map(({ op }) => op), ['pause']);
});

test('a malformed frame and a failing handler go to onerror; the next frame is handled', async () => {
  const server = await serve();
  const errors = [];
  const client = await join(server, {
    onerror: (error) => errors.push(error.message),
    onframe: (frame) => { if (frame.stamp.f === 1) throw new Error('handler failed'); },
  });
  server.sockets[0].send(fromHex('00'));
  await client.pause();
  server.sockets[0].send(frameOf(1));
  await client.pause();
  server.sockets[0].send(frameOf(2));
  await client.nextFrame(({ stamp }) => stamp.f === 2);
  assert.deepEqual(errors, ['header cut short', 'handler failed']);
});

test('nextFrame waits for the frame it is asked for, and no longer than it may', async () => {
  const server = await serve();
  const client = await join(server);
  const wanted = client.nextFrame(({ stamp }) => stamp.f >= 3);
  for (const f of [1, 2, 3]) {
    server.sockets[0].send(frameOf(f));
    await server.expect('ack');
  }
  assert.equal((await wanted).stamp.f, 3);
  await assert.rejects(client.nextFrame(() => false, 20), { code: 'timeout' });
});

test('messages that answer nothing go to onmessage, and a new scene is remembered', async () => {
  const server = await serve();
  const heard = [];
  const client = await join(server, { onmessage: ({ op }) => heard.push(op) });
  const other = { ...scene, name: 'curtain' };
  for (const message of [...serverMessages.good.filter(({ op }) => op === 'event' || op === 'stats' || op === 'notice'), other])
    server.sockets[0].send(JSON.stringify(message));
  await client.pause();
  assert.deepEqual([...new Set(heard)], ['welcome', 'scene', 'event', 'stats', 'notice']);
  assert.equal(client.scene.name, 'curtain');
});

test('a request without answer fails after the time it was given', async () => {
  const server = await serve({ answer: () => null });
  const client = await join(server, { timeout: 1000 });  // long enough for the hello on a busy machine
  await assert.rejects(client.pause(), { code: 'timeout' });
});

test('a server that does not greet is given up in time', async () => {
  const server = await serve({ greet: false });
  await assert.rejects(connect(server.url, { WebSocket, timeout: 50 }), { code: 'timeout' });
});

test('no server, and a server that refuses, are told apart from time running out', async () => {
  const server = await serve({ verifyClient: (_, done) => done(false, 404) });
  await assert.rejects(connect(server.url, { WebSocket }), (error) => error.code === 'connect' && /404/.test(error.message));
  await server.stop();
  await assert.rejects(connect(server.url, { WebSocket }), (error) => error.code === 'connect' && /ECONNREFUSED/.test(error.message));
});

test('a connection lost during hello fails at once', async () => {
  // One that greets, and hangs up on the first message.
  const server = await serve({ greet: false, afterConnection: (socket) => {
    for (const message of [welcome, scene]) socket.send(JSON.stringify(message));
    socket.removeAllListeners('message').on('message', () => socket.terminate());
  } });
  await assert.rejects(connect(server.url, { WebSocket, timeout: 60000 }), { code: 'closed' });
});

test('without reconnect a lost connection is the end: requests fail, and it is told', async () => {
  const server = await serve({ answer: (_, socket) => { socket.close(1001, 'the server stops'); return null; } });
  const states = [];
  const client = await join(server, { onstate: (state, { code, reason }) => states.push([state, code, reason]) });
  const waiter = client.nextFrame();
  const outcome = assert.rejects(waiter, { code: 'closed' });
  await assert.rejects(client.pause(), (error) => error.code === 'closed' && /1001: the server stops/.test(error.message));
  await outcome;
  await assert.rejects(client.pause(), { code: 'closed' });
  assert.deepEqual(states, [['open', undefined, undefined], ['closed', 1001, 'the server stops']]);
});

test('with reconnect it comes back to its scene, says hello and tells its camera again', async () => {
  const server = await serve();
  let opened;
  const states = [];
  const client = await join(server, { reconnect: true, onstate: (state) => { states.push(state); if (state === 'open') opened?.(); } });
  await client.camera({ distance: 12 });
  await client.joinScene('curtain');
  server.received.length = 0;
  const again = new Promise((resolve) => { opened = resolve; });
  server.sockets[0].terminate();
  await again;
  assert.deepEqual(states, ['open', 'waiting', 'open']);
  assert.equal(server.sockets[1].path, '/v1/scenes/curtain');
  assert.deepEqual(server.received.map(({ id, ...message }) => message), [
    { op: 'hello', caps: ['flow.ack'], window: 2 }, { op: 'camera', distance: 12 }]);
  server.sockets[1].send(frameOf(11));
  assert.equal((await client.nextFrame()).stamp.f, 11);
});

test('with reconnect it takes over what it held, and lets go of what it let go of meanwhile', async () => {
  const grabs = [7, 8, 9];
  const seat = 'a'.repeat(32);
  const server = await serve({ greet: false, afterConnection: (socket) => {
    for (const message of [welcome, { ...scene, seat }]) socket.send(JSON.stringify(message));
  }, answer: ({ op }) => (op === 'cloth.grab' ? { grab: grabs.shift() } : op === 'seat.resume' ? { grabs: [7, 8] } : {}) });
  let opened;
  const client = await join(server, { reconnect: true, onstate: (state) => state === 'open' && opened?.() });
  for (const u of [0.1, 0.2, 0.3]) await client.grab(0, u, 0.5);
  server.received.length = 0;
  const again = new Promise((resolve) => { opened = resolve; });
  server.sockets[0].terminate();
  await assert.rejects(client.release(8), { code: 'closed' });
  await again;
  await client.ping();
  assert.deepEqual(server.received.map(({ id, t, ...message }) => message), [
    { op: 'hello', caps: ['flow.ack'], window: 2 }, { op: 'seat.resume', seat }, { op: 'grab.release', grab: 8 },
    { op: 'ping' }]);
});

test('a way that breaks while it takes over what it held loses nothing', async () => {
  const seats = ['a', 'b', 'c'].map((letter) => letter.repeat(32));
  let connections = 0;
  const server = await serve({ greet: false, afterConnection: (socket) => {
    for (const message of [welcome, { ...scene, seat: seats[connections++] }]) socket.send(JSON.stringify(message));
  }, answer: ({ op, seat }) => {
    if (op === 'seat.resume' && connections === 2) server.sockets[1].terminate();
    return op === 'cloth.grab' ? { grab: 7 } : op === 'seat.resume' ? { grabs: seat === seats[0] ? [7] : [] } : {};
  } });
  let opened;
  const client = await join(server, { reconnect: true, onstate: (state) => state === 'open' && opened?.() });
  await client.grab(0, 0.5, 0.5);
  const again = new Promise((resolve) => { opened = resolve; });
  server.sockets[0].terminate();
  await again;
  assert.equal(connections, 3);
  const resumed = server.received.filter(({ op }) => op === 'seat.resume').map(({ seat }) => seat);
  assert.deepEqual(resumed, [seats[0], seats[0], seats[1]]);
});

test('with reconnect a server that is not there yet is waited for', async () => {
  const first = await serve();
  await first.stop();
  let tried;
  const waiting = new Promise((resolve) => { tried = resolve; });
  const client = new WeftClient(first.url, { WebSocket, reconnect: true, onstate: (state, why) => { if (state === 'waiting') tried(why); } });
  open.push(async () => client.close());
  const opened = client.open();
  const why = await waiting;
  assert.equal(why.error.code, 'connect');
  assert.ok(why.delay >= 125 && why.delay <= 250, 'the first wait is 0.25 s, jittered down to half');
  await serve({ port: first.port });
  assert.equal(await opened, client);
});

test('closed on purpose it stays closed, also while waiting to reconnect', async () => {
  const server = await serve();
  const states = [];
  let waits;
  const waiting = new Promise((resolve) => { waits = resolve; });
  const client = await join(server, { reconnect: true, onstate: (state) => { states.push(state); if (state === 'waiting') waits(); } });
  await server.stop();
  await waiting;
  client.close();
  client.close();
  await assert.rejects(client.open(), { code: 'closed' });
  assert.deepEqual(states, ['open', 'waiting', 'closed']);
});

test('closing says 1000 to the server', async () => {
  const server = await serve();
  const client = await join(server, { reconnect: true });
  const closed = once(server.sockets[0], 'close');
  client.close();
  assert.equal((await closed)[0], 1000);
  assert.equal(client.connected, false);
});

test('the back-off doubles from 0.25 s to 10 s and is jittered down to half', () => {
  assert.deepEqual([0, 1, 2, 3, 4, 5, 6, 1000].map((attempt) => backoff(attempt, () => 1)), [250, 500, 1000, 2000, 4000, 8000, 10000, 10000]);
  assert.equal(backoff(3, () => 0), 1000);
});
