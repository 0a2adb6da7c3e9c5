import {Tuner} from './tuning.js';
import {TuningRow} from './tuning_row.js';

const byId = (id) => document.getElementById(id);
/** What the effects are called here; one that is not known goes by its own name. */
const kLabels = {
  gravity: 'Gravity', damping: 'Damping', paper_wind: 'Wind', aerodynamics: 'Wind and drag',
  strain_damping: 'Inner friction', plate_bending: 'Stiffness to bending', strain_limit: 'Limit to stretch',
  cloth_contact: 'Cloth on cloth', inflation: 'Inflation', tearing: 'Tearing',
};
/** Of parameters that are arrays, by their length. */
const kComponents = {2: ['along u', 'along v'], 3: ['x', 'y', 'z']};

const words = (name) => (name[0].toUpperCase() + name.slice(1)).replaceAll('_', ' ');
const label = (effect) => kLabels[effect] ?? words(effect);
const make = (tag, properties) => Object.assign(document.createElement(tag), properties);
const listed = (value) => [value].flat();

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
    this.rows = new Map();  // of each effect, by parameter, one a number
    this.tuner = new Tuner(actions.tune);
    byId('effects').addEventListener('change', ({target}) => {
      if (target.type === 'checkbox') actions.setEffect(target.dataset.effect, target.checked);
    });
  }

  setLive(live) {
    this.live = live;
    for (const box of this.#boxes()) box.disabled = !live;
    for (const rows of this.#rows()) rows.forEach((row) => row.enable(live));
  }

  /** @param {{effects: string[], parameters?: object, tunable?: object}} scene the server's message; an older server's tells no parameters */
  begin({effects, parameters = {}, tunable = {}}) {
    this.parameters = {...parameters};
    this.rows.clear();
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
    for (const [name, value] of Object.entries(parameters)) {
      listed(value).forEach((number, i) => this.rows.get(effect)?.[name]?.[i].show(number));
    }
  }

  /** The server did not take what was set of it. */
  takeBack(effect) {
    for (const row of Object.values(this.rows.get(effect) ?? {}).flat()) row.takeBack();
  }

  /** Its switch, and if there is something to set, a button that shows it. */
  #effect(effect, tunable) {
    const name = make('label', {className: 'row check'});
    const box = make('input', {type: 'checkbox', checked: true});
    box.dataset.effect = effect;
    name.append(box, ` ${label(effect)}`);
    if (!tunable) return [name];
    const id = `tuning-${effect}`;
    const fold = make('button', {type: 'button', className: 'quiet', textContent: 'Adjust', ariaLabel: `Adjust ${label(effect)}`, ariaExpanded: 'false'});
    fold.setAttribute('aria-controls', id);
    const body = make('div', {id, className: 'tunings', role: 'group', ariaLabel: label(effect), hidden: true});
    fold.addEventListener('click', () => {
      body.hidden = !body.hidden;
      fold.ariaExpanded = String(!body.hidden);
    });
    const head = make('div', {className: 'row tunable'});
    head.append(name, fold);
    this.rows.set(effect, {});
    for (const [parameter, {range, unit}] of Object.entries(tunable)) body.append(...this.#parameter(effect, parameter, range, unit));
    return [head, body];
  }

  #parameter(effect, parameter, range, unit) {
    const numbers = listed(this.parameters[effect][parameter]);
    const rows = numbers.map((number, i) => {
      const component = kComponents[numbers.length]?.[i];
      const row = new TuningRow({
        label: words(parameter) + (component ? ` ${component}` : ''), id: `tuning-${effect}-${parameter}-${i}`, range, unit, reach: numbers,
      }, (wanted) => {
        const all = rows.map((each) => each.shown);
        this.tuner.set(effect, parameter, all.length === 1 ? wanted : all);
      });
      row.show(number);
      return row;
    });
    this.rows.get(effect)[parameter] = rows;
    return rows.map((row) => row.element);
  }

  #boxes() {
    return byId('effects').querySelectorAll('input[type="checkbox"]');
  }

  #rows() {
    return [...this.rows.values()].flatMap((parameters) => Object.values(parameters));
  }
}
