const kKept = 90;  // frames: one and a half seconds, by which scenes that were begun together may lie apart

/** The last frames of one scene, to be compared with another's at the same time of theirs. */
export class History {
  constructor() {
    this.frames = [];
  }

  /** @param {{stamp: {time: number, epoch: number}, cloths: object[]}} frame */
  add(frame) {
    // A reset begins anew.
    if (this.frames.at(-1)?.stamp.epoch !== frame.stamp.epoch) this.frames = [];
    this.frames.push(frame);
    if (this.frames.length > kKept) this.frames.shift();
  }

  /** The newest two frames, of this and another scene, of the same time; null if there are none. */
  newestWith(other, tolerance) {
    for (let i = this.frames.length - 1, j = other.frames.length - 1; i >= 0 && j >= 0;) {
      const ahead = this.frames[i].stamp.time - other.frames[j].stamp.time;
      if (Math.abs(ahead) < tolerance) return [this.frames[i], other.frames[j]];
      if (ahead > 0) --i;
      else --j;
    }
    return null;
  }
}
