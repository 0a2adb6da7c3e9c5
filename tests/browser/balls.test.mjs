// Balls: added, dragged into the cloth, thrown, removed; by mouse and by the controls.
import assert from 'node:assert/strict';
import {before, test} from 'node:test';
import {setTimeout as sleep} from 'node:timers/promises';
import {openByHand} from './hands.mjs';
import {openScene, pause, startServer, stats, until} from './harness.mjs';

let server, page;
before(async () => {
  server = await startServer(['zheng2020-distance']);
  ({page} = await openScene(server, 'zheng2020-distance'));
  await page.keyboard.press('2');
});

const firstBall = async () => (await stats(page)).balls[0];
/** Distance of the node nearest to a point, in the newest frame, m. */
const nearestNode = (point) => page.evaluate((place) => {
  const positions = weft.positions();
  let least = Infinity;
  for (let at = 0; at < positions.length; at += 3) {
    least = Math.min(least, Math.hypot(...place.map((value, axis) => positions[at + axis] - value)));
  }
  return least;
}, point);

test('Add hangs a ball between camera and cloth', async () => {
  assert.equal(await page.isDisabled('#ball-remove'), true);
  await page.click('#ball-add');
  await until(page, () => weft.stats.balls.length === 1);
  const {position, radius, motion} = await firstBall();
  assert.equal(motion, 'kinematic');
  const {cloths: [{centre}], eye} = await stats(page);
  const between = Math.hypot(...position.map((value, axis) => value - eye[axis]));
  assert.ok(between < Math.hypot(...centre.map((value, axis) => value - eye[axis])), 'nearer than the cloth');
  assert.ok(await nearestNode(position) > radius, 'off the cloth');
});

test('a ball is drawn where the frame says', async () => {
  const {position, ball} = await firstBall();
  const [x, y] = await page.evaluate((place) => weft.toPage(place), position);
  assert.equal(await page.evaluate(([atX, atY]) => weft.ballAt(atX, atY), [x, y]), ball);
  assert.equal(await page.evaluate(([atX, atY]) => weft.ballAt(atX, atY), [x + 200, y]), null);
});

test('a ball dragged by the mouse follows it', async () => {
  const {position} = await firstBall();
  const [x, y] = await page.evaluate((place) => weft.toPage(place), position);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 30, y - 20, {steps: 4});
  await page.mouse.move(x + 60, y - 40, {steps: 4});
  await until(page, ([wantedX, wantedY]) => {
    const [atX, atY] = weft.toPage(weft.stats.balls[0].position);
    return Math.hypot(atX - wantedX, atY - wantedY) < 3;
  }, [x + 60, y - 40]);
  // Let go at rest (the hand's 200 ms are what is tested): it stays.
  await sleep(200);
  await page.mouse.up();
  const {lastFrame: {f}} = await stats(page);
  await until(page, (before) => weft.stats.lastFrame.f > before + 20, f);
  const after = await firstBall();
  assert.equal(after.motion, 'kinematic');
  const [endX, endY] = await page.evaluate((place) => weft.toPage(place), after.position);
  assert.ok(Math.hypot(endX - x - 60, endY - y + 40) < 3);
});

test('dragging a ball does not turn the camera; dragging beside it does', async () => {
  const {eye} = await stats(page);
  await page.mouse.move(120, 420);
  await page.mouse.down();
  await page.mouse.move(180, 420, {steps: 4});
  await page.mouse.up();
  await until(page, (before) => Math.hypot(...weft.stats.eye.map((value, axis) => value - before[axis])) > 0.2, eye);
});

