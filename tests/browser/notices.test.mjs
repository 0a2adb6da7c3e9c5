// What a server says in trouble, from a stand-in that can be in trouble at will.
import assert from 'node:assert/strict';
import {createServer} from 'node:http';
import {after, before, test} from 'node:test';
import {WebSocketServer} from 'ws';
import {openPage, startServer, until} from './harness.mjs';

const kScene = {
  op: 'scene', name: 'trouble', title: 'In trouble', f: 0, epoch: 1, time: 0, dt: 1 / 60, paused: false, effects: ['gravity'],
  wind: {direction: [0, 0, -1], speed: 0}, balls: [], cloths: [{cloth: 0, name: 'cloth', size: [1, 1], base_cells: [1, 1], min_level: 4, max_level: 6}],
  level_policy: {thresholds: [1, 10], levels: [6, 5, 4], hysteresis: 0}, camera: {distance: 5, level: [5]},
};

const http = createServer((request, response) => response.writeHead(404).end());
const sockets = new WebSocketServer({server: http, handleProtocols: () => 'weft.v1'});
let page, socket;

const say = (message) => socket.send(JSON.stringify(message));

before(async () => {
  await new Promise((resolve) => http.listen(0, '127.0.0.1', resolve));
  const standIn = `ws://127.0.0.1:${http.address().port}`;
  sockets.on('connection', (accepted) => {
    socket = accepted;
    socket.on('message', (data) => {
      const {op, id, t} = JSON.parse(data);
      if (op === 'ping') say({op: 'pong', re: id, t, f: 0, time: 0});
      else if (op === 'ball.add') say({op: 'error', re: id, code: 'limit', path: '', message: 'the scene has 64 balls, the most allowed'});
      else if (op === 'hello') say({op: 'ok', re: id, f: 0, caps: []});
      else if (op === 'scene.list') say({op: 'ok', re: id, f: 0, scenes: [{name: 'trouble', title: 'In trouble', viewers: 1, cloths: 1}]});
      else if (id) say({op: 'ok', re: id, f: 0});
    });
    say({op: 'welcome', protocol: 'weft.v1', minor: 0, server: 'stand-in', caps: [], limits: {}});
    say(kScene);
  });
  const server = await startServer(['flag']);
  ({page} = await openPage(`${server.address}/?quality=low&server=${standIn}&scene=trouble`));
  await until(page, () => weft.stats.connected);
});

after(() => {
  for (const each of sockets.clients) each.terminate();
  http.close();
});

const notice = (text) => page.waitForSelector(`#notice:not([hidden]) >> text=${text}`);

test('a slow clock is told until it is in time again', async () => {
  say({op: 'notice', code: 'slow', message: 'the clock runs behind real time'});
  await notice('the clock runs behind real time');
  say({op: 'notice', code: 'real_time', message: 'in time again'});
  await page.waitForSelector('#notice', {state: 'hidden'});
});

const stats = (state) => ({
  op: 'stats', f: 9, time: 0.15, step_ms: 0.1, rate: 1, viewers: 1, dropped: 0,
  cloths: [{cloth: 0, level: 5, simulated_level: 5, nodes: 1089, substeps: 0, state, distance: 5}],
});

test('a frozen cloth is told until the scene is reset', async () => {
  say({op: 'notice', code: 'frozen', message: 'cloth: step 7 gave no solution'});
  await notice('cloth: step 7 gave no solution');
  say({op: 'event', kind: 'reset', f: 0, epoch: 2});
  await page.waitForSelector('#notice', {state: 'hidden'});
});

test('crowded cloth is told in passing', async () => {
  say({op: 'notice', code: 'crowded', message: 'cloth: step 6 gave more contacts in one place than are held'});
  await page.waitForSelector('#toasts >> text=cloth: step 6 gave more contacts in one place than are held');
  assert.equal(await page.isHidden('#notice'), true);
});

test('a frozen cloth is told until it moves again, beside a slow clock', async () => {
  say({op: 'notice', code: 'frozen', message: 'cloth: step 8 gave no solution'});
  say(stats('frozen'));
  say({op: 'notice', code: 'slow', message: 'the clock runs behind real time'});
  await notice('cloth: step 8 gave no solution the clock runs behind real time');
  assert.equal(await page.textContent('#number-substeps'), 'none: frozen');
  say({op: 'notice', code: 'real_time', message: 'in time again'});
  say({op: 'notice', code: 'recovered', message: 'cloth: moves again from step 9 on'});
  await page.waitForSelector('#toasts >> text=cloth: moves again from step 9 on');
  await notice('cloth: step 8 gave no solution');
  say(stats('awake'));
  await page.waitForSelector('#notice', {state: 'hidden'});
});

test('a refused command is a toast with the server’s words', async () => {
  await page.click('#ball-add');
  await page.waitForSelector('[role=alert] >> text=the scene has 64 balls, the most allowed');
});

test('a scene without wind says so, and its sliders are off', async () => {
  assert.equal(await page.isVisible('#wind-absent'), true);
  assert.equal(await page.isDisabled('#wind-speed'), true);
});

test('messages and records of a later version are no trouble', async () => {
  say({op: 'something.new', of: 'minor version 7'});
  say({op: 'notice', code: 'new_code', message: 'still shown'});
  await notice('still shown');
});

test('a malformed frame does not end the page', async () => {
  socket.send(Buffer.from('WEFTnonsense'));
  say({op: 'notice', code: 'slow', message: 'after the bad frame'});
  await notice('after the bad frame');
  assert.equal(await page.evaluate(() => weft.stats.connected), true);
});
