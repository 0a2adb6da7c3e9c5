import {mix, splitTo} from './grid.js';

const kMorphMs = 250;           // at least
const kMostPixels = 1.5;        // a change of level moves no node farther between two pictures
const kPictureMs = 1000 / 60;   // between two pictures
const kSteepest = 1.5;          // slope of the ease, in the middle

/**
 * Turns a cloth's frames into the mesh to draw. When the level changes, the mesh is drawn on the finer of the two grids and
 * slides from what was shown to what is sent, so that nothing pops: levels are nested, hence a coarse grid split up to the finer
 * one is the same sheet. Nodes that have far to go take longer, so that what the change adds to the cloth's own motion stays
 * under kMostPixels from picture to picture.
 */
export class Morph {
  /** @param {boolean} instant change level at once (the viewer prefers reduced motion) */
  constructor(instant = false) {
    this.instant = instant;
    this.shown = null;     // {positions, rows, cols}: what was drawn last
    this.level = null;     // rows of the frames at present
    this.residual = null;  // shown minus sent when the level changed, on the finer grid, and how long each node takes, ms
    this.startedMs = 0;
  }

  get active() {
    return this.residual !== null;
  }

  /**
   * @param {{positions: Float32Array, rows: number, cols: number}} before
   * @param {{positions: Float32Array, rows: number, cols: number}} after
   * @param {number} share of `after`
   * @param {number} nowMs
   * @param {number} pixel what a pixel of the picture spans at the cloth, m
   * @returns {{positions: Float32Array, rows: number, cols: number}} the mesh to draw; valid until the next call
   */
  update(before, after, share, nowMs, pixel = Infinity) {
    const live = this.#live(before, after, share);
    if (this.level !== null && this.level !== live.rows && !this.instant) this.#begin(live, nowMs, pixel);
    this.level = live.rows;
    const elapsed = nowMs - this.startedMs;
    if (this.residual && elapsed < this.residual.longest) {
      const {positions: residual, durations, rows} = this.residual;
      const fine = splitTo(live, rows);
      const positions = fine === live ? live.positions.slice() : fine.positions;
      for (let node = 0; node < durations.length; ++node) {
        const progress = Math.min(1, elapsed / durations[node]);
        const left = 1 - progress * progress * (3 - 2 * progress);
        for (let i = 3 * node; i < 3 * node + 3; ++i) positions[i] += residual[i] * left;
      }
      this.shown = {positions, rows: fine.rows, cols: fine.cols};
    } else {
      this.residual = null;
      this.shown = live;
    }
    return this.shown;
  }

  /** The sheet as sent, at its own level. Frames of two levels are not mixed: the morph carries one over into the other. */
  #live(before, after, share) {
    if (before === after || share >= 1 || before.rows !== after.rows || before.cols !== after.cols) return after;
    if (this.mixed?.length !== after.positions.length) this.mixed = new Float32Array(after.positions.length);
    return {positions: mix(before.positions, after.positions, share, this.mixed), rows: after.rows, cols: after.cols};
  }

  #begin(live, nowMs, pixel) {
    const rows = Math.max(this.shown.rows, live.rows);
    const from = splitTo(this.shown, rows);
    const to = splitTo(live, rows);
    if (from.cols !== to.cols) return;  // another sheet altogether
    const positions = new Float32Array(to.positions.length);
    for (let i = 0; i < positions.length; ++i) positions[i] = from.positions[i] - to.positions[i];
    const durations = new Float32Array(positions.length / 3).map((_, node) => {
      const way = Math.hypot(positions[3 * node], positions[3 * node + 1], positions[3 * node + 2]);
      return Math.max(kMorphMs, (kSteepest * kPictureMs * way) / (kMostPixels * pixel));
    });
    this.residual = {positions, durations, longest: durations.reduce((a, b) => Math.max(a, b)), rows, cols: to.cols};
    this.startedMs = nowMs;
  }
}
