// Effects have switches in the panel, the same for all viewers.
import assert from 'node:assert/strict';
import {before, test} from 'node:test';
import {fileURLToPath} from 'node:url';
import {openScene, skip, startServer, stats, until} from './harness.mjs';

let server, page, other;
before(async () => {
  server = await startServer([fileURLToPath(new URL('scenes/small.json', import.meta.url)), 'flag']);
  ({page} = await openScene(server, 'small'));
  ({page: other} = await openScene(server, 'small'));
});

const checked = (of) => of.$$eval('#effects input[type=checkbox]', (boxes) => Object.fromEntries(boxes.map((box) => [box.dataset.effect, box.checked])));
const height = () => weft.stats.cloths[0].centre[1];

test('each effect of the scene has a switch with a plain label, and all are on', async () => {
  assert.deepEqual(await page.$$eval('#effects label.check', (labels) => labels.map((label) => label.textContent.trim())), ['Gravity', 'Damping']);
  assert.deepEqual(await checked(page), {gravity: true, damping: true});
});

test('without gravity the cloth rises: its springs draw it up again; the other viewer sees the switch', async () => {
  await skip(server, 'small', 20);
  await until(page, () => weft.stats.server?.cloths[0].state === 'asleep');
  const hung = await page.evaluate(height);
  await page.getByRole('checkbox', {name: 'Gravity'}).uncheck();
  await until(other, () => weft.stats.effectsOff.includes('gravity'));
  assert.deepEqual(await checked(other), {gravity: false, damping: true});
  // Hung, 1 m of 0.1 kg/m2 at 100 N/m is longer by rho g H / (2 Y) = 4.9 mm; its centre hangs by two thirds of that lower.
  await until(page, (before) => weft.stats.cloths[0].centre[1] > before + 0.0025, hung);
});

test('a viewer who comes later sees it too, and may switch it on again', async () => {
  await other.reload();
  await until(other, () => weft.stats.connected && weft.stats.cloths.length > 0);
  assert.deepEqual(await checked(other), {gravity: false, damping: true});
  await other.getByRole('checkbox', {name: 'Gravity'}).check();
  await until(page, () => weft.stats.effectsOff.length === 0);
  assert.deepEqual(await checked(page), {gravity: true, damping: true});
});

test('a reset brings all back', async () => {
  await page.getByRole('checkbox', {name: 'Damping'}).uncheck();
  await until(other, () => weft.stats.effectsOff.includes('damping'));
  await page.click('#reset');
  await until(other, () => weft.stats.effectsOff.length === 0);
  assert.deepEqual(await checked(other), {gravity: true, damping: true});
});

test('another scene has its own', async () => {
  await page.selectOption('#scene', 'flag');
  await until(page, () => weft.stats.scene === 'flag');
  assert.deepEqual(await checked(page), {gravity: true, damping: true, aerodynamics: true, plate_bending: true});
  assert.equal((await stats(page)).effectsOff.length, 0);
});
