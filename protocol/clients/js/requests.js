/** Requests that wait for their answers (PROTOCOL.md section 2). */
import { WeftError } from './errors.js';
import { messageText } from './messages.js';

const LAST_ID = 2147483647;

export class Requests {
  #nextId = 1;
  #timeout;
  /** @type {Map<number, {resolve: (answer: any) => void, reject: (error: Error) => void, timer: any}>} */
  #waiting = new Map();

  /** @param {number} timeout ms that an answer may take */
  constructor(timeout) {
    this.#timeout = timeout;
  }

  /**
   * Sends a request by `transmit`; gives its answer, or rejects with the server's `error`.
   * @param {string} op @param {Record<string, any>} members @param {(text: string) => void} transmit @returns {Promise<any>}
   */
  make(op, members, transmit) {
    const id = this.#nextId;
    this.#nextId = id === LAST_ID ? 1 : id + 1;
    return new Promise((resolve, reject) => {
      transmit(messageText(op, members, id));
      const timer = setTimeout(() => {
        this.#waiting.delete(id);
        reject(new WeftError('timeout', `no answer to ${op} within ${this.#timeout} ms`));
      }, this.#timeout);
      this.#waiting.set(id, { resolve, reject, timer });
    });
  }

  /** Gives a message to the request that it answers. @param {any} message @returns {boolean} whether there is one */
  settle(message) {
    const request = this.#waiting.get(message.re);
    if (!request) return false;
    this.#waiting.delete(message.re);
    clearTimeout(request.timer);
    if (message.op === 'error') request.reject(new WeftError(message.code, message.message, message.path));
    else request.resolve(message);
    return true;
  }

  /** None will be answered. @param {Error} error */
  fail(error) {
    for (const { reject, timer } of this.#waiting.values()) {
      clearTimeout(timer);
      reject(error);
    }
    this.#waiting.clear();
  }
}
