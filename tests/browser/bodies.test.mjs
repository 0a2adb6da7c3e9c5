// Obstacles on the page: dragged by mouse and finger, thrown, moved by the controls; on a wide page and a narrow one.
import assert from 'node:assert/strict';
import {before, test} from 'node:test';
import {fileURLToPath} from 'node:url';
import {setTimeout as sleep} from 'node:timers/promises';
import {openByHand} from './hands.mjs';
import {openScene, pause, pauseAfter, skip, startServer, stats, until} from './harness.mjs';

// By their places in scenes/bodies.json.
const kBox = 1, kCapsule = 2, kShelf = 3, kHidden = 4;
const kFlying = {trampoline: 20, cushion: 20, pillow: 35};  // presets, and after how many steps their first ball flies in sight
const kOnFloor = 0.15;  // m, of the box's centre: half its edge

let server, page;
before(async () => {
  server = await startServer([fileURLToPath(new URL('scenes/bodies.json', import.meta.url)), ...Object.keys(kFlying)]);
  ({page} = await openScene(server, 'bodies'));
});

const placeOf = async (obstacle) => (await stats(page)).obstacles[obstacle];
const onPage = (point, of = page) => of.evaluate((at) => weft.toPage(at), point);
const obstacleAt = ([x, y], of = page) => of.evaluate(([atX, atY]) => weft.obstacleAt(atX, atY), [x, y]);

/** Waits until an obstacle has not got on by a millimetre in half a second of the scene. */
async function rest(obstacle, of = page) {
  await skip(server, 'bodies', 3);
  await of.evaluate(() => (window.still = null));
  await until(of, (index) => {
    const {lastFrame: {time}, obstacles} = weft.stats;
    if (window.still && time - window.still.time < 0.5) return false;
    const last = window.still;
    window.still = {time, place: obstacles[index]};
    return last !== null && obstacles[index].every((value, axis) => Math.abs(value - last.place[axis]) < 1e-3);
  }, obstacle);
}

/** Back at the start. */
async function startAgain() {
  await page.focus('#stage');
  const {epoch} = (await stats(page)).lastFrame;
  await page.keyboard.press('r');
  await until(page, (old) => weft.stats.lastFrame.epoch > old && weft.stats.settled === false, epoch);
  await rest(kBox);
}

test('what can be dragged is told by its drawn shape', async () => {
  for (const obstacle of [kBox, kCapsule, kShelf]) assert.equal(await obstacleAt(await onPage(await placeOf(obstacle))), obstacle);
  // Beside the capsule's round end, within the box around it: only the floor, which nobody drags.
  const [x, y, z] = await placeOf(kCapsule);
  assert.equal(await obstacleAt(await onPage([x + 0.95 * 0.15, y + 0.95 * 0.3, z])), null);
  assert.equal(await obstacleAt(await onPage([x + 0.9 * 0.15, y, z])), kCapsule);
  assert.equal(await obstacleAt(await onPage([0, 0, 1.5])), null);
  // A cloth is before it.
  assert.equal(await obstacleAt(await onPage(await placeOf(kHidden))), null);
});

test('the pointer shows what it would take', async () => {
  const cursor = () => page.evaluate(() => document.getElementById('stage').style.cursor);
  await page.mouse.move(...await onPage(await placeOf(kBox)));
  assert.equal(await cursor(), 'grab');
  await page.mouse.down();
  assert.equal(await cursor(), 'grabbing');
  await page.mouse.up();
  await page.mouse.move(...await onPage([0, 0, 1.5]));
  assert.equal(await cursor(), '');
});

test('the badge covers nothing that could be dragged', async () => {
  const {x, y, width, height} = await page.locator('#badge').boundingBox();
  const under = await page.evaluate(([atX, atY]) => document.elementFromPoint(atX, atY).id, [x + width / 2, y + height / 2]);
  assert.equal(under, 'stage');
});

