import {mix, splitTo} from './grid.js';

const kMorphMs = 250;

/**
 * Turns a cloth's frames into the mesh to draw. When the level changes, the mesh is drawn on the finer of the two grids and
 * slides from what was shown to what is sent, so that nothing pops: levels are nested, hence a coarse grid split up to the finer
 * one is the same sheet.
 */
export class Morph {
  /** @param {boolean} instant change level at once (the viewer prefers reduced motion) */
  constructor(instant = false) {
    this.instant = instant;
    this.shown = null;     // {positions, rows, cols}: what was drawn last
    this.level = null;     // rows of the frames at present
    this.residual = null;  // shown minus sent when the level changed, on the finer grid
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
   * @returns {{positions: Float32Array, rows: number, cols: number}} the mesh to draw; valid until the next call
   */
  update(before, after, share, nowMs) {
    const live = this.#live(before, after, share);
    if (this.level !== null && this.level !== live.rows && !this.instant) this.#begin(live, nowMs);
    this.level = live.rows;
    const progress = (nowMs - this.startedMs) / kMorphMs;
    if (this.residual && progress < 1) {
      const left = 1 - progress * progress * (3 - 2 * progress);
      const fine = splitTo(live, this.residual.rows);
      const positions = fine === live ? live.positions.slice() : fine.positions;
      for (let i = 0; i < positions.length; ++i) positions[i] += this.residual.positions[i] * left;
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

  #begin(live, nowMs) {
    const rows = Math.max(this.shown.rows, live.rows);
    const from = splitTo(this.shown, rows);
    const to = splitTo(live, rows);
    if (from.cols !== to.cols) return;  // another sheet altogether
    const positions = new Float32Array(to.positions.length);
    for (let i = 0; i < positions.length; ++i) positions[i] = from.positions[i] - to.positions[i];
    this.residual = {positions, rows, cols: to.cols};
    this.startedMs = nowMs;
  }
}
