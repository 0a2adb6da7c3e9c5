// What can be set of a cloth's material, and of the friction of balls and obstacles, has sliders and fields, the same for all viewers.
import assert from 'node:assert/strict';
import {before, test} from 'node:test';
import {fileURLToPath} from 'node:url';
import {openScene, skip, startServer, stats, until} from './harness.mjs';

// By their places in scenes/rubbing.json, where gravity leans by 3 / 9.81.
const kFloor = 0, kBox = 1, kLying = 0, kHung = 1;

let server, page, other;
before(async () => {
  server = await startServer([fileURLToPath(new URL('scenes/rubbing.json', import.meta.url)), 'flag']);
  ({page} = await openScene(server, 'rubbing'));
  ({page: other} = await openScene(server, 'rubbing'));
});

const friction = (of, fieldset) => of.locator(fieldset).getByRole('spinbutton', {name: 'Friction'});
const frictionsAre = (of, wanted) => until(of, (all) => JSON.stringify(weft.stats.frictions) === JSON.stringify(all), wanted);
const number = (of, name) => of.locator('#material').getByRole('spinbutton', {name});
const centre = (index) => weft.stats.cloths.find((each) => each.cloth === index).centre;

async function rest(index) {
  await skip(server, 'rubbing', 20);
  await until(page, (cloth) => weft.stats.server?.cloths[cloth].state === 'asleep', index);
}

async function type(field, text) {
  await field.fill(text);
  await field.press('Enter');
}

test('the friction of what is chosen has a labelled field and slider', async () => {
  assert.deepEqual((await stats(page)).frictions, [0.9, 0.2]);
  assert.equal(await page.inputValue('#obstacle'), String(kBox));
  assert.equal(await friction(page, '#obstacles').inputValue(), '0.2');
  await page.selectOption('#obstacle', String(kFloor));
  assert.equal(await friction(page, '#obstacles').inputValue(), '0.9');
  assert.equal(await friction(page, '#balls').inputValue(), '0.3');
  await page.selectOption('#ball', '2');
  assert.equal(await friction(page, '#balls').inputValue(), '0');
  for (const fieldset of ['#balls', '#obstacles']) {
    const slider = page.locator(fieldset).getByRole('slider', {name: 'Friction, slider'});
    assert.deepEqual(await slider.evaluate(({min, max}) => [min, max]), ['0', '1']);
    assert.equal(await friction(page, fieldset).getAttribute('max'), '10');
  }
});

test('a cloth that friction held slides away without it; every viewer is told', async () => {
  await rest(kLying);
  const [lay] = await page.evaluate(centre, kLying);
  assert.ok(Math.abs(lay) < 0.05, `it lies at ${lay}`);
  await type(friction(page, '#obstacles'), '0');
  await frictionsAre(other, [0, 0.2]);
  await other.selectOption('#obstacle', String(kFloor));
  assert.equal(await friction(other, '#obstacles').inputValue(), '0');
  await until(page, ([index, from]) => weft.stats.cloths.find((each) => each.cloth === index).centre[0] > from + 0.3, [kLying, lay]);
});

test('a ball has its own, here by the slider and its keys; the other ball keeps its own', async () => {
  const slider = page.locator('#balls').getByRole('slider', {name: 'Friction, slider'});
  await slider.focus();
  for (let i = 0; i < 5; ++i) await page.keyboard.press('ArrowRight');
  await until(other, () => weft.stats.balls.find(({ball}) => ball === 2).friction === 0.05);
  assert.equal((await stats(other)).balls.find(({ball}) => ball === 1).friction, 0.3);
  await other.selectOption('#ball', '2');
  assert.equal(await friction(other, '#balls').inputValue(), '0.05');
});

test('friction that the server refuses is told and taken back', async () => {
  await type(friction(page, '#balls'), '11');
  await page.getByText('/friction is 11; allowed: 0..10').waitFor();
  assert.equal(await friction(page, '#balls').inputValue(), '0.05');
});

test('a new ball is chosen, and has a friction of 0', async () => {
  await page.click('#ball-add');
  await until(page, () => weft.stats.balls.length === 3 && document.getElementById('ball').value === '3');
  await until(page, () => weft.stats.balls[2].friction === 0);
  assert.equal(await friction(page, '#balls').inputValue(), '0');
});

