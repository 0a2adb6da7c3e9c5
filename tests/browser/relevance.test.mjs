// The page tells what it has in sight: the server rests a cloth that no page sees, and steps it again when one turns back.
import assert from 'node:assert/strict';
import {before, test} from 'node:test';
import {fileURLToPath} from 'node:url';
import {openScene, startServer, stats, until} from './harness.mjs';

const kQuarter = 18;  // presses of an arrow key, 5 degrees each

let server, page;
before(async () => {
  server = await startServer([fileURLToPath(new URL('scenes/two.json', import.meta.url))]);
  ({page} = await openScene(server, 'two'));
});

async function turn(of, key, presses) {
  for (let press = 0; press < presses; ++press) await of.keyboard.press(key);
}
const eyeIs = (of, wanted) => until(of, (eye) => weft.stats.eye.every((value, axis) => Math.abs(value - eye[axis]) < 1e-6), wanted);
const rests = (of) => until(of, () => weft.stats.server?.cloths[1].unseen && weft.stats.server.cloths[1].state === 'asleep');
const isStepped = (of) => until(of, () => {
  const aside = weft.stats.server?.cloths[1];
  return aside && !aside.unseen && aside.state === 'awake' && aside.substeps > 0;
});
const levelOf = (cloth) => weft.stats.cloths.find((each) => each.cloth === cloth).level;

// From 5 m before the near cloth the other one is 58 degrees aside, the picture's corner less than 45.
test('the cloth beside the picture rests, and comes at its lowest level; the other one goes on', async () => {
  await rests(page);
  await until(page, () => weft.stats.cloths.find((each) => each.cloth === 1).level === 4);
  assert.equal(await page.evaluate(levelOf, 0), 5);
  const {server: told} = await stats(page);
  assert.equal(told.cloths[0].state, 'awake');
  assert.equal(told.cloths[0].unseen, undefined);
  assert.equal(told.cloths[1].substeps, 0);
  await until(page, () => document.getElementById('badge-others').textContent === 'aside: 16 × 16, 9.4 m, unseen');
});

test('turned towards it, it is stepped again, fine as before', async () => {
  await turn(page, 'ArrowLeft', kQuarter);
  await eyeIs(page, [-5, 0, 0]);  // it stands behind the near one, 13 m away
  await isStepped(page);
  await until(page, () => weft.stats.cloths.find((each) => each.cloth === 1).level === 5);
  await until(page, () => !document.getElementById('badge-others').textContent.includes('unseen'));
});

test('behind the camera it rests', async () => {
  await turn(page, 'ArrowRight', 2 * kQuarter);
  await eyeIs(page, [5, 0, 0]);
  await rests(page);
  // Now it is the nearest one, 3 m behind.
  await until(page, () => document.getElementById('number-substeps').textContent === 'none: unseen');
});

test('another page that sees it has it stepped for all', async () => {
  const {page: other} = await openScene(server, 'two');
  await turn(other, 'ArrowLeft', kQuarter);
  await isStepped(page);
  await isStepped(other);
  assert.equal(await page.evaluate(levelOf, 1), 4);
  await until(other, () => weft.stats.cloths.find((each) => each.cloth === 1).level === 5);
  await other.close();
  await rests(page);
});
