// Starts the server and the browser for a test file, and says what a page shows.
import {spawn} from 'node:child_process';
import {once} from 'node:events';
import {createInterface} from 'node:readline';
import {after} from 'node:test';
import {setTimeout as sleep} from 'node:timers/promises';
import WebSocket from 'ws';
import {connect} from '../../protocol/clients/js/weft.js';
import {kFirefox, openBrowser} from './browsers.mjs';

/** Longest wait for anything: generous, since the browser draws on the processor and shares it. */
export const kPatienceMs = 60_000;

const children = new Set();
let browser = null;
after(async () => {
  await browser?.close();
  for (const child of children) child.kill('SIGTERM');
});

/**
 * `weft serve SCENES OPTIONS`, once it listens.
 * @returns {Promise<{address: string, port: number, stop: () => Promise<void>}>}
 */
export async function startServer(scenes, {port = 0, page = process.env.WEFT_PAGE, options = []} = {}) {
  const child = spawn(process.env.WEFT_BINARY, ['serve', ...scenes, '--port', String(port), '--web', page, '--quiet', ...options],
    {stdio: ['ignore', 'pipe', 'inherit']});
  children.add(child);
  const exited = once(child, 'exit').then(([code]) => {
    children.delete(child);
    throw new Error(`weft serve ended with ${code}`);
  });
  exited.catch(() => {});
  const lines = createInterface({input: child.stdout});
  const [line] = await Promise.race([once(lines, 'line'), exited]);
  const address = line.match(/https?:\/\/\S+?(?=\/?$)/)[0];
  return {
    address,
    port: Number(new URL(address).port),
    stop: async () => {
      child.kill('SIGTERM');
      await exited.catch(() => {});
    },
  };
}

/** Firefox itself logs a socket that its page closes before it is open, as a page does that is hidden just then: as the page's error, or as the console's. */
const kFirefoxOwn = /^Firefox can’t establish a connection to |^The connection to ws\S+ was interrupted while the page was loading/;

/** Pictures a second that a page draws here: the processor makes each, and the scenes need it. */
const kPictures = 15;

/** Has a page come to draw at most so many times a second. */
function drawSeldom(pictures) {
  const ask = window.requestAnimationFrame.bind(window), asked = new Set();
  window.requestAnimationFrame = (draw) => {
    const id = setTimeout(() => ask((time) => asked.delete(id) && draw(time)), 1000 / pictures);
    asked.add(id);
    return id;
  };
  window.cancelAnimationFrame = (id) => asked.delete(id);
}