test('a ball in the cloth deforms it', async () => {
  // Where a node of the cloth is now, a ball is put by its number fields, a little in front.
  const {cloths: [{rows, cols}]} = await stats(page);
  const middle = ((rows >> 1) * cols + (cols >> 1)) * 3;
  const node = await page.evaluate((at) => weft.positions().slice(at, at + 3), middle);
  const place = [node[0], node[1], node[2] + 0.05].map((value) => Number(value.toFixed(2)));
  const {radius} = await firstBall();
  const before = await nearestNode(place);
  assert.ok(before < 0.1, `the cloth was there: ${before} m`);
  for (const [axis, value] of place.entries()) {
    await page.fill(`#ball-place [data-axis="${axis}"]`, String(value));
    await page.press(`#ball-place [data-axis="${axis}"]`, 'Enter');
  }
  await until(page, (wanted) => Math.hypot(...weft.stats.balls[0].position.map((value, axis) => value - wanted[axis])) < 1e-3, place);
  const {lastFrame: {f}} = await stats(page);
  await until(page, (start) => weft.stats.lastFrame.f > start + 5, f);
  // No node is left inside the ball (section 2.4 of the paper): exact to the frame's quantum.
  // All of one frame: the next one may have another quantum.
  const [quantum, after] = await page.evaluate(() => {
    const {cloths: [{quantum: step}], balls: [{position}]} = weft.stats, positions = weft.positions();
    const distances = Array.from({length: positions.length / 3}, (_, i) => Math.hypot(...position.map((value, axis) => positions[3 * i + axis] - value)));
    return [step, Math.min(...distances)];
  });
  assert.ok(after >= radius - quantum, `a node is ${after} m from the centre of a ball of ${radius} m`);
  const [, , z] = await page.evaluate((at) => weft.positions().slice(at, at + 3), middle);
  assert.ok(Math.abs(z - node[2]) > 0.5 * radius, `the node gave way by ${Math.abs(z - node[2])} m`);
});

test('a ball let go in motion is thrown', async () => {
  await page.fill('#ball-place [data-axis="2"]', '1.5');
  await page.press('#ball-place [data-axis="2"]', 'Enter');
  const {page: other, flick, errors, close} = await openByHand(server, 'zheng2020-distance', {width: 900, height: 640});
  await until(other, () => Math.abs(weft.stats.balls[0]?.position[2] - 1.5) < 1e-3 && weft.stats.settled);
  const [{position}] = (await stats(other)).balls;
  const [x, y] = await other.evaluate((at) => weft.toPage(at), position);
  const drawn = 120;  // CSS pixels, to the left
  await flick(Array.from({length: 7}, (_, i) => [x - drawn * i / 6, y]));
  // It flies on by as much as the hand went; and it falls in the end.
  await until(other, ([[fromX], [, fromY], way]) => {
    const [ball] = weft.stats.balls;
    return ball?.motion === 'dynamic' && weft.toPage(ball.position)[0] < fromX - 2 * way && ball.position[1] < fromY - 1;
  }, [[x, y], position, drawn]);
  assert.deepEqual(errors, []);
  await close();
});

test('the Throw button throws at the cloth', async () => {
  await page.focus('#stage');
  await page.keyboard.press('r');
  await until(page, () => weft.stats.balls.length === 0);  // the scene has none of its own
  await page.click('#ball-add');
  await until(page, () => weft.stats.balls.length === 1);
  await pause(page);
  const {cloths: [{centre}], lastFrame: {f, time}} = await stats(page);
  const {position: from} = await firstBall();
  await page.click('#ball-throw');
  await page.click('#step');  // one: the cloth is less than half a metre away
  await until(page, (wanted) => weft.stats.lastFrame.f === wanted && weft.stats.settled, f + 1);
  const {position: to, motion} = await firstBall();
  assert.equal(motion, 'dynamic');
  // Free flight at 7 m/s towards the cloth's centre, and upwards with what gravity takes until it is there. Its velocity
  // changes once a step: g dt^2 / 2 = 0.0055 m too low after one of 1/30 s.
  const way = centre.map((value, axis) => value - from[axis]);
  const distance = Math.hypot(...way);
  const seconds = (await stats(page)).lastFrame.time - time;
  const rise = 0.5 * 9.81 * seconds * (distance / 7 - seconds);
  const wanted = from.map((value, axis) => value + 7 * seconds * way[axis] / distance + (axis === 1 ? rise : 0));
  const off = Math.hypot(...to.map((value, axis) => value - wanted[axis]));
  assert.ok(off < 0.007, `${off} m from ${wanted}`);
  await page.click('#pause');
});

test('several balls: the chosen one is removed', async () => {
  await page.click('#ball-add');
  await until(page, () => weft.stats.balls.length === 2);
  const [first, second] = (await stats(page)).balls.map(({ball}) => ball);
  await page.selectOption('#ball', String(first));
  await page.click('#ball-remove');
  await until(page, (left) => weft.stats.balls.length === 1 && weft.stats.balls[0].ball === left, second);
  await page.click('#ball-remove');
  await until(page, () => weft.stats.balls.length === 0);
  assert.equal(await page.isDisabled('#ball-throw'), true);
});
