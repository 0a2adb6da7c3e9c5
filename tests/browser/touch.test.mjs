// A phone: one finger turns, two zoom and pan, a finger drags what it touches and what is just beside it.
import assert from 'node:assert/strict';
import {before, test} from 'node:test';
import {fileURLToPath} from 'node:url';
import {openByHand} from './hands.mjs';
import {startServer, stats, until} from './harness.mjs';

const kBox = 1;  // obstacles[1] stands on the floor; it has a mass
const kFree = [60, 560];  // CSS pixels: floor, far from everything
const kPhone = {width: 390, height: 844};

let page, touch, errors;
before(async () => {
  const server = await startServer([fileURLToPath(new URL('scenes/bodies.json', import.meta.url))]);
  ({page, touch, errors} = await openByHand(server, 'bodies', kPhone, {phone: true}));
  assert.equal(await page.evaluate(() => document.getElementById('fold').getAttribute('aria-expanded')), 'false');  // the panel leaves room for the scene
  await until(page, () => weft.stats.settled || weft.stats.frames > 30);
});

const between = (from, to, share) => from.map((value, axis) => value + (to[axis] - value) * share);
/** Puts fingers down one after the other, moves them together from their first to their second places, and takes them up. */
async function gesture(...ways) {
  for (let fingers = 1; fingers <= ways.length; ++fingers) await touch('touchStart', ...ways.slice(0, fingers).map(([from]) => from));
  for (let i = 1; i <= 8; ++i) await touch('touchMove', ...ways.map(([from, to]) => between(from, to, i / 8)));
  await touch('touchEnd');
}
const onPage = (place) => page.evaluate((point) => weft.toPage(point), place);
const eye = async () => (await stats(page)).eye;
const kTarget = [0, 0.8, 0];
const apart = (a, b) => Math.hypot(...a.map((value, axis) => value - b[axis]));

test('one finger turns around what is looked at', async () => {
  const from = await eye();
  await gesture([kFree, [kFree[0] + 90, kFree[1]]]);
  const to = await eye();
  assert.ok(apart(from, to) > 0.3, `the eye went from ${from} to ${to}`);
  assert.ok(Math.abs(apart(to, kTarget) - apart(from, kTarget)) < 1e-3, 'as far as before');
  assert.ok(Math.abs(to[1] - from[1]) < 1e-3, 'as high as before');
  await gesture([[kFree[0] + 90, kFree[1]], kFree]);
  assert.ok(apart(await eye(), from) < 0.05, 'and back');
});

test('two fingers that part zoom in, and out when they close', async () => {
  const far = apart(await eye(), kTarget);
  await gesture([[180, 560], [100, 560]], [[210, 560], [290, 560]]);
  const near = apart(await eye(), kTarget);
  assert.ok(near < 0.7 * far, `${far} m became ${near} m`);
  await gesture([[100, 560], [180, 560]], [[290, 560], [210, 560]]);
  assert.ok(apart(await eye(), kTarget) > 1.3 * near);
});

test('two fingers that go the same way take the scene along', async () => {
  const [x, y] = await onPage([0, 1.2, -0.4]);
  await gesture([[120, 560], [120, 500]], [[240, 560], [240, 500]]);
  const [toX, toY] = await onPage([0, 1.2, -0.4]);
  assert.ok(Math.abs(toX - x) < 8 && toY < y - 35 && toY > y - 85, `${[x, y]} went to ${[toX, toY]}, the fingers by 60 pixels up`);
  await gesture([[120, 500], [120, 560]], [[240, 500], [240, 560]]);
});

test('two fingers that come down together on a body move the camera, and the body stays', async () => {
  const {obstacles} = await stats(page);
  const [x, y] = await onPage(obstacles[kBox]);
  assert.equal(await page.evaluate(([atX, atY]) => weft.obstacleAt(atX, atY), [x, y]), kBox);
  const before = await eye();
  await gesture([[x, y], [x - 40, y]], [[x + 60, y], [x + 110, y]]);
  assert.ok(apart(await eye(), before) > 0.2, 'the camera went nearer');
  // Had the body been taken, it would go until it is let go of, some frames later.
  const {frames} = await stats(page);
  await until(page, (from) => weft.stats.frames > from + 30, frames);
  const after = (await stats(page)).obstacles[kBox];
  assert.ok(apart(after, obstacles[kBox]) < 0.02, `the box went from ${obstacles[kBox]} to ${after}`);
  await gesture([[x - 40, y], [x, y]], [[x + 110, y], [x + 60, y]]);
});

test('a finger takes the ball that it comes down beside', async () => {
  await page.evaluate(() => document.getElementById('ball-add').click());  // in the panel that is folded
  await until(page, () => weft.stats.balls.length === 1);
  const [{position, radius}] = (await stats(page)).balls;
  const [x, y] = await onPage(position), [, top] = await onPage([position[0], position[1] + radius, position[2]]);
  const beside = [x, top - 8];  // above it
  assert.equal(await page.evaluate(([atX, atY]) => weft.ballAt(atX, atY), beside), null);
  await touch('touchStart', beside);
  for (let i = 1; i <= 6; ++i) await touch('touchMove', between(beside, [beside[0], beside[1] - 80], i / 6));
  await until(page, (height) => weft.stats.balls[0].position[1] > height + 0.1, position[1]);
  await touch('touchEnd');
});

test('the console is clean', () => assert.deepEqual(errors, []));
