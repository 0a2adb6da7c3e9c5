import {Commands} from '../protocol/weft.js';

/** The client's methods, by way of the worker. */
class LinkCommands extends Commands {
  /** @param {Link} link */
  constructor(link) {
    super();
    this.link = link;
  }

  send(op, members = {}) {
    return this.link.request({op, ...members});
  }
}

/**
 * The page's end of the connection. The socket itself, decoding and reconnecting live in worker.js.
 *
 * Events (all CustomEvents, payload in `detail`):
 *   state    {state: 'connecting'|'open'|'lost'|'refused'|'locked'|'resting', ...}  see worker.js
 *   message  a server message that is no reply: welcome, scene, event, stats, curve, notice
 *   frame    {frame, arrivedMs, ageMs, bytes}
 */
export class Link extends EventTarget {
  constructor() {
    super();
    this.commands = new LinkCommands(this);
    this.worker = new Worker(new URL('./worker.js', import.meta.url), {type: 'module'});
    this.worker.addEventListener('message', ({data}) => this.#receive(data));
    this.waiting = new Map();
    this.lastKey = 0;
    this.connected = false;
  }

  /** Connects and stays connected until `rest`. `token` null: none is shown. */
  open(server, scene, token) {
    this.worker.postMessage({kind: 'open', server, scene, token});
  }

  /** Disconnects until the next `open`: the server sends nothing, and nothing is asked of it. */
  rest() {
    this.connected = false;
    this.worker.postMessage({kind: 'rest'});
  }

  /** Does not wait any longer before the next attempt. */
  retry() {
    this.worker.postMessage({kind: 'retry'});
  }

  /**
   * Sends a command (see `commands`); the promise has the `ok` (or `pong`) message, or fails with an Error that carries `code` and `path`.
   * @param {object} message with `op`, without `id`
   * @returns {Promise<object>}
   */
  request(message) {
    const key = ++this.lastKey;
    return new Promise((resolve, reject) => {
      this.waiting.set(key, {resolve, reject});
      this.worker.postMessage({kind: 'request', key, message});
    });
  }

  #receive(data) {
    switch (data.kind) {
      case 'reply': {
        const {resolve, reject} = this.waiting.get(data.key);
        this.waiting.delete(data.key);
        if (data.error) reject(Object.assign(new Error(data.error.message), data.error));
        else resolve(data.message);
        break;
      }
      case 'state':
        this.connected = data.state === 'open';
        this.#emit('state', data);
        break;
      case 'message':
        this.#emit('message', data.message);
        break;
      case 'frame':
        this.#emit('frame', data);
        this.worker.postMessage({kind: 'taken'});
        break;
    }
  }

  #emit(type, detail) {
    this.dispatchEvent(new CustomEvent(type, {detail}));
  }
}
