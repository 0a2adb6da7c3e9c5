// The server goes and comes back on the same port: the page says so, waits, and carries on.
import assert from 'node:assert/strict';
import {test} from 'node:test';
import {openPage, openScene, startServer, stats, until} from './harness.mjs';

test('a restart of the server is survived', async () => {
  const first = await startServer(['flag', 'zheng2020-distance']);
  const {page} = await openScene(first, 'zheng2020-distance');
  await page.keyboard.press('3');
  await until(page, () => weft.stats.cloths[0].level === 4);
  const before = await stats(page);

  await first.stop();
  await page.waitForSelector('#banner:not([hidden])');
  assert.equal(await page.textContent('#connection'), 'not connected');
  assert.equal(await page.isDisabled('#pause'), true);
  // It goes on trying while there is nobody.
  await page.waitForSelector('#banner >> text=No answer from');
  const {eye} = await stats(page);  // where the key has led by now

  await startServer(['flag', 'zheng2020-distance'], {port: first.port});
  await page.waitForSelector('#banner', {state: 'hidden'});
  await until(page, () => weft.stats.connected);
  assert.equal(await page.textContent('#connection'), 'live');
  assert.equal(await page.isDisabled('#pause'), false);

  // The same scene from the same place: the new server has been told where the camera is.
  await until(page, ({frames}) => weft.stats.frames > frames + 5 && weft.stats.cloths[0]?.level === 4, before);
  const after = await stats(page);
  assert.equal(after.scene, 'zheng2020-distance');
  // The orbit's controls work the eye out anew for every picture: it is the same but for rounding.
  after.eye.forEach((value, axis) => assert.ok(Math.abs(value - eye[axis]) < 1e-9, `eye at ${after.eye}, was at ${eye}`));
  assert.ok(after.lastFrame.time < before.lastFrame.time || after.lastFrame.epoch === 1, 'it is the new server’s clock');
});

test('so is one that the gallery sees, which then shows what there is', async () => {
  const first = await startServer(['flag', 'curtain']);
  const {page} = await openPage(`${first.address}/?quality=low`, {reducedMotion: 'no-preference'});
  await page.waitForSelector('.card[data-scene=curtain][data-state=live][data-frames]');
  await first.stop();
  await page.waitForSelector('#banner:not([hidden]) >> text=No list of scenes from');
  await startServer(['flag', 'fan'], {port: first.port});
  await page.waitForSelector('.card[data-scene=fan][data-state=live][data-frames]');
  assert.equal(await page.isVisible('#banner'), false);
  assert.deepEqual(await page.$$eval('.card', (cards) => cards.map(({dataset}) => dataset.scene)), ['flag', 'fan']);
  await page.close();
});
