/** The server's clock, as far as pings tell (PROTOCOL.md: `pong.server_ms`). */

const WRAP = 2 ** 32;  // ms
/** A frame that is by so much later than the one before has waited until this side read again, ms. Of one that takes them seldom: by twice its pace. */
const LATE = 100;

/** Of clocks that wrap: the difference `ms` as it is meant. @param {number} ms */
function unwrapped(ms) {
  return ms - WRAP * Math.round(ms / WRAP);
}

export class ServerClock {
  #quickest = Infinity;
  #offset = NaN;  // to this side's clock, ms

  /** A ping began at `start`, and its answer came at `end`. @param {number} start @param {number} end @param {number} [serverMs] in the answer */
  note(start, end, serverMs) {
    if (end - start >= this.#quickest || serverMs === undefined) return;
    this.#quickest = end - start;
    this.#offset = serverMs - (start + end) / 2;
  }

  /** How long ago it was `serverMs`, ms; NaN before the first ping. @param {number} serverMs */
  age(serverMs) {
    return unwrapped(performance.now() + this.#offset - serverMs);
  }
}

/** Tells frames that have waited because this side stood still from those whose way is long, or which it takes seldom. */
export class Arrivals {
  #usual = NaN;  // from its sending to its being taken, the last one's, ms, both clocks' difference included
  #last = NaN;   // when it was taken
  #pace = 0;     // ms from the one before to it

  /** Whether a frame sent at `serverMs` is taken later than the one before it was, by more than `LATE`. @param {number} serverMs */
  late(serverMs) {
    return unwrapped(performance.now() - serverMs - this.#usual) > Math.max(LATE, 2 * this.#pace);
  }

  /** @param {number} serverMs */
  taken(serverMs) {
    const now = performance.now();
    if (this.#last <= now) this.#pace = now - this.#last;
    this.#last = now;
    this.#usual = now - serverMs;
  }
}
