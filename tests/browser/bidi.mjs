// A page of Firefox's by WebDriver BiDi itself: Playwright has no way to put down two fingers there, waits between the movements of
// its mouse, knows no dark mode, and shares its session with nobody.
import {spawn} from 'node:child_process';
import {once} from 'node:events';
import {mkdtempSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {setTimeout as sleep} from 'node:timers/promises';
import WebSocket from 'ws';
import {firefox, startScreen} from './browsers.mjs';

const kPreferences = {
  'dom.w3c_touch_events.enabled': 1,  // also where the machine has no touch screen
  'ui.prefersReducedMotion': 1,
};
const kMoveMs = 20;  // a movement of fingers

/** The part of Playwright's page that tests with hands need, `touch` and `flick`. */
export class BidiPage {
  #socket;
  #context;
  #answers = new Map();
  #lastId = 0;
  #fingers = 0;  // that are down
  /** What the page logs that it must not do. @type {string[]} */
  errors = [];

  /**
   * Starts a Firefox with one page of so many CSS pixels.
   * @param {string} address @param {{width: number, height: number}} viewport @param {Object<string, number>} preferences of its own
   */
  static async open(address, viewport, preferences = {}) {
    const page = new BidiPage(), screen = await startScreen();
    const {executablePath, env, firefoxUserPrefs} = firefox(screen.display);
    const profile = mkdtempSync(join(tmpdir(), 'weft-firefox-'));
    writeFileSync(join(profile, 'user.js'), Object.entries({...firefoxUserPrefs, ...kPreferences, ...preferences})
      .map(([name, value]) => `user_pref(${JSON.stringify(name)}, ${JSON.stringify(value)});\n`).join(''));
    const browser = spawn(executablePath, ['--remote-debugging-port', '0', '--profile', profile, '--no-remote'], {env, stdio: ['ignore', 'ignore', 'pipe']});
    page.close = async () => {
      browser.kill('SIGTERM');
      await once(browser, 'exit');
      screen.close();
      rmSync(profile, {recursive: true, maxRetries: 5});
    };
    const server = await new Promise((resolve, reject) => {
      browser.stderr.on('data', (text) => /ws:\/\/\S+/.test(text) && resolve(String(text).match(/ws:\/\/\S+/)[0]));
      browser.once('exit', (code) => reject(new Error(`Firefox ended with ${code}`)));
    });
    page.#socket = new WebSocket(`${server}/session`);
    await once(page.#socket, 'open');
    page.#socket.on('message', (text) => page.#receive(JSON.parse(text)));
    await page.#ask('session.new', {capabilities: {}});
    await page.#ask('session.subscribe', {events: ['log.entryAdded']});
    page.#context = (await page.#ask('browsingContext.create', {type: 'tab'})).context;
    await page.#ask('browsingContext.setViewport', {context: page.#context, viewport});
    await page.#ask('browsingContext.navigate', {context: page.#context, url: address, wait: 'complete'});
    return page;
  }

  /** What a function, told as text, returns in the page; both ways as JSON. */
  async evaluate(work, argument = null) {
    const {type, result, exceptionDetails} = await this.#ask('script.evaluate', {
      expression: `(async () => JSON.stringify(await (${work})(${JSON.stringify(argument)})) ?? 'null')()`,
      target: {context: this.#context}, awaitPromise: true,
    });
    if (type === 'exception') throw new Error(exceptionDetails.text);
    return JSON.parse(result.value);
  }

  async waitForFunction(condition, argument, {timeout, polling}) {
    for (const endMs = Date.now() + timeout; !(await this.evaluate(condition, argument)); await sleep(polling)) {
      if (Date.now() > endMs) throw new Error(`not within ${timeout} ms`);
    }
  }

  /** Fingers as Chromium's Input.dispatchTouchEvent has them: down with one more, moved, all up. @param {number[][]} points CSS pixels */
  async touch(type, points) {
    const actions = {
      touchStart: (i, {x, y}) => (i < this.#fingers ? [] : [{type: 'pointerMove', x, y}, {type: 'pointerDown', button: 0}]),
      touchMove: (i, {x, y}) => [{type: 'pointerMove', x, y, duration: kMoveMs}],
      touchEnd: () => [{type: 'pointerUp', button: 0}],
    }[type];
    const all = type === 'touchEnd' ? Array(this.#fingers).fill([0, 0]) : points;
    await this.#ask('input.performActions', {
      context: this.#context,
      actions: all.map(([x, y], i) => ({
        type: 'pointer', id: `finger ${i}`, parameters: {pointerType: 'touch'}, actions: actions(i, {x: Math.round(x), y: Math.round(y)}),
      })),
    });
    this.#fingers = type === 'touchEnd' ? 0 : points.length;
  }

  /** The mouse, pressed at the first point, moved through the others as fast as the machine brings it, and let go. @param {number[][]} points CSS pixels */
  async flick(points) {
    const [start, ...ways] = points.map(([x, y]) => ({type: 'pointerMove', x: Math.round(x), y: Math.round(y), duration: 0}));
    await this.#ask('input.performActions', {
      context: this.#context,
      actions: [{type: 'pointer', id: 'mouse', actions: [start, {type: 'pointerDown', button: 0}, ...ways, {type: 'pointerUp', button: 0}]}],
    });
  }

  #ask(method, params) {
    const id = ++this.#lastId;
    this.#socket.send(JSON.stringify({id, method, params}));
    return new Promise((resolve, reject) => this.#answers.set(id, {resolve, reject}));
  }

  #receive({id, type, result, error, message, params}) {
    if (type === 'event') return void (params.level === 'error' && this.errors.push(params.text));
    const answer = this.#answers.get(id);
    this.#answers.delete(id);
    if (type === 'error') answer.reject(new Error(`${error}: ${message}`));
    else answer.resolve(result);
  }
}
