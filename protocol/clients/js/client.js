/** A connection to one scene: greeted, followed, and made again where it breaks. */
import { ServerClock } from './clock.js';
import { Commands } from './commands.js';
import { Delivery } from './delivery.js';
import { WeftError } from './errors.js';
import { messageText } from './messages.js';
import { Requests } from './requests.js';
import { backoff, bearer, openSocket } from './transport.js';

/** What is held waits 5 s; in these there are fewer attempts. */
const MOST_SEATS = 8;

/**
 * @typedef {import('./types.js').Frame} Frame
 * @typedef {import('./types.js').Surface} Surface
 * @typedef {import('./types.js').Vector} Vector
 * @typedef {import('./types.js').Options} Options
 * @typedef {import('./types.js').Why} Why
 */

/** One connection to one scene. Use `connect`, or construct and `open()` to have the object before the connection. */
export class WeftClient extends Commands {
  /** The server's `welcome`. @type {any} */
  welcome = null;
  /** The scene's newest `scene` message. @type {any} */
  scene = null;

  #url;
  #options;
  /** @type {any} */
  #socket = null;
  #open = false;    // greeted, and not lost since
  #closed = false;  // for good
  #acks = false;
  #requests;
  #delivery;
  #clock = new ServerClock();
  /** @type {Parameters<Commands['camera']>[0]} as it was told last */
  #camera = undefined;
  /** The `scene` messages of connections that broke, by whose seats what this client holds may be had. @type {any[]} */
  #before = [];
  /** Ids of grabs that this client has not let go of. @type {Set<number>} */
  #held = new Set();
  /** Ends a wait between attempts early. @type {(() => void)|null} */
  #wake = null;

  /** @param {string|URL} url ws://HOST:PORT/v1/scenes/NAME @param {Options} [options] */
  constructor(url, options = {}) {
    super();
    this.#url = String(url);
    const complete = { window: 2, timeout: 5000, onerror: /** @param {Error} error */ (error) => console.error(error), ...options };
    this.#options = complete;
    this.#requests = new Requests(complete.timeout);
    this.#delivery = new Delivery({ ...complete, ready: () => this.#open, begin: () => this.#acknowledgement() });
  }

  /** The newest frame. @returns {Frame|null} */
  get frame() {
    return this.#delivery.frame;
  }

  /** True while connected and greeted. */
  get connected() {
    return this.#open;
  }

