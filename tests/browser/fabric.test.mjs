// Each cloth looks as its scene says: front and back, at both qualities; and the arithmetic of stripes.
import assert from 'node:assert/strict';
import {before, test} from 'node:test';
import {fileURLToPath} from 'node:url';
import {inStripe, repeatOf} from '../../web/fabric/stripes.js';
import {openPage, pauseAfter, startServer, until} from './harness.mjs';

test('a picture has a weave and its stripes a whole number of times', () => {
  assert.deepEqual(repeatOf({thread: 0.002}, {threads: 64, period: 2}), {threads: 64, metres: 0.128});
  // 0.12 m are 60 threads: fifteen times the four of a twill, and two of them the most that are no more than 128.
  assert.deepEqual(repeatOf({thread: 0.002, stripe: {spacing: 0.12}}, {threads: 128, period: 4}), {threads: 120, metres: 0.24});
  // 6 threads are whole with a satin's 8 after four times.
  assert.deepEqual(repeatOf({thread: 0.001, stripe: {spacing: 0.006}}, {threads: 16, period: 8}), {threads: 24, metres: 0.024});
});

test('a stripe of three bands has gaps as wide as its bands', () => {
  const stripe = {width: 0.05, spacing: 0.1, bands: 3};
  const row = Array.from({length: 20}, (_, i) => (inStripe(i, 20, 0.2, stripe) ? '#' : '.')).join('');
  assert.equal(row, '#.#.#.....#.#.#.....');  // a thread of 1 cm each: bands at 0 to 1, 2 to 3, 4 to 5 cm of every 10
});

let server;
before(async () => {
  server = await startServer([fileURLToPath(new URL('scenes/looks.json', import.meta.url))]);
  await pauseAfter(server, 'looks', 1);
});

/** The colour in the middle of the picture, [r, g, b]. */
async function middle(page) {
  const image = (await page.screenshot({clip: {x: 448, y: 318, width: 4, height: 4}})).toString('base64');
  return page.evaluate(async (text) => {
    const bytes = Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
    const pen = new OffscreenCanvas(1, 1).getContext('2d');
    pen.drawImage(await createImageBitmap(new Blob([bytes], {type: 'image/png'})), 0, 0, 1, 1);
    return [...pen.getImageData(0, 0, 1, 1).data.slice(0, 3)];
  }, image);
}

for (const quality of ['low', 'high']) {
  test(`the front has its colour, the back another one (${quality})`, async () => {
    const {page, witness} = await openPage(`${server.address}/?quality=${quality}`, {deviceScaleFactor: 0.5});
    await page.addStyleTag({content: '.panel, #wind-arrow, #loupe { display: none !important }'});
    const settled = () => until(page, () => weft.stats.connected && weft.stats.cloths.length === 9 && weft.stats.settled);
    await settled();
    const [red, , blue] = await middle(page);
    assert.ok(red > 2 * blue, `the front is ${red} red and ${blue} blue`);
    for (let turn = 0; turn < 36; ++turn) await page.keyboard.press('ArrowRight');  // of 5 degrees each
    await settled();
    const [redBehind, , blueBehind] = await middle(page);
    assert.ok(blueBehind > 2 * redBehind, `the back is ${redBehind} red and ${blueBehind} blue`);
    assert.deepEqual(witness.errors, []);
    await page.close();
  });
}
