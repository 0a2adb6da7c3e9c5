/**
 * The jitter buffer. Frames are shown about one frame late on the server's clock, so that an uneven network still gives an even
 * movement: at any moment there is one frame before and one after to mix.
 */

const kMostFrames = 6;       // bound; two are needed, the rest is slack for bursts
const kDriftMs = 0.02;       // a frame; lets the estimate follow clocks that run apart
const kLongestIntervalMs = 100;  // a longer gap is a pause, not a rate
const kMarginMs = 3;

/** Difference of two readings of a 32-bit millisecond clock, across its wrap. */
const since = (later, earlier) => (later - earlier) | 0;

export class Timeline {
  constructor() {
    this.clear();
  }

  /** Forgets everything: a new connection or scene has another clock. */
  clear() {
    /** @type {{frame: object, at: number}[]} frames in order, `at` = server ms since the first */
    this.entries = [];
    this.start = null;      // server's clock at the first frame
    this.offset = Infinity; // smallest (arrival - server) seen: the fastest path
    this.intervalMs = 1000 / 60;
  }

  /**
   * @param {object} frame a decoded message
   * @param {number} arrivedMs local clock when it came
   */
  push(frame, arrivedMs) {
    this.start ??= frame.stamp.serverMs;
    const at = since(frame.stamp.serverMs, this.start);
    const last = this.entries.at(-1);
    if (last && last.frame.stamp.epoch !== frame.stamp.epoch) this.entries = [];
    else if (last && at > last.at && at - last.at <= kLongestIntervalMs) {
      this.intervalMs += 0.1 * (at - last.at - this.intervalMs);
    }
    this.entries.push({frame, at});
    if (this.entries.length > kMostFrames) this.entries.shift();
    this.offset = Math.min(this.offset + kDriftMs, arrivedMs - at);
  }

  /** How late frames are shown after the fastest of them could have arrived, ms. */
  get delayMs() {
    return this.intervalMs + kMarginMs;
  }

  /**
   * What to show at `nowMs` (same clock as `arrivedMs`): mix `before` and `after` by `share`. Null before the first frame.
   * Never extrapolates: beyond the newest frame it is the newest.
   * @returns {{before: object, after: object, share: number, behindMs: number, settled: boolean}|null} behindMs: how
   *   much older this is than the newest frame, by the server's clock; settled: nothing newer to move to
   */
  sample(nowMs) {
    if (this.entries.length === 0) return null;
    const target = nowMs - this.offset - this.delayMs;
    while (this.entries.length > 2 && this.entries[1].at <= target) this.entries.shift();
    const [before, after = before] = this.entries;
    const span = after.at - before.at;
    const share = span > 0 ? Math.min(1, Math.max(0, (target - before.at) / span)) : 1;
    return {
      before: before.frame,
      after: after.frame,
      share,
      behindMs: this.entries.at(-1).at - (before.at + share * span),
      settled: share === 1 && this.entries.length <= 2,
    };
  }

  /** The newest frame, shown or not. */
  get newest() {
    return this.entries.at(-1)?.frame ?? null;
  }
}
