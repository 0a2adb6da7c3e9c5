// The link to the present view: what it says, and what opening it does.
import assert from 'node:assert/strict';
import {before, test} from 'node:test';
import {openPage, openScene, startServer, stats, until} from './harness.mjs';

const kOwnEye = [2.25, 0.5, 4.45];  // of the scene zheng2020-distance

let server, page, link;
before(async () => {
  server = await startServer(['flag', 'zheng2020-distance']);
  ({page} = await openScene(server, 'flag', {permissions: ['clipboard-read', 'clipboard-write']}));
});

const open = async (address) => {
  const opened = await openPage(address);
  await until(opened.page, () => weft.stats.connected && weft.stats.cloths.length > 0);
  return opened.page;
};
const near = (eye, wanted) => eye.forEach((value, axis) => assert.ok(Math.abs(value - wanted[axis]) < 1e-3, `eye at ${eye}, not at ${wanted}`));

test('the button copies scene, camera, wind and what the page was asked for, but no token', async () => {
  for (let press = 0; press < 5; ++press) await page.keyboard.press('ArrowLeft');
  await page.keyboard.press('w');
  await page.fill('#wind-gusts', '0.5');
  await until(page, () => weft.stats.wind.gusts === 0.5);
  await page.evaluate(() => history.replaceState(null, '', `${location.href}#token=a-token-of-a-viewer`));
  await page.click('#copy-link');
  await page.waitForSelector('.toast >> text=The link is on the clipboard.');
  link = new URL(await page.evaluate(() => navigator.clipboard.readText()));
  assert.equal(link.hash, '');
  assert.deepEqual([...link.searchParams.keys()].sort(), ['eye', 'gusts', 'quality', 'scene', 'target', 'wind', 'wireframe']);
  assert.equal(link.searchParams.get('scene'), 'flag');
  assert.equal(link.searchParams.get('gusts'), '0.5,3');
  near(link.searchParams.get('eye').split(',').map(Number), (await stats(page)).eye);
});

test('opened, it has the same camera, and changes nothing of what the others see', async () => {
  const {eye, wind: present} = await stats(page);
  const other = await open(link.href);
  near((await stats(other)).eye, eye);
  assert.equal(await other.isChecked('#wireframe'), true);
  assert.equal(await other.isVisible('#wind-linked'), false);  // the scene has the link's wind
  assert.deepEqual((await stats(other)).wind, present);
  await other.close();
});

test('wind that is not the scene’s is offered, and set when the viewer says so', async () => {
  await page.fill('#wind-speed', '1');
  await page.fill('#wind-gusts', '0');
  await until(page, () => weft.stats.wind.speed === 1 && weft.stats.wind.gusts === undefined);
  const other = await open(link.href);
  assert.equal(await other.textContent('#wind-linked-text'), 'The link has other wind: 7.0 m/s.');
  assert.equal((await stats(other)).wind.speed, 1);
  await other.click('#wind-linked-set');
  await until(page, () => weft.stats.wind.speed === 7 && weft.stats.wind.gusts === 0.5);
  assert.equal(await other.isVisible('#wind-linked'), false);
  await other.close();
});

test('another scene has its own camera, and its own address', async () => {
  const other = await open(link.href);
  await other.selectOption('#scene', 'zheng2020-distance');
  await until(other, () => weft.stats.scene === 'zheng2020-distance' && weft.stats.cloths.length > 0);
  near((await stats(other)).eye, kOwnEye);
  assert.equal(new URL(other.url()).search, '?quality=low&scene=zheng2020-distance&wireframe=1');
  await other.close();
});

test('without a clipboard the link is there to be copied', async () => {
  await page.evaluate(() => Object.defineProperty(navigator, 'clipboard', {value: undefined}));
  await page.click('#copy-link');
  await page.waitForSelector('#link-text:not([hidden])');
  assert.ok((await page.inputValue('#link-text')).startsWith(`${server.address}/?quality=low&scene=flag`));
  assert.ok(await page.evaluate(() => getSelection().toString() !== '' || document.activeElement.selectionEnd > 0));
});
