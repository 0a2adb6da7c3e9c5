/** Waiting times between attempts to connect: doubling, bounded, and spread so that viewers do not come back all at once. */
export class Backoff {
  /**
   * @param {object} [options]
   * @param {number} [options.first] longest wait before the first new attempt, ms
   * @param {number} [options.longest] bound of every wait, ms
   * @param {() => number} [options.random] uniform in [0, 1)
   */
  constructor({first = 500, longest = 8000, random = Math.random} = {}) {
    this.first = first;
    this.longest = longest;
    this.random = random;
    this.failures = 0;
  }

  /** Milliseconds to wait after one more failure: between half and all of first * 2^failures. */
  next() {
    const bound = Math.min(this.longest, this.first * 2 ** Math.min(this.failures, 16));
    this.failures += 1;
    return Math.round(bound * (0.5 + 0.5 * this.random()));
  }

  /** A connection stood: start from the shortest wait again. */
  reset() {
    this.failures = 0;
  }
}
