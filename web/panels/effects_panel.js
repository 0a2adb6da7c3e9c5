import {Tuner} from './tuning.js';
import {make} from './tuning_row.js';
import {Tunings, words} from './tunings.js';

const byId = (id) => document.getElementById(id);
/** What the effects are called here; one that is not known goes by its own name. */
const kLabels = {
  gravity: 'Gravity', damping: 'Damping', paper_wind: 'Wind', aerodynamics: 'Wind and drag',
  strain_damping: 'Inner friction', plate_bending: 'Stiffness to bending', strain_limit: 'Limit to stretch',
  cloth_contact: 'Cloth on cloth', inflation: 'Inflation', tearing: 'Tearing',
};

const labelOf = (effect) => kLabels[effect] ?? words(effect);

/** A switch for each effect of the scene, and what can be set of it. Shows what the server says. */
export class EffectsPanel {
  /**
   * @param {object} actions
   * @param {(effect: string, on: boolean) => void} actions.setEffect
   * @param {(effect: string, parameters: Object<string, number|number[]>) => void} actions.tune
   */
  constructor(actions) {
    this.live = false;
    this.parameters = {};
    /** @type {Map<string, Tunings>} of each effect that has something to set */
    this.tunings = new Map();
    this.tuner = new Tuner(actions.tune);
    byId('effects').addEventListener('change', ({target}) => {
      if (target.type === 'checkbox') actions.setEffect(target.dataset.effect, target.checked);
    });
  }

  setLive(live) {
    this.live = live;
    for (const box of this.#boxes()) box.disabled = !live;
    for (const tunings of this.tunings.values()) tunings.enable(live);
  }

  /** @param {{effects: string[], parameters?: object, tunable?: object}} scene the server's message; an older server's tells no parameters */
  begin({effects, parameters = {}, tunable = {}}) {
    this.parameters = {...parameters};
    this.tunings.clear();
    const names = [...new Set(effects)];
    byId('effects-list').replaceChildren(...names.flatMap((effect) => this.#effect(effect, tunable[effect])));
    byId('effects').hidden = names.length === 0;
    this.setLive(this.live);
  }

  /** @param {string[]} off those that are taken away now */
  setOff(off) {
    for (const box of this.#boxes()) box.checked = !off.includes(box.dataset.effect);
  }

  /** @param {string} effect @param {object} parameters all that it has now */
  setParameters(effect, parameters) {
    this.parameters[effect] = parameters;
    this.tunings.get(effect)?.show(parameters);
  }

  /** The server did not take what was set of it. */
  takeBack(effect) {
    this.tunings.get(effect)?.takeBack();
  }

  /** Its switch, and if there is something to set, a button that shows it. */
  #effect(effect, tunable) {
    const name = make('label', {className: 'row check'});
    const box = make('input', {type: 'checkbox', checked: true});
    box.dataset.effect = effect;
    name.append(box, ` ${labelOf(effect)}`);
    if (!tunable) return [name];
    const tunings = new Tunings(
      {id: `tuning-${effect}`, label: labelOf(effect), tunable: Object.entries(tunable), values: this.parameters[effect]},
      (parameter, value) => this.tuner.set(effect, parameter, value));
    this.tunings.set(effect, tunings);
    const head = make('div', {className: 'row tunable'});
    head.append(name, tunings.fold);
    return [head, tunings.body];
  }

  #boxes() {
    return byId('effects').querySelectorAll('input[type="checkbox"]');
  }
}
