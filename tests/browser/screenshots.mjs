// The pictures of the README, from a running page: WEFT_SCREENSHOTS=folder WEFT_BINARY=... WEFT_PAGE=... node --test screenshots.mjs
// Not a test: it draws at full quality, which takes a while without a graphics card.
import {mkdir} from 'node:fs/promises';
import {join} from 'node:path';
import {test} from 'node:test';
import {setTimeout as sleep} from 'node:timers/promises';
import {fileURLToPath} from 'node:url';
import WebSocket from 'ws';
import {connect} from '../../protocol/clients/js/weft.js';
import {openPage, startServer, until} from './harness.mjs';

const folder = process.env.WEFT_SCREENSHOTS;
/** Each preset at its own moment, s, and, where its own camera is too near or too far for a picture of all of it, from another distance, m. */
const kGallery = {
  'flag': [3], 'flag-gusts': [4], 'curtain': [3], 'fan': [4], 'tablecloth': [3], 'silk': [6], 'round-table': [4], 'cape': [7.5], 'walker': [7.5], 'sail': [6],
  'trampoline': [1.1], 'washing-line': [4], 'towel': [7], 'hide': [4], 'cushion': [1.3], 'pillow': [4], 'paper-screen': [0.65], 'swing': [1.2],
  'zheng2020-wind': [8, 2], 'zheng2020-distance': [5, 2.4], 'zheng2020-ball': [9, 1.9],
};
const kBrief = 2;  // s; what happens before is over by the time a page is drawn, and is reached step by step
/** What the moving picture of the gallery shows: as many as stream at once. */
const kMoving = ['flag', 'curtain', 'walker', 'trampoline'];
const kPictures = 60, kPictureSeconds = 0.1;  // of the scenes' time
const kNothingBeside = {content: '.panel, #wind-arrow, #loupe, #banner { display: none !important }'};
const kWindow = {viewport: {width: 1280, height: 800}, deviceScaleFactor: 1};

/** The gallery as it moves, a picture every kPictureSeconds: the scenes wait for it, as drawing without a graphics card is slow. */
async function moving() {
  const server = await startServer(kMoving);
  const scenes = await Promise.all(kMoving.map((name) => connect(`ws://127.0.0.1:${server.port}/v1/scenes/${name}`, {WebSocket})));
  await Promise.all(scenes.map((scene) => scene.pause()));
  const {page} = await openPage(server.address, {viewport: {width: 1280, height: 380}, deviceScaleFactor: 1, reducedMotion: 'no-preference'});
  await page.waitForFunction((count) => document.querySelectorAll('.card[data-frames]').length === count, kMoving.length);
  for (let i = 0; i < kPictures; ++i) {
    const shown = await page.$$eval('.card', (cards) => cards.map(({dataset}) => dataset.frames));
    await Promise.all(scenes.map((scene) => scene.step(Math.round(kPictureSeconds / scene.scene.dt))));
    await page.waitForFunction((before) => [...document.querySelectorAll('.card')].every(({dataset}, at) => dataset.frames !== before[at]), shown);
    await sleep(150);  // the last of the frames that were on their way
    await page.screenshot({path: join(folder, `moving-${String(i).padStart(2, '0')}.png`)});
  }
  await page.close();
  for (const scene of scenes) scene.close();
  await server.stop();
}

test('screenshots', {timeout: 900_000}, async () => {
  await mkdir(folder, {recursive: true});
  const own = ['small', 'fabrics'].map((name) => fileURLToPath(new URL(`scenes/${name}.json`, import.meta.url)));
  const server = await startServer([...Object.keys(kGallery), ...own]);
  const open = async (scene, options = {}) => {
    const {page} = await openPage(`${server.address}/?scene=${scene}`, {...kWindow, ...options});
    await until(page, () => weft.stats.connected && weft.stats.cloths.length > 0);
    return page;
  };
  /** Saves what the scene shows at `seconds` of its own time. */
  const save = async (page, name, seconds) => {
    await until(page, (time) => weft.stats.lastFrame.time >= time && weft.stats.server, seconds);
    await page.keyboard.press('Space');
    await until(page, () => weft.stats.lastFrame.paused && weft.stats.settled);
    await page.screenshot({path: join(folder, `${name}.png`)});
    await page.keyboard.press('Space');
    await until(page, () => !weft.stats.lastFrame.paused);
  };
  /** Brings a scene back to its start and steps it to `seconds`. */
  const stepTo = async (page, seconds) => {
    await page.keyboard.press('Space');
    await until(page, () => weft.stats.lastFrame.paused);
    const {epoch} = await page.evaluate(() => weft.stats.lastFrame);
    await page.keyboard.press('r');
    await until(page, (before) => weft.stats.lastFrame.epoch > before, epoch);
    for (let now = 0; now < seconds;) {
      await page.keyboard.press('.');
      await until(page, (before) => weft.stats.lastFrame.time > before, now);
      now = await time(page);
    }
    await until(page, () => weft.stats.settled);
  };
  const time = (page) => page.evaluate(() => weft.stats.lastFrame.time);

  const flag = await open('flag');
  await save(flag, 'flag', 3);
  await flag.close();
  const dark = await open('flag', {colorScheme: 'dark'});
  await save(dark, 'flag-dark', 3);
  await dark.close();

  const fabrics = await open('fabrics', {viewport: {width: 1280, height: 720}});
  await fabrics.addStyleTag(kNothingBeside);
  await save(fabrics, 'fabrics', 3);
  await fabrics.close();

  const cost = await open('small', {viewport: {width: 900, height: 860}});
  await cost.click('#cost summary');
  await cost.waitForSelector('#cost-chart canvas', {timeout: 300_000});
  await cost.locator('#quality-set').scrollIntoViewIfNeeded();
  await cost.focus('#stage');  // where Space pauses
  await save(cost, 'cost', await time(cost) + 1);
  await cost.close();

  const distance = await open('zheng2020-distance');
  for (const [key, name, level] of [['1', 'near', 6], ['2', 'middle', 5], ['3', 'far', 4]]) {
    await distance.keyboard.press(key);
    await until(distance, (wanted) => weft.stats.cloths[0].level === wanted, level);
    await save(distance, `distance-${name}`, await time(distance) + 1);
  }
  await distance.keyboard.press('2');
  await distance.keyboard.press('w');
  await until(distance, () => weft.stats.cloths[0].level === 5);
  await distance.evaluate(() => weft.setCameraDistance(1.6));
  await save(distance, 'wireframe', await time(distance) + 1);
  await distance.close();

  const ball = await open('zheng2020-ball');
  await ball.evaluate(() => weft.setCameraDistance(2.2));
  for (let turn = 0; turn < 20; ++turn) await ball.keyboard.press('ArrowRight');
  await ball.keyboard.press('r');
  await save(ball, 'ball', 9);
  await ball.close();

  for (const [scene, [seconds, distance]] of Object.entries(kGallery)) {
    const preset = await open(scene, {viewport: {width: 640, height: 640}});
    await preset.addStyleTag(kNothingBeside);
    if (distance) await preset.evaluate((metres) => weft.setCameraDistance(metres), distance);
    if (seconds < kBrief) {
      await stepTo(preset, seconds);
      await preset.screenshot({path: join(folder, `gallery-${scene}.png`)});
    } else {
      await save(preset, `gallery-${scene}`, seconds);
    }
    await preset.close();
  }

  await moving();

  // A finger's width for each button, and the cloth above the folded panel.
  const phone = await open('flag', {viewport: {width: 390, height: 844}, hasTouch: true, isMobile: true});
  await save(phone, 'phone', await time(phone) + 1);
  await phone.close();
});
