// What can be set of an effect has a slider and a field in the panel, with the server's ranges, the same for all viewers.
import assert from 'node:assert/strict';
import {before, test} from 'node:test';
import {fileURLToPath} from 'node:url';
import {openScene, startServer, stats, until} from './harness.mjs';

let page, other;
before(async () => {
  const server = await startServer([fileURLToPath(new URL('scenes/tunable.json', import.meta.url)), 'flag']);
  ({page} = await openScene(server, 'tunable'));
  ({page: other} = await openScene(server, 'tunable'));
});

const drag = (of) => of.getByRole('spinbutton', {name: 'Drag'});
const dragIs = (of, value) => until(of, (wanted) => weft.stats.parameters.aerodynamics?.drag === wanted, value);

test('each effect has a plain name; those with something to set unfold it by the keyboard', async () => {
  assert.deepEqual(await page.$$eval('#effects label.check', (labels) => labels.map((label) => label.textContent.trim())),
    ['Gravity', 'Wind and drag', 'Stiffness to bending', 'Cloth on cloth', 'Inflation', 'Tearing']);
  assert.equal(await page.getByRole('button', {name: 'Adjust Stiffness to bending'}).count(), 0);
  const fold = page.getByRole('button', {name: 'Adjust Wind and drag'});
  assert.equal(await fold.getAttribute('aria-expanded'), 'false');
  assert.equal(await drag(page).count(), 0);
  await page.bringToFront();
  await fold.focus();
  await page.keyboard.press('Enter');
  assert.equal(await fold.getAttribute('aria-expanded'), 'true');
  assert.ok(await page.getByRole('group', {name: 'Wind and drag', exact: true}).isVisible());
  await page.keyboard.press('Tab');
  assert.ok(await page.getByRole('spinbutton', {name: 'Air density kg/m³'}).evaluate((field) => field === document.activeElement));
});

test('every number has a labelled field and a labelled slider, with the value and the range that the server tells', async () => {
  await page.$$eval('#effects button[aria-expanded=false]', (buttons) => buttons.forEach((button) => button.click()));
  const fields = await page.$$eval('#effects input[type=number]', (inputs) =>
    inputs.map((input) => [input.labels[0].textContent, Number(input.value), Number(input.min), Number(input.max)]));
  assert.deepEqual(fields, [
    ['Acceleration x m/s²', 0, -10000, 10000], ['Acceleration y m/s²', -9.81, -10000, 10000], ['Acceleration z m/s²', 0, -10000, 10000],
    ['Air density kg/m³', 1.225, 0, 10000], ['Drag', 1.2, 0, 100], ['Lift', 1.2, 0, 100],
    ['Friction', 0.3, 0, 10], ['Thickness m', 0.005, 0.0001, 1], ['Pressure Pa', 0, -1e6, 1e6],
    ['Strength along u N/m', 1e6, 0.001, 1e9], ['Strength along v N/m', 1e6, 0.001, 1e9]]);
  assert.equal(await page.getByRole('slider', {name: /, slider$/}).count(), fields.length);
});

test('a value that is typed is taken, and every viewer shows it', async () => {
  await other.getByRole('button', {name: 'Adjust Wind and drag'}).click();
  await drag(page).fill('2.5');
  await page.keyboard.press('Enter');
  await dragIs(other, 2.5);
  assert.equal(await drag(other).inputValue(), '2.5');
  assert.equal(await other.getByRole('slider', {name: 'Drag, slider'}).inputValue(), '2.5');
  assert.equal(await other.getByRole('spinbutton', {name: 'Lift'}).inputValue(), '2.5');  // goes with drag in this scene
});

test('what the server refuses is told and taken back', async () => {
  await drag(page).fill('1000');
  await page.keyboard.press('Enter');
  await page.getByText('/parameters/drag is 1000; allowed: 0..100').waitFor();
  assert.equal(await drag(page).inputValue(), '2.5');
});

test('one component of a vector leaves the others; without weight the cloth stays up', async () => {
  await page.getByRole('spinbutton', {name: 'Acceleration y'}).fill('1');
  await page.keyboard.press('Enter');
  await until(other, () => weft.stats.parameters.gravity.acceleration[1] === 1);
  assert.deepEqual((await stats(other)).parameters.gravity.acceleration, [0, 1, 0]);
  // 1 m long, pinned at its top edge, y = 0.5: it hung with its centre at y = 0. It rises now, turned over to y = 1 or, by
  // how it moved just then, caught in folds of its own, of which the lowest seen had its centre at y = 0.53.
  await until(other, () => weft.stats.cloths[0].centre[1] > 0.3);
});

test('a slider goes by the arrow keys, and sends at most ten messages a second', async () => {
  await page.evaluate(() => {
    window.tuned = 0;
    const send = Worker.prototype.postMessage;
    Worker.prototype.postMessage = function (message, ...rest) {
      if (JSON.stringify(message).includes('effect.tune')) window.tuned += 1;
      return send.call(this, message, ...rest);
    };
  });
  const slider = page.getByRole('slider', {name: 'Drag, slider'});
  await slider.focus();
  const begin = Date.now();
  for (let i = 0; i < 30; ++i) await page.keyboard.press('ArrowLeft');  // from 2.5 by 30 steps of 0.05
  const seconds = (Date.now() - begin) / 1000;
  await dragIs(other, 1);
  const sent = await page.evaluate(() => window.tuned);
  assert.ok(sent >= 1 && sent <= 2 + 10 * (seconds + 0.1), `${sent} messages in ${seconds} s`);
  assert.equal(await drag(page).inputValue(), '1');
});

test('a viewer who comes later sees it; a reset brings the scene’s own back', async () => {
  await other.reload();
  await dragIs(other, 1);
  await page.click('#reset');
  await dragIs(other, 1.2);
  await until(page, () => document.getElementById('tuning-aerodynamics-drag-0').value === '1.2');
  assert.deepEqual((await stats(page)).parameters.gravity.acceleration, [0, -9.81, 0]);
});

test('another scene has its own', async () => {
  await page.selectOption('#scene', 'flag');
  await until(page, () => weft.stats.scene === 'flag');
  assert.deepEqual(Object.keys((await stats(page)).parameters), ['aerodynamics', 'gravity']);
});
