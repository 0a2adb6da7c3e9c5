// A torn cloth is drawn without its torn cells, at every level, and whole again after a reset.
import assert from 'node:assert/strict';
import {before, test} from 'node:test';
import {fileURLToPath} from 'node:url';
import {openScene, startServer, until} from './harness.mjs';

let page;
before(async () => {
  const server = await startServer([fileURLToPath(new URL('scenes/torn.json', import.meta.url))]);
  ({page} = await openScene(server, 'torn'));
});

const cloth = () => page.evaluate(() => weft.stats.cloths[0]);

test('torn cells are not drawn', async () => {
  await until(page, () => weft.stats.cloths[0].faces < (weft.stats.cloths[0].rows - 1) * (weft.stats.cloths[0].cols - 1));
  await until(page, () => weft.stats.lastFrame.time > 1.5);
  const {faces, rows, cols} = await cloth();
  // It tears across, a cell high, below its upper edge or above its lower one, hardly more.
  assert.ok(faces < (rows - 1) * (cols - 1) - 4 && faces > (rows - 1) * (cols - 1) / 2, `${faces} of ${rows - 1} x ${cols - 1}`);
});

test('nor are they at another level', async () => {
  await page.evaluate(() => weft.setCameraDistance(4));
  await until(page, () => weft.stats.cloths[0].level === 3);
  const {faces} = await cloth();
  assert.ok(faces < 64 - 2 && faces > 32, `${faces} of 64`);
});

test('a reset mends it, and it tears again', async () => {
  await page.click('#reset');
  await until(page, () => weft.stats.lastFrame.epoch > 1);
  await until(page, () => weft.stats.cloths[0].faces < (weft.stats.cloths[0].rows - 1) * (weft.stats.cloths[0].cols - 1));
});
