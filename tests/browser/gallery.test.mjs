// The gallery: a card a scene, each with a stream of its own while it is in sight, and the way to a scene and back.
import assert from 'node:assert/strict';
import {before, test} from 'node:test';
import {setTimeout as sleep} from 'node:timers/promises';
import {differingPixels, hide, openPage, openScene, sent, startServer, stats, until, viewersAre} from './harness.mjs';

const kScenes = ['flag', 'curtain', 'zheng2020-distance', 'zheng2020-wind', 'fan', 'flag-gusts'];
const kMostLive = 4;
/** Cards are small here, so that the server's pictures are few and drawn soon; what is below is out of sight. */
const kWindow = {viewport: {width: 700, height: 420}, deviceScaleFactor: 0.5, reducedMotion: 'no-preference'};

let server, page, witness;
before(async () => {
  server = await startServer(kScenes);
  ({page, witness} = await openPage(`${server.address}/?quality=low`, kWindow));
  await page.waitForSelector('.card');
});

const live = (of = page) => of.$$eval('.card[data-state=live]', (cards) => cards.map(({dataset}) => dataset.scene));
const streams = (scene) => page.waitForSelector(`.card[data-scene="${scene}"][data-state=live][data-frames]`);

test('a card a scene: title, name, cloths, viewers, and the address that opens it', async () => {
  const {scenes} = await (await fetch(`${server.address}/v1/scenes`)).json();
  assert.deepEqual(scenes.map(({name}) => name), kScenes);
  const cards = await page.$$eval('.card', (all) => all.map((card) => [card.dataset.scene, card.querySelector('h2').textContent, new URL(card.href).search]));
  assert.deepEqual(cards, scenes.map(({name, title}) => [name, title, `?quality=low&scene=${name}`]));
  assert.equal(await page.textContent('.card .facts'), 'one cloth · no viewers');
  assert.equal(await page.textContent('#gallery-summary'), '6 scenes');
});

test('the pictures in sight move, at the coarsest level, and no more than a few at once', async () => {
  await streams('flag');
  const shoot = () => page.locator('.card[data-scene=flag] canvas').screenshot();
  const first = await shoot();
  const frames = await page.getAttribute('.card[data-scene=flag]', 'data-frames');
  await page.hover('.card[data-scene=flag]');  // it has its turn as long as the viewer points at it
  await page.waitForFunction((before) => Number(document.querySelector('.card[data-scene=flag]').dataset.frames) > before + 10, Number(frames));
  const moved = await differingPixels(page, first, await shoot());
  assert.ok(moved.differing > 0.01 * moved.all, `${moved.differing} of ${moved.all} pixels changed`);
  const shown = await live();
  assert.ok(shown.includes('flag') && shown.length <= kMostLive, `${shown} are live`);
  const metrics = await (await fetch(`${server.address}/metrics`)).text();
  assert.equal(metrics.match(/^weft_scene_viewers\{level="4",scene="flag"\} (\d+)$/m)?.[1], '1');
});

test('a card out of sight costs nothing, until it is scrolled to', async () => {
  assert.ok(!(await live()).includes('flag-gusts'));
  await page.locator('.card[data-scene=flag-gusts]').scrollIntoViewIfNeeded();
  await streams('flag-gusts');
  assert.ok(!(await live()).includes('flag'));
});

test('hidden, the gallery has no connection; in sight again, it has', async () => {
  await hide(page, true);
  await viewersAre(server, 0);
  const before = await sent(server);
  await sleep(500);
  assert.deepEqual(await sent(server), before);
  await hide(page, false);
  await streams('flag-gusts');
});

test('a card opens its scene, the button goes back, and so does the browser', async () => {
  await page.click('.card[data-scene=curtain]');
  await until(page, () => weft.stats.connected && weft.stats.scene === 'curtain' && weft.stats.cloths.length > 0);
  assert.equal(new URL(page.url()).searchParams.get('scene'), 'curtain');
  assert.equal(await page.isVisible('#gallery'), false);
  await viewersAre(server, 1);  // no card streams any more

  await page.click('#scenes');
  await streams('curtain');
  assert.equal(new URL(page.url()).search, '?quality=low');
  assert.equal(await page.isVisible('#scene-page'), false);
  assert.equal(await page.evaluate(() => document.activeElement.dataset.scene), 'curtain');

  await page.goBack();
  await until(page, () => weft.stats.connected && weft.stats.scene === 'curtain');
  await page.selectOption('#scene', 'fan');
  await until(page, () => weft.stats.scene === 'fan' && weft.stats.cloths.length > 0);
  await page.goBack();
  await until(page, () => weft.stats.scene === 'curtain' && weft.stats.cloths.length > 0);
  await page.goBack();
  await page.waitForSelector('#gallery:not([hidden])');
  await page.goForward();
  await until(page, () => weft.stats.connected && weft.stats.scene === 'curtain');
  await page.goBack();
  await page.waitForSelector('#gallery:not([hidden])');
});

test('by keyboard: Tab reaches a card, Enter opens it', async () => {
  await page.focus('.card[data-scene=flag]');
  await page.keyboard.press('Tab');
  assert.equal(await page.evaluate(() => document.activeElement.dataset.scene), 'curtain');
  assert.notEqual(await page.$eval('.card[data-scene=curtain]', (card) => getComputedStyle(card).outlineStyle), 'none');
  await page.keyboard.press('Enter');
  await until(page, () => weft.stats.connected && weft.stats.scene === 'curtain');
  await page.goBack();
});

test('it counts the viewers of a scene, but not itself', async () => {
  const {page: other} = await openScene(server, 'fan');
  await page.waitForFunction(() => document.querySelector('.card[data-scene=fan] .facts').textContent === 'one cloth · one viewer');
  await other.close();
});

test('who wants little motion gets pictures that stand still, and the server has peace', async () => {
  const {page: still} = await openPage(`${server.address}/?quality=low`, {...kWindow, reducedMotion: 'reduce'});
  await page.close();
  await still.waitForSelector('.card[data-scene=flag][data-frames][data-state=still]');
  await viewersAre(server, 0);
  const shoot = () => still.locator('.card[data-scene=flag] canvas').screenshot();
  assert.equal((await differingPixels(still, await shoot(), await shoot(), 0)).differing, 0);
  await still.close();
});

test('one scene is opened straight away', async () => {
  const single = await startServer(['flag']);
  const {page: other} = await openPage(`${single.address}/?quality=low`);
  await until(other, () => weft.stats.connected && weft.stats.cloths.length > 0);
  assert.equal((await stats(other)).scene, 'flag');
  assert.equal(new URL(other.url()).searchParams.get('scene'), 'flag');
  assert.equal(await other.isVisible('#scenes'), false);
  await other.close();
});

test('the console is clean', () => assert.deepEqual(witness.errors, []));
