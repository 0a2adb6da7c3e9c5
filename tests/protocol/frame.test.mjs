// The JavaScript client's decoder and message builder against the shared vectors.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { decodeFrame, messageText, WeftError } from '../../protocol/clients/js/weft.js';
import { frames, fromHex, messages } from './vectors.mjs';

for (const { name, hex, expect } of frames.good) {
  test(`frame ${name} decodes to its values`, () => {
    const frame = decodeFrame(fromHex(hex).buffer);
    const { f, epoch, time, server_ms: serverMs, flags } = expect;
    assert.deepEqual(frame.stamp, { f, epoch, time, serverMs, paused: (flags & 2) !== 0, slow: (flags & 4) !== 0 });
    assert.deepEqual(frame.balls, expect.balls);
    assert.deepEqual(frame.obstacles, expect.obstacles);
    assert.equal(frame.cloths.length, expect.cloths.length);
    frame.cloths.forEach(({ positions, ...header }, i) => {
      const { cloth, level, simulated_level: simulatedLevel, rows, cols, quantum, torn, positions_f32: bytes } = expect.cloths[i];
      assert.deepEqual(header, { cloth, level, simulatedLevel, rows, cols, quantum, origin: [0, 0, 0], torn });
      assert.equal(Buffer.from(positions.buffer).toString('hex'), bytes);
    });
  });
}

for (const { name, hex, error } of frames.bad) {
  test(`frame ${name} is refused`, () => {
    assert.throws(() => decodeFrame(fromHex(hex)), (thrown) => thrown instanceof WeftError && thrown.code === 'bad_frame' && thrown.message === error);
  });
}

test('a frame inside a larger buffer is read from its own place', () => {
  const { hex, expect } = frames.good.find(({ name }) => name === 'several');
  const larger = Buffer.concat([Buffer.from('garbage'), Buffer.from(hex, 'hex'), Buffer.from('more')]);
  const frame = decodeFrame(larger.subarray(7, larger.length - 4));
  assert.deepEqual(frame.balls, expect.balls);
  assert.equal(Buffer.from(frame.cloths[1].positions.buffer).toString('hex'), expect.cloths[1].positions_f32);
});

test('positions from an origin near the cloth are exact where an f32 of the world is not', () => {
  const { hex, expect } = frames.good.find(({ name }) => name === 'far');
  const [{ origin, quantum, q }] = expect.cloths;
  const [cloth] = decodeFrame(fromHex(hex).buffer, { local: true }).cloths;
  assert.ok(cloth.origin.every((value, axis) => value % 16 === 0 && Math.abs(value - origin[axis]) <= 8));
  cloth.positions.forEach((value, i) => assert.equal(cloth.origin[i % 3] + value, origin[i % 3] + quantum * q[i % 3][Math.floor(i / 3)]));
  const near = frames.good.find(({ name }) => name === 'ramp');  // within half a grid of the world's origin
  assert.deepEqual(decodeFrame(fromHex(near.hex).buffer, { local: true }), decodeFrame(fromHex(near.hex).buffer));
});

test('every beginning of a frame is refused', () => {
  const bytes = fromHex(frames.good.find(({ name }) => name === 'several').hex);
  for (let size = 0; size < bytes.length; ++size)
    assert.throws(() => decodeFrame(bytes.subarray(0, size)), WeftError);
});

for (const { text, op, id, members } of messages.good) {
  test(`builds ${text}`, () => assert.deepEqual(JSON.parse(messageText(op, members, id)), JSON.parse(text)));
}

test('op and id lead a message, so that a fault behind them can be answered', () => {
  assert.equal(messageText('ping', { t: 1 }, 7), '{"op":"ping","id":7,"t":1}');
});

test('members that are undefined are left out, numbers that are not finite refused', () => {
  assert.equal(messageText('ball.add', { position: [0, 0, 0], radius: 1, mass: undefined }), '{"op":"ball.add","position":[0,0,0],"radius":1}');
  for (const value of [NaN, Infinity, -Infinity])
    assert.throws(() => messageText('wind.set', { direction: [0, value, 0], speed: 1 }), { code: 'range' });
});
