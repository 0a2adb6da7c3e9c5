const kSeconds = 10;             // of the scene's clock
const kLeastBetween = 0.9 / 30;  // s of the scene's clock: thirty frames a second, whatever their steps
const kMostBytes = 64e6;         // of positions, which are kept until the file is made: ten seconds of 129 x 129 nodes

/** Gathers the frames that a viewer wants as a model that moves. */
export class Motion {
  #frames = null;
  #bytes = 0;

  /** @param {(frames: import('../protocol/weft.js').Frame[]) => void} done called with what was gathered, however it ends */
  constructor(done) {
    this.done = done;
  }

  get gathering() {
    return this.#frames !== null;
  }

  /** Seconds of the scene gathered so far. */
  get seconds() {
    return this.gathering ? this.#frames.at(-1).stamp.time - this.#frames[0].stamp.time : 0;
  }

  /** @param {import('../protocol/weft.js').Frame} first what is shown now */
  start(first) {
    this.#frames = [];
    this.#bytes = 0;
    this.take(first);
  }

  /** Takes a frame that has come; what begins anew ends it, and so does the tenth second. */
  take(frame) {
    if (!this.gathering) return;
    const last = this.#frames.at(-1);
    if (last && frame.stamp.epoch !== last.stamp.epoch) return this.stop();
    if (last && frame.stamp.time - last.stamp.time < kLeastBetween) return;
    this.#frames.push(frame);
    this.#bytes += frame.cloths.reduce((sum, {positions}) => sum + positions.byteLength, 0);
    if (this.seconds >= kSeconds || this.#bytes > kMostBytes) this.stop();
  }

  stop() {
    const frames = this.#frames;
    this.#frames = null;
    if (frames) this.done(frames);
  }
}
