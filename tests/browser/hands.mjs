// A page for hands: fingers, and a mouse that flicks. By Chromium's protocol, and in Firefox by WebDriver BiDi.
import {after} from 'node:test';
import {BidiPage} from './bidi.mjs';
import {kFirefox} from './browsers.mjs';
import {openScene, until} from './harness.mjs';

const kFlickMs = 10, kFingerMs = 20;  // from movement to movement

const inFirefox = new Set();
after(() => Promise.all([...inFirefox].map((page) => page.close())));  // Chromium's are closed by the harness

/**
 * Opens a scene on a page of so many CSS pixels and waits until its cloth is there. `touch` puts one more finger down, moves all or
 * takes all up ('touchStart', 'touchMove', 'touchEnd'). `flick` presses the mouse at its first point, moves it through the others
 * and lets go.
 * @typedef {number[]} Point CSS pixels
 * @param {{width: number, height: number}} viewport
 * @returns {Promise<{page: {evaluate: Function, waitForFunction: Function}, touch: (type: string, ...points: Point[]) => Promise<void>,
 *          flick: (points: Point[]) => Promise<void>, errors: string[], close: () => Promise<void>}>}
 */
export const openByHand = (server, scene, viewport, {phone = false} = {}) =>
  kFirefox ? openInFirefox(server, scene, viewport) : openInChromium(server, scene, {viewport, ...(phone && {hasTouch: true, isMobile: true})});

/** Events have times of their own there: however late a busy machine brings them, the hand was as fast. */
async function openInChromium(server, scene, window) {
  const {page, witness: {errors}} = await openScene(server, scene, {pictures: null, ...window});  // a hand is followed at every one
  const session = await page.context().newCDPSession(page);
  let timestamp = Date.now() / 1000;
  const touch = (type, ...points) => session.send('Input.dispatchTouchEvent',
    {type, touchPoints: points.map(([x, y], id) => ({x, y, id})), timestamp: (timestamp += kFingerMs / 1000)});
  const mouse = (type, [x, y], buttons) => session.send('Input.dispatchMouseEvent',
    {type, x, y, button: 'left', buttons, clickCount: 1, timestamp: (timestamp += kFlickMs / 1000)});
  const flick = async (points) => {
    await mouse('mouseMoved', points[0], 0);
    await mouse('mousePressed', points[0], 1);
    for (const point of points.slice(1)) await mouse('mouseMoved', point, 1);
    await mouse('mouseReleased', points.at(-1), 0);
  };
  return {page, touch, flick, errors, close: () => page.close()};
}

async function openInFirefox(server, scene, viewport) {
  const page = await BidiPage.open(`${server.address}/?quality=low&scene=${scene}`, viewport);
  inFirefox.add(page);
  await until(page, () => window.weft?.stats.connected && weft.stats.cloths.length > 0);
  const close = () => inFirefox.delete(page) && page.close();
  return {page, touch: (type, ...points) => page.touch(type, points), flick: (points) => page.flick(points), errors: page.errors, close};
}