test('a box dragged by the mouse follows it, falls when it is let go, and comes to rest; the camera stays', async () => {
  const {eye} = await stats(page);
  const from = await placeOf(kBox);
  assert.ok(Math.abs(from[1] - kOnFloor) < 2e-3, `it lies at ${from}`);
  const [x, y] = await onPage(from);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 20, y - 60, {steps: 4});
  await page.mouse.move(x + 60, y - 120, {steps: 4});
  // Held by a point of its front, it hangs below that: the point is where the hand is.
  await rest(kBox);
  const [heldX, heldY] = await onPage(await placeOf(kBox));
  assert.ok(Math.abs(heldX - x - 60) < 12, `${heldX - x} pixels to the right`);
  assert.ok(heldY < y - 80, `${y - heldY} pixels up`);
  assert.equal(await page.isVisible('#obstacles'), true);
  assert.equal(await page.inputValue('#obstacle'), String(kBox));
  await page.mouse.up();
  await until(page, ([index, height]) => weft.stats.obstacles[index][1] < height, [kBox, 0.3]);
  await rest(kBox);
  const after = await placeOf(kBox);
  // On a face, an edge or a corner, and not in the floor.
  assert.ok(after[1] > kOnFloor - 2e-3 && after[1] < kOnFloor * Math.sqrt(3), `it rests at ${after}`);
  assert.ok(after[0] > from[0] + 0.1, 'where it was let go');
  assert.deepEqual((await stats(page)).eye, eye);
});

test('a body let go in motion is thrown', async () => {
  await startAgain();
  const {page: other, flick, errors, close} = await openByHand(server, 'bodies', {width: 900, height: 640});
  const from = await placeOf(kBox), [x, y] = await onPage(from, other);
  await flick(Array.from({length: 7}, (_, i) => [x + 16 * i, y - 16 * i]));
  // 16 pixels in 10 ms are some 10 m/s: it flies on for as long again as the hand had gone, upwards, too.
  const metre = (await onPage([1, 0, 0], other))[0] - (await onPage([0, 0, 0], other))[0];
  const drawn = 96 / metre;
  await until(page, ([index, [fromX, fromY], way]) => {
    const [atX, atY] = weft.stats.obstacles[index];
    return atX > fromX + 2 * way && atY > fromY + way;
  }, [kBox, from, drawn]);
  assert.deepEqual(errors, []);
  await close();
});

test('an obstacle without a mass stays where it is put', async () => {
  await startAgain();
  const [x, y] = await onPage(await placeOf(kShelf));
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x - 50, y - 30, {steps: 5});
  await page.mouse.up();
  const wanted = [x - 50, y - 30];
  await until(page, ([index, [toX, toY]]) => {
    const [atX, atY] = weft.toPage(weft.stats.obstacles[index]);
    return Math.hypot(atX - toX, atY - toY) < 2;
  }, [kShelf, wanted]);
  await rest(kShelf);
  const [endX, endY] = await onPage(await placeOf(kShelf));
  assert.ok(Math.hypot(endX - wanted[0], endY - wanted[1]) < 2);
});

test('the controls do the same: a place by numbers, a throw for what has a mass', async () => {
  await page.selectOption('#obstacle', String(kShelf));
  assert.equal(await page.isDisabled('#obstacle-throw'), true);
  await page.fill('#obstacle-place [data-axis="1"]', '1.6');
  await page.press('#obstacle-place [data-axis="1"]', 'Enter');
  await until(page, (index) => Math.abs(weft.stats.obstacles[index][1] - 1.6) < 1e-6, kShelf);
  await page.selectOption('#obstacle', String(kBox));
  await until(page, (index) => document.querySelector('#obstacle-place [data-axis="0"]').value === weft.stats.obstacles[index][0].toFixed(2), kBox);
  assert.equal(await page.isDisabled('#obstacle-throw'), false);
  const [, before] = await placeOf(kBox);
  await page.click('#obstacle-throw');
  // 7 m/s at the towel, up there.
  await until(page, ([index, height]) => weft.stats.obstacles[index][1] > height + 0.5, [kBox, before]);
});

