// A page that nobody sees, a tab behind another one, costs the server nothing.
import assert from 'node:assert/strict';
import {before, test} from 'node:test';
import {setTimeout as sleep} from 'node:timers/promises';
import {hide, openPage, openScene, sent, startServer, stats, until, viewersAre} from './harness.mjs';

let server, page, witness;
before(async () => {
  server = await startServer(['flag', 'curtain']);
  ({page, witness} = await openScene(server, 'flag'));
});

test('hidden, the page has no connection: nothing is sent to it, and its scene is not stepped for it', async () => {
  await page.keyboard.press('3');
  await until(page, () => weft.stats.distance > 11);
  await viewersAre(server, 1);
  await hide(page, true);
  await viewersAre(server, 0);
  assert.equal(await page.textContent('#connection'), 'resting');
  const before = await sent(server);
  const {frames} = await stats(page);
  await sleep(700);
  assert.deepEqual(await sent(server), before);
  assert.equal((await stats(page)).frames, frames);
});

test('seen again, it goes on from where the viewer was', async () => {
  const {eye, frames} = await stats(page);
  await hide(page, false);
  await until(page, (before) => weft.stats.connected && weft.stats.frames > before + 3, frames);
  assert.equal(await page.textContent('#connection'), 'live');
  const after = await stats(page);
  assert.equal(after.scene, 'flag');
  after.eye.forEach((value, axis) => assert.ok(Math.abs(value - eye[axis]) < 1e-6, `eye at ${after.eye}, was at ${eye}`));
  await until(page, () => weft.stats.cloths[0]?.level === 4);  // the server knows where the camera is
});

test('hidden and seen in one breath it is connected, once', async () => {
  for (const hidden of [true, false, true, false]) await hide(page, hidden);
  const {frames} = await stats(page);
  await until(page, (before) => weft.stats.connected && weft.stats.frames > before + 3, frames);
  await viewersAre(server, 1);
});

test('a page that is opened in the background connects when it is first seen', async () => {
  const {page: other} = await openPage(`${server.address}/?quality=low&scene=curtain`,
    {before: () => Object.defineProperty(document, 'hidden', {configurable: true, get: () => true})});
  await other.waitForFunction(() => window.weft?.setCameraDistance);
  await sleep(300);
  await viewersAre(server, 1);
  await hide(other, false);
  await until(other, () => weft.stats.connected && weft.stats.scene === 'curtain' && weft.stats.cloths.length > 0);
  await viewersAre(server, 2);
  await other.close();
});

test('hidden while there is no such scene, it does not ask again when it is seen', async () => {
  const {page: other} = await openPage(`${server.address}/?quality=low&scene=nonsense`);
  await other.waitForSelector('#banner:not([hidden]) >> text=This server has no scene');
  await hide(other, true);
  await hide(other, false);
  await sleep(200);
  assert.equal(await other.isVisible('#banner'), true);
  assert.equal(await other.textContent('#connection'), 'not connected');
  await other.close();
});

test('the console is clean', () => assert.deepEqual(witness.errors, []));
