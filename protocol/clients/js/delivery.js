/** Frames on their way to who wants them: the newest wins. */
import { Arrivals } from './clock.js';
import { WeftError } from './errors.js';
import { decodeFrame } from './frames.js';

/** That a newer frame is waited for: a round trip and a step, ms. */
const NEWER = 200;

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
  #arrivals = new Arrivals();
  /** Ends the wait for a newer frame early. @type {(() => void)|null} */
  #news = null;
  /** @type {Set<{accept: (frame: Frame) => boolean, resolve: (frame: Frame) => void, reject: (error: Error) => void, timer: any}>} */
  #waiters = new Set();

  /** @param {Recipient} recipient */
  constructor(recipient) {
    this.#recipient = recipient;
  }

  /** Takes a binary message, in place of one that has not been delivered yet. @param {ArrayBuffer} message */
  put(message) {
    this.#newest = message;
    this.#news?.();
    this.deliver();
  }

  /** Forgets the connection before. */
  clear() {
    this.#newest = null;
    this.#arrivals = new Arrivals();
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

  /**
   * Gives the newest frame to the listeners, then acknowledges it; what comes meanwhile waits as the newest. One that is late has
   * waited until this program read again and is old: a newer one is waited for first, for `NEWER` at most, as nothing may move.
   */
  async deliver() {
    if (this.#delivering) return;
    this.#delivering = true;
    const { ready, begin, onframe, onerror, local } = this.#recipient;
    while (ready() && this.#newest) {
      try {
        let acknowledge = begin(), frame = this.#take(local);
        const arrivals = this.#arrivals, end = performance.now() + NEWER;
        const current = () => ready() && this.#arrivals === arrivals;  // of this connection
        while (arrivals.late(frame.stamp.serverMs) && performance.now() < end) {
          acknowledge(frame);
          acknowledge = () => {};
          if (!this.#newest) await this.#newer(end - performance.now());
          if (!this.#newest || !current()) break;
          acknowledge = begin();
          frame = this.#take(local);
        }
        if (!current()) continue;
        arrivals.taken(frame.stamp.serverMs);
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

  /** @param {boolean} [local] */
  #take(local) {
    const message = /** @type {ArrayBuffer} */ (this.#newest);
    this.#newest = null;
    return decodeFrame(message, { local });
  }

  /** Waits for another frame, for `ms` at most. @param {number} ms @returns {Promise<void>} */
  #newer(ms) {
    return new Promise((resolve) => {
      const timer = setTimeout(resolve, ms);
      this.#news = () => {
        clearTimeout(timer);
        resolve();
      };
    });
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
