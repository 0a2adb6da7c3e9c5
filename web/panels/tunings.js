import {make, TuningRow} from './tuning_row.js';

/** Of parameters that are arrays, by their length. */
const kComponents = {2: [' along u', ' along v'], 3: [' x', ' y', ' z']};

/** A name of the protocol as a label. */
export const words = (name) => (name[0].toUpperCase() + name.slice(1)).replaceAll('_', ' ');
const listed = (value) => [value].flat();
const usualLabel = (name, i, count) => words(name) + (kComponents[count]?.[i] ?? '');

/** What can be set of one thing: a row for each number, and a button that unfolds them. Shows what the server says. */
export class Tunings {
  /**
   * @param {object} of
   * @param {string} of.id
   * @param {string} of.label what the thing is called
   * @param {[string, {range: number[], unit: string}][]} of.tunable by parameter, in the order of the rows
   * @param {Object<string, number|number[]>} of.values
   * @param {(name: string, i: number, count: number) => string} [of.labelOf] of a parameter's number i of `count`
   * @param {(name: string, value: number|number[]) => void} wanted
   */
  constructor({id, label, tunable, values, labelOf = usualLabel}, wanted) {
    this.fold = make('button', {type: 'button', className: 'quiet', textContent: 'Adjust', ariaLabel: `Adjust ${label}`});
    this.fold.setAttribute('aria-controls', id);
    this.fold.addEventListener('click', () => this.unfold(this.body.hidden));
    this.body = make('div', {id, className: 'tunings', role: 'group', ariaLabel: label});
    this.rows = Object.fromEntries(tunable.map(([name, {range, unit}]) => {
      const numbers = listed(values[name]);
      const rows = numbers.map((number, i) => {
        const row = new TuningRow({label: labelOf(name, i, numbers.length), id: `${id}-${name}-${i}`, range, unit, reach: numbers}, (value) => {
          wanted(name, rows.length === 1 ? value : rows.map((each) => each.shown));
        });
        row.show(number);
        return row;
      });
      this.body.append(...rows.map((row) => row.element));
      return [name, rows];
    }));
    this.unfold(false);
  }

  unfold(open) {
    this.body.hidden = !open;
    this.fold.ariaExpanded = String(open);
  }

  enable(on) {
    for (const row of Object.values(this.rows).flat()) row.enable(on);
  }

  /** @param {Object<string, number|number[]>} values all that the thing has now */
  show(values) {
    for (const [name, value] of Object.entries(values)) listed(value).forEach((number, i) => this.rows[name]?.[i].show(number));
  }

  /** The server did not take what was set. */
  takeBack() {
    for (const row of Object.values(this.rows).flat()) row.takeBack();
  }
}
