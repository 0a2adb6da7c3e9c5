import {Tuner} from './tuning.js';
import {TuningRow} from './tuning_row.js';

const kRange = [0, 10];  // as the protocol has it
const kReach = 0.5;      // the slider goes to 1, and farther where the friction is beyond

/** How much the chosen ball or obstacle holds cloth that slides on it. Shows what the server says, and nothing where it says nothing. */
export class FrictionRow {
  /** @param {HTMLElement} place where the row is put @param {(chosen: number, friction: number) => void} set */
  constructor(place, set) {
    /** By ball or obstacle. @type {Map<number, number|undefined>} */
    this.frictions = new Map();
    this.chosen = null;
    const tuner = new Tuner((chosen, {friction}) => set(chosen, friction));
    this.row = new TuningRow({label: 'Friction', id: `${place.id}-number`, range: kRange, unit: '', reach: [kReach]},
      (friction) => tuner.set(this.chosen, 'friction', friction));
    place.append(this.row.element);
    this.#show();
  }

  enable(on) {
    this.row.enable(on);
  }

  /** @param {number|null} chosen */
  choose(chosen) {
    if (chosen === this.chosen) return;
    this.chosen = chosen;
    this.row.begin(this.frictions.get(chosen) ?? 0);
    this.#show();
  }

  /** What the server says. @param {[number, number|undefined][]} frictions of all balls or obstacles; an older server tells none */
  set(frictions) {
    this.frictions = new Map(frictions.filter(([, friction]) => friction !== undefined));
    this.#show();
  }

  /** Whether one that is here would have another. @param {[number, number|undefined][]} frictions */
  differs(frictions) {
    return frictions.some(([each, friction]) => this.frictions.has(each) && this.frictions.get(each) !== friction);
  }

  /** The server did not take what was set. */
  takeBack(chosen) {
    if (chosen === this.chosen) this.row.takeBack();
  }

  #show() {
    const friction = this.frictions.get(this.chosen);
    this.row.element.hidden = friction === undefined;
    if (friction !== undefined) this.row.show(friction);
  }
}
