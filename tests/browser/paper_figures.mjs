// Draws the paper's Figs. 5 to 7 with the real page and the real server; not a test: tests/browser/pictures runs it.
import {mkdir} from 'node:fs/promises';
import {test} from 'node:test';
import WebSocket from 'ws';
import {connect} from '../../protocol/clients/js/weft.js';
import {openPage, startServer, until} from './harness.mjs';

const kFolder = process.env.WEFT_SCREENSHOTS;
const kNear = 0.9, kMiddle = 5, kFar = 12;  // one distance in each of Table 1's bands
const kWide = 80;                           // field of view near by, degrees: a cloth of 1 m is seen whole from 0.9 m
const kShown = 1.3;                         // side of a picture, in sides of the cloth: as the page's magnifying glass

/**
 * Calls `take(page, frame)` at each of the scene's frames, seen from `distance`. A second client holds the clock.
 */
async function atFrames(scene, distance, frames, take) {
  const server = await startServer([scene]);
  const control = await connect(`${server.address.replace('http', 'ws')}/v1/scenes/${scene}`, {WebSocket});
  await control.camera({distance});
  const {page} = await openPage(`${server.address}/?scene=${scene}${distance < 1 ? `&fov=${kWide}` : ''}`,
    {viewport: {width: 1100, height: 900}, deviceScaleFactor: 1});
  await page.addStyleTag({content: '#badge, #controls, #wind-arrow {display: none}'});
  await until(page, () => weft.stats.connected && weft.stats.cloths.length > 0);
  await page.evaluate((metres) => weft.setCameraDistance(metres), distance);
  await control.pause();
  await control.reset();
  let at = 0;
  for (const frame of frames) {
    if (frame > at) await control.step(frame - at);
    at = frame;
    await until(page, (wanted) => weft.stats.lastFrame?.f === wanted, frame);
    await page.evaluate((metres) => weft.setCameraDistance(metres), distance);
    const level = {[kNear]: 6, [kMiddle]: 5, [kFar]: 4}[distance];
    await until(page, (wanted) => weft.stats.cloths[0].level === wanted && weft.stats.settled, level);
    await take(page, frame, control.scene.cloths[0].size[0]);
  }
  control.close();
  await page.close();
  await server.stop();
}

/** The cloth as it was sent, at one size whatever the distance: near by from the picture, else from the magnifying glass. */
async function portrait(page, name, side) {
  const glass = page.locator('#loupe');
  if (await glass.isVisible()) {
    await page.screenshot({path: `${kFolder}/${name}.png`, clip: await glass.boundingBox()});
    return;
  }
  const clip = await page.evaluate((height) => {
    const [{centre}] = weft.stats.cloths;
    const [x, y] = weft.toPage(centre);
    const [, top] = weft.toPage([centre[0], centre[1] + height / 2, centre[2]]);
    const half = Math.min(y - top, x, y, innerWidth - x, innerHeight - y);
    return {x: x - half, y: y - half, width: 2 * half, height: 2 * half};
  }, kShown * side);
  await page.screenshot({path: `${kFolder}/${name}.png`, clip});
}

test('figures', {timeout: 1_800_000}, async () => {
  await mkdir(kFolder, {recursive: true});
  await atFrames('zheng2020-wind', kNear, [0, 100, 200, 300, 400, 500], (page, frame, side) => portrait(page, `fig5-${frame}`, side));
  for (const distance of [kNear, kMiddle, kFar]) {
    await atFrames('zheng2020-distance', distance, [300], (page, frame, side) => portrait(page, `fig6-${distance}`, side));
    await atFrames('zheng2020-ball', distance, [100, 200, 300], (page, frame, side) => portrait(page, `fig7-${distance}-${frame}`, side));
  }
});