test('a finger drags a body on a narrow page, whose controls fit', async () => {
  await startAgain();
  const {page: phone, touch, errors, close} = await openByHand(server, 'bodies', {width: 375, height: 720}, {phone: true});
  const from = (await stats(phone)).obstacles[kCapsule];
  const [x, y] = await onPage(from, phone);
  assert.equal(await obstacleAt([x, y], phone), kCapsule);
  const {eye} = await stats(phone);
  await touch('touchStart', [x, y]);
  for (let i = 1; i <= 6; ++i) await touch('touchMove', [x + 3 * i, y - 15 * i]);
  await until(phone, ([index, height]) => weft.stats.obstacles[index][1] > height + 0.3, [kCapsule, from[1]]);
  await rest(kCapsule, phone);
  await touch('touchEnd');
  await until(phone, ([index, height]) => weft.stats.obstacles[index][1] < height + 0.1, [kCapsule, from[1]]);
  assert.deepEqual((await stats(phone)).eye, eye);
  // All viewers see it, and where it is while it rolls.
  await pause(page);
  await until(phone, (f) => weft.stats.lastFrame.f === f && weft.stats.settled, (await stats(page)).lastFrame.f);
  assert.deepEqual((await stats(phone)).obstacles[kCapsule], await placeOf(kCapsule));
  const apart = (await placeOf(kCapsule)).map((value, axis) => Math.abs(value - from[axis]));
  assert.ok(Math.max(...apart) > 0.05, 'it was dragged aside, or fell over');
  const fold = await phone.evaluate(() => {
    const {x, y, width, height} = document.getElementById('fold').getBoundingClientRect();
    return [x + width / 2, y + height / 2];
  });
  await touch('touchStart', fold);
  await touch('touchEnd');
  await until(phone, () => document.getElementById('fold').getAttribute('aria-expanded') === 'true');
  const wide = await phone.evaluate(() => [...document.querySelectorAll('#controls *')]
    .filter((element) => element.getClientRects().length > 0 && element.getBoundingClientRect().right > innerWidth + 0.5).map((element) => element.id || element.tagName));
  assert.deepEqual(wide, []);
  assert.equal(await phone.evaluate(() => document.documentElement.scrollWidth), 375);
  assert.deepEqual(errors, []);
  await close();
});

for (const preset of Object.keys(kFlying)) {
  test(`${preset}: a ball that flew falls when it is let go`, async () => {
    const {page: other, witness} = await openScene(server, preset);
    // In the air, above all cloth: a hand in a deep dent would be thrown up by the cloth.
    const time = await pauseAfter(server, preset, kFlying[preset]);
    await until(other, (wanted) => weft.stats.lastFrame.epoch > 1 && weft.stats.lastFrame.time > wanted - 1e-6 && weft.stats.settled, time);
    const [{ball, position}] = (await stats(other)).balls;
    const [x, y] = await onPage(position, other);
    assert.equal(await other.evaluate(([atX, atY]) => weft.ballAt(atX, atY), [x, y]), ball);
    await other.mouse.move(x, y);
    await other.mouse.down();
    await other.mouse.move(x, y - 40, {steps: 4});
    await other.keyboard.press('Space');
    await until(other, ([id, wanted]) => {
      const held = weft.stats.balls.find((each) => each.ball === id);
      return held.motion === 'kinematic' && Math.abs(weft.toPage(held.position)[1] - wanted) < 2;
    }, [ball, y - 40]);
    const [, height] = (await stats(other)).balls.find((each) => each.ball === ball).position;
    // Let go at rest: the hand's 200 ms are what is tested.
    await sleep(200);
    await other.mouse.up();
    await until(other, ([id, held]) => {
      const falls = weft.stats.balls.find((each) => each.ball === id);
      return falls.motion === 'dynamic' && falls.position[1] < held - 0.05;
    }, [ball, height]);
    assert.deepEqual(witness.errors, []);
    await other.close();
  });
}
