// A Node script against a running server: it moves its camera through the thresholds, throws a ball, sets the wind, and
// receives frames at the right levels.
import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import {once} from 'node:events';
import {createInterface} from 'node:readline';
import {after, before, test} from 'node:test';
import {fileURLToPath} from 'node:url';
import WebSocket from 'ws';
import {connect} from '../../protocol/clients/js/weft.js';

const kGenerous = 30_000;  // ms, for what takes milliseconds
let server, address;

before(async () => {
  const scene = fileURLToPath(new URL('scenes/hung.json', import.meta.url));
  server = spawn(process.env.WEFT_BINARY, ['serve', '--port', '0', '--quiet', scene], {stdio: ['ignore', 'pipe', 'inherit']});
  const [line] = await once(createInterface(server.stdout), 'line');
  address = line.match(/^Weft is at http:\/\/(.+)\/$/)[1];
});

after(async () => {
  server.kill('SIGTERM');
  const [code] = server.exitCode === null ? await once(server, 'exit') : [server.exitCode];
  assert.equal(code, 0);
});

async function join(t, told = () => {}) {
  const scene = await connect(`ws://${address}/v1/scenes/hung`, {WebSocket, timeout: kGenerous, onmessage: told});
  t.after(() => scene.close());
  return scene;
}

test('the camera through the thresholds', async (t) => {
  const scene = await join(t);
  // Table 1: l_close = 1 m, l_far = 10 m; Eq. 7 counts a threshold itself to the nearer band.
  for (const [distance, level] of [[0.8, 6], [5, 5], [12, 4], [10, 5], [1, 6]]) {
    const {f} = await scene.camera({distance});
    for (let i = 0; i < 3; ++i) {
      const frame = await scene.nextFrame((each) => each.stamp.f >= f + i);
      const [cloth] = frame.cloths;
      assert.deepEqual([cloth.level, cloth.rows, cloth.cols], [level, 2 ** level + 1, 2 ** level + 1], `${distance} m`);
      assert.equal(cloth.positions.length, 3 * cloth.rows * cloth.cols);
      assert.ok(cloth.positions.every(Number.isFinite));
    }
  }
});

test('a thrown ball', async (t) => {
  const events = [];
  const scene = await join(t, (message) => message.op === 'event' && events.push(message));
  const ball = await scene.addBall([0, 0.5, 2], 0.2);
  const {f} = await scene.throwBall(ball, [0, 1, -6]);
  const find = (frame) => frame.balls.find((each) => each.ball === ball);
  const first = await scene.nextFrame((frame) => frame.stamp.f >= f && find(frame));
  const second = await scene.nextFrame((frame) => frame.stamp.f >= first.stamp.f + 6);
  assert.equal(find(second).motion, 'dynamic');
  const seconds = second.stamp.time - first.stamp.time;
  // 6 m/s until it meets the cloth, which hangs more than 1 m away.
  assert.ok(Math.abs(find(first).position[2] - find(second).position[2] - 6 * seconds) < 0.01);
  assert.deepEqual(events.map(({kind}) => kind), ['ball.add', 'ball.throw']);
});

test('the wind', async (t) => {
  const events = [];
  const scene = await join(t, (message) => message.op === 'event' && events.push(message));
  const {f} = await scene.setWind([2, 0, 0], 30);
  const edge = ({cloths: [{positions, rows, cols}]}) => positions[3 * ((rows - 1) * cols + (cols >> 1))];
  const before = await scene.nextFrame();
  const after = await scene.nextFrame((frame) => frame.stamp.f >= f + 30);
  assert.deepEqual(events[0].wind, {direction: [1, 0, 0], speed: 30});
  // 30 N/m2 on 0.1 kg/m2 would carry it metres in half a second; the pins hold it back.
  assert.ok(edge(after) > edge(before) + 0.3, `${edge(before)} m, then ${edge(after)} m`);
});
