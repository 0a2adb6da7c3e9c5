const kWindowMs = 100;
/** A hand that rests this long before letting go does not throw. */
const kRestMs = 100;

/** Watches where a dragged thing has been, to tell how fast it moves when it is let go. */
export class ThrowSpeed {
  constructor() {
    this.places = [];
  }

  /** @param {number[]} position m @param {number} atMs */
  add(position, atMs) {
    this.places.push({position, atMs});
    while (this.places.length > 2 && atMs - this.places[0].atMs > kWindowMs) this.places.shift();
  }

  /**
   * Mean velocity over the last tenth of a second, m/s.
   * @param {number} nowMs when it is let go
   * @param {number} most bound of the speed, m/s
   */
  velocity(nowMs, most) {
    const first = this.places.at(0);
    const last = this.places.at(-1);
    if (!first || nowMs - last.atMs > kRestMs) return [0, 0, 0];
    const seconds = (last.atMs - first.atMs) / 1000;
    if (seconds <= 0) return [0, 0, 0];
    const velocity = last.position.map((value, axis) => (value - first.position[axis]) / seconds);
    const speed = Math.hypot(...velocity);
    return speed > most ? velocity.map((value) => (value * most) / speed) : velocity;
  }
}
