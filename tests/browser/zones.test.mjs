// Wind zones: drawn, hidden, and set by sliders in the panel.
import assert from 'node:assert/strict';
import {before, test} from 'node:test';
import {areaAround, differingPixels, openScene, pause, skip, startServer, stats, until} from './harness.mjs';

let server, page;
before(async () => {
  server = await startServer(['fan', 'flag']);
  ({page} = await openScene(server, 'fan', {deviceScaleFactor: 1}));  // pixels are counted
});

test('a zone is drawn where the scene has it, and can be hidden', async () => {
  await pause(page);
  // The fan's box, 3 m long, ends 1.5 m before the cloth; its corner there, 0.25 m up and aside, is in sight.
  const corner = [0.25, -0.25, 1.5];
  const area = await areaAround(page, corner, 0.1);
  const shown = await page.screenshot({clip: area});
  await page.getByLabel('Show them').uncheck();
  await until(page, () => weft.stats.settled);
  const hidden = await page.screenshot({clip: area});
  const {differing} = await differingPixels(page, shown, hidden, 20);
  assert.ok(differing >= 5, `${differing} pixels`);
  await page.getByLabel('Show them').check();
  await page.click('#pause');
});

test('its slider sets the speed of its air, along the way it blew', async () => {
  assert.equal(await page.textContent('#zones-list output'), '2.5 m/s');
  await page.fill('#zone-0', '1');
  await until(page, () => Math.abs(weft.stats.wind.zones[0].velocity[2] + 1) < 1e-9);
  assert.deepEqual((await stats(page)).wind.zones[0].velocity.slice(0, 2).map(Math.abs), [0, 0]);
  // Off and on again: it still knows which way.
  await page.fill('#zone-0', '0');
  await until(page, () => weft.stats.wind.zones[0].velocity.every((value) => value === 0));
  await page.fill('#zone-0', '3');
  await until(page, () => Math.abs(weft.stats.wind.zones[0].velocity[2] + 3) < 1e-9);
});

test('without its fan the curtain hangs down; a reset has the fan again', async () => {
  await skip(server, 'fan', 10);
  await until(page, () => weft.stats.cloths[0].centre[2] < -0.1);
  await page.fill('#zone-0', '0');
  await until(page, () => weft.stats.wind.zones[0].velocity[2] === 0);
  await skip(server, 'fan', 10);
  await until(page, () => weft.stats.cloths[0].centre[2] > -0.05);
  await page.click('#reset');
  await until(page, () => Math.abs(weft.stats.wind.zones[0].velocity[2] + 2.5) < 1e-9);
  await until(page, () => document.querySelector('#zones-list output').textContent === '2.5 m/s');
});

test('a scene without zones has no sliders for them', async () => {
  assert.equal(await page.isVisible('#zones'), true);
  await page.selectOption('#scene', 'flag');
  await until(page, () => weft.stats.scene === 'flag');
  assert.equal(await page.isVisible('#zones'), false);
});
