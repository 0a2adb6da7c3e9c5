// What a hand does to what it drags, as commands: in Node, without a page.
import assert from 'node:assert/strict';
import {test} from 'node:test';
import {Commands, messageText} from '../../protocol/clients/js/weft.js';
import {BallGrip, BodyGrip, ObstacleGrip} from '../../web/input/grips.js';

/** Collects commands; `obstacle.grab` is answered when the test says so. */
function recorder() {
  const sent = [];
  let answer = null;
  class Recorded extends Commands {
    send(op, members) {
      sent.push(JSON.parse(messageText(op, members)));
      return op === 'obstacle.grab' ? new Promise((resolve, reject) => (answer = {resolve, reject})) : Promise.resolve({});
    }
  }
  const sender = {commands: new Recorded(), ask: (reply) => reply.catch(() => null)};
  return {sent, sender, answer: async (reply) => {
    if (reply) answer.resolve(reply);
    else answer.reject(new Error('refused'));
    await new Promise(setImmediate);
  }};
}
const standing = {ball: 3, position: [0, 1, 0], motion: 'kinematic'};
const flying = {...standing, motion: 'dynamic'};

test('a ball goes where the hand is, and is thrown by a hand faster than 0.6 m/s', () => {
  const {sent, sender} = recorder();
  const grip = new BallGrip(sender, standing);
  assert.deepEqual(grip.place, [0, 1, 0]);
  grip.move([0, 2, 0]);
  grip.letGo([0, 0, -0.61]);
  assert.deepEqual(sent, [{op: 'ball.move', ball: 3, position: [0, 2, 0]}, {op: 'ball.throw', ball: 3, velocity: [0, 0, -0.61]}]);
});

test('a ball let go at rest stays; one that flew when it was taken falls', () => {
  const stays = recorder();
  new BallGrip(stays.sender, standing).letGo([0.5, 0, 0]);
  new BallGrip(stays.sender, standing).letGo(null);
  assert.deepEqual(stays.sent, []);
  const falls = recorder();
  new BallGrip(falls.sender, flying).letGo([0.5, 0, 0]);
  new BallGrip(falls.sender, flying).letGo(null);
  assert.deepEqual(falls.sent.map(({op, velocity}) => [op, velocity]), [['ball.throw', [0.5, 0, 0]], ['ball.throw', [0, 0, 0]]]);
});

test('an obstacle without a mass is moved and never thrown', () => {
  const {sent, sender} = recorder();
  const grip = new ObstacleGrip(sender, 2, [1, 0, 0]);
  grip.move([1, 1, 0]);
  grip.letGo([9, 0, 0]);
  assert.deepEqual(sent, [{op: 'obstacle.move', obstacle: 2, position: [1, 1, 0]}]);
});

const taken = {obstacle: 1, mass: 2, point: [0.1, 0, 0], place: [0, 1, 0]};

test('a body is taken by the first movement, with ten times its weight; the newest place follows when the server has answered', async () => {
  const {sent, sender, answer} = recorder();
  const grip = new BodyGrip(sender, taken);
  assert.deepEqual(sent, []);  // a click takes nothing off its path
  grip.move([0, 1, 0]);
  grip.move([0, 2, 0]);
  grip.move([0, 3, 0]);
  await answer({grab: 5});
  grip.move([0, 4, 0]);
  grip.letGo([0, 0.5, 0]);
  assert.deepEqual(sent, [
    {op: 'obstacle.grab', obstacle: 1, point: [0.1, 0, 0], max_force: 10 * 9.81 * 2, position: [0, 1, 0]},
    {op: 'grab.move', grab: 5, position: [0, 3, 0]}, {op: 'grab.move', grab: 5, position: [0, 4, 0]}, {op: 'grab.release', grab: 5},
  ]);
});

test('a body let go in motion is thrown, were it before the server answered', async () => {
  const {sent, sender, answer} = recorder();
  const grip = new BodyGrip(sender, taken);
  grip.move([0, 1, 0]);
  grip.letGo([0, 0, -3]);
  assert.equal(sent.length, 1);
  await answer({grab: 5});
  assert.deepEqual(sent.slice(1), [{op: 'grab.release', grab: 5}, {op: 'obstacle.throw', obstacle: 1, velocity: [0, 0, -3]}]);
});

test('a hand that is lost throws nothing; one that is refused asks no more', async () => {
  const lost = recorder();
  const grip = new BodyGrip(lost.sender, taken);
  grip.move([0, 1, 0]);
  await lost.answer({grab: 5});
  grip.letGo(null);
  assert.deepEqual(lost.sent.slice(1), [{op: 'grab.release', grab: 5}]);
  const refused = recorder();
  const other = new BodyGrip(refused.sender, taken);
  other.move([0, 1, 0]);
  await refused.answer(null);
  other.move([0, 2, 0]);
  other.letGo([0, 0, -3]);
  assert.equal(refused.sent.length, 1);
});

test('the force is at most what the protocol allows', () => {
  const {sent, sender} = recorder();
  new BodyGrip(sender, {...taken, mass: 5000}).move([0, 1, 0]);
  assert.equal(sent[0].max_force, 1e4);
});