/** Every page opened so far logs here what it must not do. */
export class Witness {
  constructor(page) {
    this.requests = [];
    this.errors = [];
    page.on('request', (request) => this.requests.push(request.url()));
    page.on('console', (message) => message.type() === 'error' && this.#note(message.text()));
    page.on('pageerror', (error) => this.#note(String(error)));
  }

  #note(text) {
    if (!(kFirefox && kFirefoxOwn.test(text))) this.errors.push(text);
  }
}

/**
 * Opens a page in a window of its own; `before` is what it does before anything else. It draws `pictures` a second, or as many as the
 * browser asks for if null: `weft.stats.settled` only ever holds while a scene runs if each frame is drawn.
 * @returns {Promise<{page: import('playwright-core').Page, witness: Witness}>}
 */
export async function openPage(address, options = {}) {
  browser ??= await openBrowser();
  const {before, pictures = kPictures, ...window} = options;
  const page = await browser.newPage({viewport: {width: 900, height: 640}, deviceScaleFactor: 0.25, reducedMotion: 'reduce', ...window});
  page.setDefaultTimeout(kPatienceMs);
  const witness = new Witness(page);
  // WebDriver cannot set what the viewer prefers: Firefox's page is told by its own question.
  if (kFirefox) await page.addInitScript(preferMotion, window.reducedMotion ?? 'reduce');
  if (pictures) await page.addInitScript(drawSeldom, pictures);
  if (before) await page.addInitScript(before);
  await page.goto(address);
  return {page, witness};
}

/** Has `matchMedia` answer a page's question for reduced motion. */
function preferMotion(wanted) {
  const ask = window.matchMedia.bind(window);
  window.matchMedia = (query) => {
    const answer = ask(query);
    if (query.includes('prefers-reduced-motion')) Object.defineProperty(answer, 'matches', {value: query.includes(wanted)});
    return answer;
  };
}

/** Opens a scene and waits until its cloth is on the page. */
export async function openScene(server, scene, options) {
  const opened = await openPage(`${server.address}/?quality=low&scene=${scene}`, options);
  await until(opened.page, () => weft.stats.connected && weft.stats.cloths.length > 0);
  return opened;
}

/** Lets a scene get on by so many seconds as fast as its steps can be made: nobody has to watch it come to rest. */
export async function skip(server, scene, seconds) {
  const viewer = await connect(`ws://127.0.0.1:${server.port}/v1/scenes/${scene}`, {WebSocket, timeout: kPatienceMs});
  await viewer.pause();
  for (let left = Math.ceil(seconds / viewer.scene.dt); left > 0; left -= 600) {
    // The answer and the last frame may come together: then the frame has been dealt with when the answer is.
    let newest = 0, wanted = Infinity;
    const arrived = viewer.nextFrame(({stamp}) => (newest = stamp.f) >= wanted);
    arrived.catch(() => {});  // not waited for if it is
    ({f: wanted} = await viewer.step(Math.min(left, 600)));
    if (newest < wanted) await arrived;
  }
  await viewer.resume();
  viewer.close();
}

/**
 * Starts a scene again and leaves it paused after so many steps: the same state on any machine.
 * @returns {Promise<number>} its time
 */
export async function pauseAfter(server, scene, steps) {
  const viewer = await connect(`ws://127.0.0.1:${server.port}/v1/scenes/${scene}`, {WebSocket, timeout: kPatienceMs});
  await viewer.pause();
  await viewer.reset();
  await viewer.step(steps);
  viewer.close();
  return steps * viewer.scene.dt;
}

/** Waits until a condition, evaluated in the page, holds; says what the page knew when it never did. */
export async function until(page, condition, argument) {
  try {
    await page.waitForFunction(condition, argument, {timeout: kPatienceMs, polling: 50});
  } catch (error) {
    const stats = await page.evaluate(() => JSON.stringify(window.weft?.stats)).catch(() => 'page is gone');
    throw new Error(`never true: ${condition} (${JSON.stringify(argument)}); the page says ${stats}`, {cause: error});
  }
}

/** Has a page believe that it is hidden, as a tab behind another one, or that it is seen again. */
export const hide = (page, hidden) => page.evaluate((on) => {
  Object.defineProperty(document, 'hidden', {configurable: true, get: () => on});
  document.dispatchEvent(new Event('visibilitychange'));
}, hidden);

/** A server's metric without labels. */
export async function metric(server, name) {
  const text = await (await fetch(`${server.address}/metrics`)).text();
  return Number(text.match(new RegExp(`^${name} (\\S+)$`, 'm'))[1]);
}

/** What a server has sent so far, over all connections. */
export const sent = async (server) =>
  Promise.all(['weft_sent_frames_total', 'weft_sent_texts_total'].map((name) => metric(server, name)));

/** Waits until a server has so many viewers. */
export async function viewersAre(server, wanted) {
  const endMs = Date.now() + kPatienceMs;
  let viewers;
  while ((viewers = await metric(server, 'weft_viewers')) !== wanted) {
    if (Date.now() > endMs) throw new Error(`the server has ${viewers} viewers, not ${wanted}`);
    await sleep(50);
  }
}

export const stats = (page) => page.evaluate(() => weft.stats);

/** Stops the scene's clock and waits until the picture stands still. */
export async function pause(page) {
  await page.click('#pause');
  await until(page, () => weft.stats.lastFrame.paused && weft.stats.settled);
}

/** The square of the page that covers a square of `metres` around a point of the scene, for screenshots. */
export async function areaAround(page, point, metres) {
  return page.evaluate(({point: [x, y, z], metres}) => {
    const [, top] = weft.toPage([x, y + metres / 2, z]);
    const [left, middle] = weft.toPage([x, y, z]);
    const half = Math.round(middle - top);
    return {x: Math.round(left) - half, y: Math.round(middle) - half, width: 2 * half, height: 2 * half};
  }, {point, metres});
}

/**
 * How many pixels of two screenshots differ by more than `threshold` in some channel, and how many there are.
 * The browser decodes them: no image library is needed.
 */
export async function differingPixels(page, before, after, threshold = 8) {
  const [a, b] = [before, after].map((image) => image.toString('base64'));
  return page.evaluate(async ({a, b, threshold}) => {
    const pixels = async (text) => {
      const bytes = Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
      const image = await createImageBitmap(new Blob([bytes], {type: 'image/png'}));
      const pen = new OffscreenCanvas(image.width, image.height).getContext('2d');
      pen.drawImage(image, 0, 0);
      return pen.getImageData(0, 0, image.width, image.height).data;
    };
    const [first, second] = [await pixels(a), await pixels(b)];
    let differing = 0;
    for (let at = 0; at < first.length; at += 4) {
      if ([0, 1, 2].some((channel) => Math.abs(first[at + channel] - second[at + channel]) > threshold)) ++differing;
    }
    return {differing, all: first.length / 4};
  }, {a, b, threshold});
}
