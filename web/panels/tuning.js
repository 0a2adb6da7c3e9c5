/** Least time between two messages of a Tuner, ms. */
export const kTuneMs = 100;

/** 1, 2 or 5 times a power of ten, at least `number`. */
function roundUp(number) {
  const power = 10 ** Math.floor(Math.log10(number));
  return [1, 2, 5, 10].map((digit) => Number((digit * power).toPrecision(1))).find((round) => round >= number * (1 - 1e-9));
}

/**
 * The stretch of a parameter's range that a slider has: twice as far as the values it should reach, 1 where they are all 0.
 * @param {number[]} values what it should reach @param {number[]} range least and greatest that the server takes
 * @returns {{min: number, max: number, step: number}}
 */
export function sliderSpan(values, [low, high]) {
  const reach = roundUp(2 * Math.max(...values.map(Math.abs)) || 1);
  return {min: low < 0 ? Math.max(low, -reach) : 0, max: Math.min(high, reach), step: Number((reach / 100).toPrecision(1))};
}

/** `m/s2` as people write it. */
export const unitText = (unit) => unit.replace(/(?<=[a-z])2\b/g, '²').replace(/(?<=[a-z])3\b/g, '³');

/** Sends what the numbers of effects, cloths and the like were set to last: the first at once, then the newest, of one thing a message, at most one in kTuneMs. */
export class Tuner {
  #waiting = new Map();  // of each thing
  #timer = null;

  /** @param {(thing: string|number, parameters: object) => void} send */
  constructor(send) {
    this.send = send;
  }

  /** @param {string|number} thing @param {string} name @param {number|number[]} value */
  set(thing, name, value) {
    this.#waiting.set(thing, {...this.#waiting.get(thing), [name]: value});
    if (this.#timer === null) this.#sendNext();
  }

  #sendNext() {
    this.#timer = null;
    for (const [thing, parameters] of this.#waiting) {
      this.#waiting.delete(thing);
      this.send(thing, parameters);
      this.#timer = setTimeout(() => this.#sendNext(), kTuneMs);
      return;
    }
  }
}