test('the numbers of each cloth’s material unfold by the keyboard, with the ranges that the server tells', async () => {
  const fold = page.getByRole('button', {name: 'Adjust the material'});
  assert.equal(await fold.getAttribute('aria-expanded'), 'false');
  assert.equal(await number(page, 'Damping').count(), 0);
  await page.bringToFront();
  await fold.focus();
  await page.keyboard.press('Enter');
  assert.ok(await page.getByRole('group', {name: 'the material'}).isVisible());
  const cloths = page.getByRole('combobox', {name: 'Cloth'});
  assert.deepEqual(await cloths.locator('option').allTextContents(), ['lying', 'hung']);
  await cloths.selectOption('hung');
  const fields = await page.$$eval('#material input[type=number]', (inputs) =>
    inputs.map((input) => [input.labels[0].textContent, Number(input.value), Number(input.min), Number(input.max)]));
  assert.deepEqual(fields, [
    ['Stiffness along u N/m', 100, 0, 1e9], ['Stiffness along v N/m', 100, 0, 1e9], ['Stiffness to shear N/m', 10, 0, 1e9], ['Stiffness to bending N/m', 0.01, 0, 1e9],
    ['Damping', 0.3, 0, 1e6], ['Rigidity along u N m', 1e-5, 0, 1e4], ['Rigidity along v N m', 2e-5, 0, 1e4], ['Rigidity of the twist N m', 3e-5, 0, 1e4]]);
  assert.equal(await page.locator('#material').getByRole('slider', {name: /, slider$/}).count(), fields.length);
});

test('a softer cloth hangs lower; the others stay as they are, and every viewer is told', async () => {
  await rest(kHung);
  const [, hung] = await page.evaluate(centre, kHung);
  await type(number(page, 'Stiffness along u'), '20');
  await until(other, (index) => weft.stats.materials[index].structural === 20, kHung);
  assert.equal((await stats(other)).materials[kLying].structural, 500);
  await other.selectOption('#material-cloth', String(kHung));
  await other.getByRole('button', {name: 'Adjust the material'}).click();
  assert.equal(await number(other, 'Stiffness along u').inputValue(), '20');
  // Alone the threads' springs let the mean of 1 m of 0.1 kg/m2 sink by rho g H / (3 Y): 3.3 mm at 100 N/m, 16.4 mm at 20 N/m. The
  // diagonal springs, which stay at 10 N/m, bear less than half of the weight: it sinks by more than half of the difference.
  await until(page, ([index, before]) => weft.stats.cloths.find((each) => each.cloth === index).centre[1] < before - 0.0065, [kHung, hung]);
});

test('one of three rigidities leaves the others', async () => {
  await type(number(page, 'Rigidity along v'), '0.001');
  await until(other, (index) => weft.stats.materials[index].rigidity[1] === 0.001, kHung);
  assert.deepEqual((await stats(other)).materials[kHung].rigidity, [1e-5, 0.001, 3e-5]);
});

test('a number that the server refuses is told and taken back', async () => {
  await type(number(page, 'Damping'), '-1e7');
  assert.equal(await number(page, 'Damping').inputValue(), '0');  // the least that is allowed
  await until(other, (index) => weft.stats.materials[index].damping === 0, kHung);
  await type(number(page, 'Damping'), '1e7');
  await page.getByText('/parameters/damping is 10000000; allowed: 0..1000000').waitFor();
  assert.equal(await number(page, 'Damping').inputValue(), '0');
});

test('a viewer who comes later sees it all; a reset brings the scene’s own back', async () => {
  await other.reload();
  await frictionsAre(other, [0, 0.2]);
  assert.equal((await stats(other)).materials[kHung].structural, 20);
  await page.click('#reset');
  await frictionsAre(other, [0.9, 0.2]);
  await until(other, () => weft.stats.balls.map((ball) => ball.friction).join() === '0.3,0');
  const {materials} = await stats(other);
  assert.deepEqual([materials[kHung].structural, materials[kHung].damping, materials[kHung].rigidity[1]], [100, 0.3, 2e-5]);
  await until(page, () => document.getElementById('tuning-material-structural-0').value === '100' && document.getElementById('obstacle-friction-number').value === '0.9');
});

test('a scene of one cloth has no choice, and without balls and obstacles no friction', async () => {
  await page.selectOption('#scene', 'flag');
  await until(page, () => weft.stats.scene === 'flag');
  assert.equal(await page.isVisible('#material-cloth'), false);
  assert.equal(await page.textContent('#material-name'), 'flag');
  assert.deepEqual(Object.keys((await stats(page)).materials[0]).sort(), ['bending', 'damping', 'rigidity', 'shear', 'structural', 'structural_weft']);
  await until(page, () => weft.stats.balls.length === 0);
  assert.equal(await page.isVisible('#ball-friction-number'), false);
});