  /** Connects; with `reconnect`, tries until it succeeds or `close()` is called. @returns {Promise<this>} */
  async open() {
    for (let attempt = 0; ; ++attempt) {
      try {
        await this.#attempt();
        return this;
      } catch (error) {
        if (this.#closed || !this.#options.reconnect) throw error;
        await this.#wait(backoff(attempt), { error: /** @type {Error} */ (error) });
      }
    }
  }

  /** Ends the connection for good; open requests are rejected with code `closed`. */
  close() {
    if (this.#closed) return;
    this.#end(new WeftError('closed', 'closed by this client'), { code: 1000 });
    this.#wake?.();
    this.#socket?.close(1000);
  }

  /**
   * Sends a request and gives its `ok` or `pong`; rejects with the server's `error` as a WeftError.
   * @param {string} op @param {Record<string, any>} [members] @returns {Promise<any>}
   */
  send(op, members = {}) {
    return this.#requests.make(op, members, (text) => {
      if (this.#socket?.readyState !== 1) throw new WeftError('closed', 'not connected');
      this.#socket.send(text);
    }).finally(() => op === 'grab.release' && this.#held.delete(members.grab));
  }

  /**
   * Sends a message that only an error would answer (to `onmessage`): for streams such as a dragged ball. Dropped while not connected.
   * @param {string} op @param {Record<string, any>} [members]
   */
  post(op, members = {}) {
    const text = messageText(op, members);
    if (this.#socket?.readyState === 1) this.#socket.send(text);
  }

  /** Remembered, and told again after a reconnection. @param {Parameters<Commands['camera']>[0]} [where] */
  camera(where) {
    this.#camera = where;
    return super.camera(where);
  }

  /** Leaves the scene and joins another, also for reconnections. Its `scene` message and frames follow. @param {string} scene */
  async joinScene(scene) {
    const ok = await super.joinScene(scene);
    this.#held.clear();
    this.#url = new URL(encodeURIComponent(scene), this.#url).href;
    return ok;
  }

  /** What a mesh of the scene looks like. @param {number} obstacle its place in `scene` @returns {Promise<Surface>} */
  async surface(obstacle) {
    const place = new URL(`${encodeURIComponent(this.scene.name)}/meshes/${obstacle}`, this.#url.replace(/^ws/, 'http'));
    const answer = await fetch(place, { signal: AbortSignal.timeout(this.#options.timeout), headers: bearer(this.#options.token) });
    if (!answer.ok) throw new WeftError('not_found', await answer.text());
    return answer.json();
  }

  /**
   * Round-trip time, ms. The answer comes after the replies to all commands sent before, so that it is a barrier. Each ping that is
   * quicker than those before tells better how the server's clock goes (`age`).
   */
  async ping() {
    const t = performance.now();
    const pong = await this.send('ping', { t });
    const end = performance.now();
    this.#clock.note(t, end, pong.server_ms);
    return end - t;
  }

  /**
   * How long ago, ms, the server sent the frame off, to about half of the quickest ping's round trip; NaN before the first ping.
   * @param {Frame} frame
   */
  age(frame) {
    return this.#clock.age(frame.stamp.serverMs);
  }

  /**
   * The next frame for which `accept` is true.
   * @param {(frame: Frame) => boolean} [accept] @param {number} [timeout] ms @returns {Promise<Frame>}
   */
  nextFrame(accept = () => true, timeout = this.#options.timeout) {
    return this.#delivery.next(accept, timeout);
  }

  /** One attempt to connect: done when the server has greeted, sent the scene, and answered `hello`. */
  async #attempt() {
    if (this.#closed) throw new WeftError('closed', 'closed by this client');
    const { window: frames, client, coarser, compact, token } = this.#options;
    const caps = [...(frames ? ['flow.ack'] : []), ...(coarser ? ['flow.level'] : []), ...(compact ? ['grid.rice'] : [])];
    const socket = await openSocket(this.#url, token, this.#options.WebSocket);
    if (this.#closed) {  // while the socket was made
      socket.onerror = () => {};  // what `ws` says of a connection that is not awaited
      socket.close();
      throw new WeftError('closed', 'closed by this client');
    }
    this.#socket = socket;
    // One that breaks before it has taken over what an older one held is only the next to be asked for.
    this.#before = this.#held.size > 0 ? [...this.#before, ...(this.scene?.seat ? [this.scene] : [])].slice(-MOST_SEATS) : [];
    this.welcome = this.scene = null;
    this.#delivery.clear();
    this.#acks = false;
    this.#clock = new ServerClock();
    try {
      await this.#greeted(socket);
      if (caps.length > 0 || client) await this.send('hello', { client, caps, window: frames || undefined });
      // A camera refused then is refused now; the connection is good all the same.
      if (this.#camera) await super.camera(this.#camera).catch(() => {});
      await this.#resume();
      if (socket.readyState !== 1) throw new WeftError('closed', 'closed by the server');
    } catch (error) {
      socket.close();
      throw error;
    }
    this.#open = true;
    this.#options.onstate?.('open', {});
    this.#delivery.deliver();
  }

  /** Listens to the socket; done when the server has greeted and sent the scene. @param {any} socket @returns {Promise<void>} */
  #greeted(socket) {
    const { timeout } = this.#options;
    return new Promise((resolve, reject) => {
      const timer = setTimeout(() => reject(new WeftError('timeout', `no connection to ${this.#url} within ${timeout} ms`)), timeout);
      /** @param {string} why */
      const fail = (why) => {
        clearTimeout(timer);
        reject(new WeftError('connect', `no connection to ${this.#url}: ${why}`));
      };
      socket.addEventListener('error', /** @param {any} event */ (event) => fail(event.message || 'refused'));
      socket.addEventListener('close', /** @param {CloseEvent} event */ (event) => {
        fail(event.reason || `closed with ${event.code}`);
        if (this.#socket === socket) this.#lost(event);
      });
      socket.addEventListener('message', /** @param {MessageEvent} event */ ({ data }) => {
        if (this.#socket !== socket) return;
        this.#receive(data);
        if (this.welcome && this.scene) {
          clearTimeout(timer);
          resolve();
        }
      });
    });
  }

  /** The socket is closed: the end of an attempt, or of an open connection. @param {{code: number, reason: string}} event */
  async #lost({ code, reason }) {
    const wasOpen = this.#open;
    this.#open = false;
    const error = new WeftError('closed', `connection closed with ${code}${reason ? `: ${reason}` : ''}`);
    this.#requests.fail(error);
    if (this.#closed || !wasOpen) return;
    if (!this.#options.reconnect) {
      this.#end(error, { code, reason });
      return;
    }
    await this.#wait(backoff(0), { code, reason });
    // With reconnect only close() ends open() by an error, and it has told onstate.
    await this.open().catch(() => {});
  }

  /** No further connection will be made. @param {WeftError} error @param {Why} why */
  #end(error, why) {
    this.#closed = true;
    this.#open = false;
    this.#requests.fail(error);
    this.#delivery.fail(error);
    this.#options.onstate?.('closed', why);
  }

  /** @param {number} delay ms @param {Why} why @returns {Promise<void>} */
  #wait(delay, why) {
    this.#options.onstate?.('waiting', { ...why, delay });
    return new Promise((resolve) => {
      const timer = setTimeout(resolve, delay);
      this.#wake = () => {
        clearTimeout(timer);
        resolve();
      };
    });
  }

  /** Takes over what this client held before its connection broke, and lets go of what it let go of meanwhile. */
  async #resume() {
    /** @type {number[]} */
    let grabs = [];
    for (const { name, seat } of this.#before) {
      if (name !== this.scene.name) continue;
      try {
        ({ grabs } = await this.resumeSeat(seat));
      } catch (error) {
        // Broken again: it is asked for once more. Else it is too late, and all is released.
        if (['closed', 'timeout'].includes(/** @type {WeftError} */ (error).code)) throw error;
      }
    }
    this.#before = [];
    for (const grab of grabs) if (!this.#held.has(grab)) this.post('grab.release', { grab });
    for (const grab of this.#held) if (!grabs.includes(grab)) this.#held.delete(grab);
  }

  /** @param {string|ArrayBuffer} data */
  #receive(data) {
    if (typeof data !== 'string') {
      this.#delivery.put(data);
      return;
    }
    const message = JSON.parse(data);
    // Noted here and not where `hello` is awaited: a frame may follow before that code runs.
    if (message.op === 'ok' && message.caps) this.#acks = message.caps.includes('flow.ack');
    if (this.#requests.settle(message)) {
      if (message.op === 'ok' && message.grab !== undefined) this.#held.add(message.grab);
      return;
    }
    if (message.op === 'welcome') this.welcome = message;
    if (message.op === 'scene') this.scene = message;
    if (message.op === 'event' && message.kind === 'reset') this.#held.clear();
    this.#options.onmessage?.(message);
  }

  /** What acknowledges a frame that this connection has brought. @returns {(frame: Frame) => void} */
  #acknowledgement() {
    const socket = this.#socket;
    return (frame) => {
      if (this.#acks && this.#socket === socket) this.post('ack', { f: frame.stamp.f });
    };
  }
}

/**
 * Connects to a scene: resolved when the server has greeted, described the scene, and agreed on the flow of frames.
 * @param {string|URL} url ws://HOST:PORT/v1/scenes/NAME @param {Options} [options] @returns {Promise<WeftClient>}
 */
export function connect(url, options = {}) {
  return new WeftClient(url, options).open();
}
