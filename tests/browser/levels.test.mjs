// The camera's distance decides what is sent, and the page says so.
import assert from 'node:assert/strict';
import {before, test} from 'node:test';
import {openScene, startServer, stats, until} from './harness.mjs';

// Table 1 and Eq. 7: below 1 m 64 x 64 cells, to 10 m 32 x 32, beyond 16 x 16.
const kBands = [
  {key: '1', distance: 0.8, level: 6, cells: 64},
  {key: '2', distance: 5, level: 5, cells: 32},
  {key: '3', distance: 12, level: 4, cells: 16},
];

let page;
before(async () => {
  const server = await startServer(['zheng2020-distance']);
  ({page} = await openScene(server, 'zheng2020-distance', {reducedMotion: 'no-preference'}));
});

/** Waits for a level in the frames' headers and the page's words for it, of one moment: where the cloth swings by 1 m its level changes. */
async function expectBand({level, cells, distance}) {
  // The cloth swings on after the camera was placed, by less than its own half height: 0.5 m.
  const words = {'#badge-cells': `${cells} × ${cells}`, '#badge-level': String(level), '#badge-nodes': ((cells + 1) ** 2).toLocaleString('en')};
  await until(page, (wanted) => {
    const [cloth] = weft.stats.cloths;
    return cloth.level === wanted.level && cloth.rows === wanted.cells + 1 && cloth.cols === wanted.cells + 1 &&
      Math.abs(weft.stats.distance - wanted.distance) < 0.5 &&
      Object.entries(wanted.words).every(([badge, text]) => document.querySelector(badge).textContent === text);
  }, {level, cells, distance, words});
  assert.match(await page.textContent('#badge-distance'), /^\d+(\.\d+)? m$/);
}

test('keys 1, 2, 3 bring 64, 32 and 16 cells', async () => {
  for (const band of [...kBands, ...[...kBands].reverse()]) {
    await page.keyboard.press(band.key);
    await expectBand(band);
  }
});

test('so do the buttons', async () => {
  for (const band of kBands) {
    await page.click(`#jumps [data-distance="${band.distance}"]`);
    await expectBand(band);
  }
});

test('so does the wheel', async () => {
  await page.keyboard.press('2');
  await expectBand(kBands[1]);
  await page.mouse.move(400, 320);
  for (let turn = 0; turn < 40 && (await stats(page)).distance < 11; ++turn) await page.mouse.wheel(0, 240);
  await until(page, () => weft.stats.cloths[0].level === 4);
  for (let turn = 0; turn < 80 && (await stats(page)).distance > 0.8; ++turn) await page.mouse.wheel(0, -240);
  await until(page, () => weft.stats.cloths[0].level === 6);
  assert.ok((await stats(page)).distance >= 0.4, 'the camera does not go into the cloth');
});

test('plus, minus and arrows move the camera', async () => {
  await page.keyboard.press('2');
  await expectBand(kBands[1]);
  const start = await stats(page);
  await page.keyboard.press('-');
  await until(page, (least) => weft.stats.distance > least, start.distance * 1.1);  // one press is 15 %
  const eye = () => page.evaluate(() => weft.stats.eye);
  const from = await eye();
  await page.keyboard.press('ArrowRight');
  const to = await eye();
  assert.ok(Math.hypot(...to.map((value, axis) => value - from[axis])) > 0.1, 'the eye has moved');
  assert.ok(Math.abs(Math.hypot(...to) - Math.hypot(...from)) < 0.3, 'around the cloth');
});

test('the server reckons with the same distance', async () => {
  await page.keyboard.press('3');
  await expectBand(kBands[2]);
  await until(page, () => weft.stats.server && Math.abs(weft.stats.server.cloths[0].distance - weft.stats.distance) < 0.1);
  assert.match(await page.textContent('#badge-step'), /^\d+\.\d\d ms per step$/);
});
