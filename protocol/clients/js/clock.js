/** The server's clock, as far as pings tell (PROTOCOL.md: `pong.server_ms`). */

const WRAP = 2 ** 32;  // ms

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
    const age = (performance.now() + this.#offset - serverMs) % WRAP;
    return age - WRAP * Math.round(age / WRAP);
  }
}
