/** Frames on their way to who wants them: the newest wins. */
import { WeftError } from './errors.js';
import { decodeFrame } from './frames.js';

/**
 * @typedef {import('./types.js').Frame} Frame
 * @typedef {object} Recipient
 * @property {() => boolean} ready whether frames may be delivered now
 * @property {() => (frame: Frame) => void} begin gives what acknowledges the frame that is about to be delivered
 * @property {(frame: Frame) => void | Promise<void>} [onframe]
 * @property {(error: Error) => void} [onerror] malformed frames, and what `onframe` throws
 * @property {boolean} [local] as decodeFrame's
 */

export class Delivery {
  /** The newest that was delivered. @type {Frame|null} */
  frame = null;

  #recipient;
  /** @type {ArrayBuffer|null} */
  #newest = null;
  #delivering = false;
  /** @type {Set<{accept: (frame: Frame) => boolean, resolve: (frame: Frame) => void, reject: (error: Error) => void, timer: any}>} */
  #waiters = new Set();

  /** @param {Recipient} recipient */
  constructor(recipient) {
    this.#recipient = recipient;
  }

  /** Takes a binary message, in place of one that has not been delivered yet. @param {ArrayBuffer} message */
  put(message) {
    this.#newest = message;
    this.deliver();
  }

  /** Forgets what has not been delivered yet. */
  clear() {
    this.#newest = null;
  }

  /** The next frame for which `accept` is true. @param {(frame: Frame) => boolean} accept @param {number} timeout ms @returns {Promise<Frame>} */
  next(accept, timeout) {
    return new Promise((resolve, reject) => {
      const waiter = { accept, resolve, reject, timer: setTimeout(() => {
        this.#waiters.delete(waiter);
        reject(new WeftError('timeout', `no such frame within ${timeout} ms`));
      }, timeout) };
      this.#waiters.add(waiter);
    });
  }

  /** No further frame will come. @param {Error} error */
  fail(error) {
    for (const { reject, timer } of this.#waiters) {
      clearTimeout(timer);
      reject(error);
    }
    this.#waiters.clear();
  }

  /** Gives the newest frame to the listeners, then acknowledges it; what comes meanwhile waits as the newest. */
  async deliver() {
    if (this.#delivering) return;
    this.#delivering = true;
    const { ready, begin, onframe, onerror, local } = this.#recipient;
    while (ready() && this.#newest) {
      const acknowledge = begin(), message = this.#newest;
      this.#newest = null;
      try {
        const frame = decodeFrame(message, { local });
        this.frame = frame;
        this.#tellWaiters(frame);
        try {
          await onframe?.(frame);
        } finally {
          acknowledge(frame);
        }
      } catch (error) {
        onerror?.(/** @type {Error} */ (error));
      }
    }
    this.#delivering = false;
  }

  /** @param {Frame} frame */
  #tellWaiters(frame) {
    for (const waiter of [...this.#waiters]) {
      if (!waiter.accept(frame)) continue;
      this.#waiters.delete(waiter);
      clearTimeout(waiter.timer);
      waiter.resolve(frame);
    }
  }
}
