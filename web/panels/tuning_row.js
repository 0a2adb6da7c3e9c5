import {sliderSpan, unitText} from './tuning.js';

const kHoldMs = 600;  // what the viewer has set is not overwritten by what the server still says

export const make = (tag, properties) => Object.assign(document.createElement(tag), properties);
const numberText = (number) => String(Number(number.toPrecision(6)));

/** One number that can be set: a slider, and a field for any value in the range. */
export class TuningRow {
  /**
   * @param {{label: string, id: string, range: number[], unit: string, reach: number[]}} number `reach`: what the slider should reach at least
   * @param {(value: number) => void} wanted
   */
  constructor({label, id, range, unit, reach}, wanted) {
    this.range = range;
    this.reach = reach;
    this.heldUntilMs = 0;
    this.shown = 0;  // by the slider, while the viewer's hand is on it not yet what the server says
    this.slider = make('input', {type: 'range', ariaLabel: `${label}, slider`});
    this.field = make('input', {type: 'number', id, min: String(range[0]), max: String(range[1])});
    this.field.title = `${range[0]} to ${range[1]} ${unitText(unit)}`.trim();
    const name = make('label', {htmlFor: id, textContent: label});
    if (unit) name.append(' ', make('small', {textContent: unitText(unit)}));
    this.element = make('div', {className: 'tuning'});
    this.element.append(name, this.field, this.slider);
    this.slider.addEventListener('input', () => this.#set(this.slider.valueAsNumber, wanted));
    this.field.addEventListener('change', () => {
      if (Number.isFinite(this.field.valueAsNumber)) this.#set(this.field.valueAsNumber, wanted);
      else this.takeBack();
    });
  }

  enable(on) {
    this.slider.disabled = this.field.disabled = !on;
  }

  /** Another thing's number is shown: what was set is not waited for. @param {number} value */
  begin(value) {
    this.value = value;
    this.takeBack();
  }

  /** What the server says; shown once the viewer's hand is off, and not in a field that is typed in. @param {number} value */
  show(value) {
    this.value = value;
    clearTimeout(this.later);
    const waitMs = this.heldUntilMs - performance.now();
    if (waitMs > 0) this.later = setTimeout(() => this.show(this.value), waitMs);
    else this.#write(value, this.field === document.activeElement ? [this.slider] : [this.slider, this.field]);
  }

  /** What was set is not taken. */
  takeBack() {
    this.heldUntilMs = 0;
    this.#write(this.value, [this.slider, this.field]);
  }

  #set(value, wanted) {
    const taken = Math.max(value, this.range[0]);  // a slider begins at 0 even where that is not allowed
    this.heldUntilMs = performance.now() + kHoldMs;
    this.#write(taken, [this.slider, this.field]);
    this.show(this.value);
    wanted(taken);
  }

  #write(value, inputs) {
    this.shown = value;
    const {min, max, step} = sliderSpan([...this.reach, value / 2], this.range);
    Object.assign(this.slider, {min: String(min), max: String(max), step: String(step)});
    this.field.step = String(step);
    for (const input of inputs) input.value = numberText(value);
  }
}
