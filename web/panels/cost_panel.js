import {chartColumns, chartText, digits, levelOf, neighbourText, percent, spanText} from './cost_curve.js';

const byId = (id) => document.getElementById(id);
const kHeight = 170;  // of the chart, CSS pixels
const kStates = {
  measuring: 'Measuring this scene beside its steps. It takes a minute or more.',
  unavailable: 'What this scene costs could not be measured.',
};
/** Of the quality's number, by what is wished: from, to, and what one of the server's units is here. */
const kWishes = {
  max_error: {unit: '%', min: 0.0001, max: 100, scale: 100, start: 1},
  max_ms: {unit: 'ms', min: 0.01, max: 1000, scale: 1, start: 2},
};

/** Writes only what differs: a reader's place and selection stay. */
function write(id, text) {
  const element = byId(id);
  if (element.textContent !== text) element.textContent = text;
  element.hidden = text === '';
}

/**
 * The panel "Cost": the scene's work-precision curve at the level it is simulated at, a dot where it runs now, what the next levels
 * would cost and gain, and a control for the quality. Asks for nothing before it is opened.
 *
 * @typedef {object} CostActions
 * @property {() => void} askCost
 * @property {(wish: {max_error?: number, max_ms?: number}) => void} setQuality
 */
export class CostPanel {
  /** @param {CostActions} actions */
  constructor(actions) {
    this.actions = actions;
    this.asked = false;
    this.curve = null;
    this.quality = null;
    this.chart = null;  // once the library is here
    this.chartLevel = null;
    this.wishShown = null;
    byId('cost').addEventListener('toggle', () => this.#opened());
    byId('quality-kind').addEventListener('change', () => this.#showNumber());
    byId('quality').addEventListener('submit', (event) => {
      event.preventDefault();
      this.#submit();
    });
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.#redraw());
    this.#showNumber();
  }

  setLive(live) {
    for (const control of byId('quality').querySelectorAll('select, input, button')) control.disabled = !live;
    if (live) this.#showNumber();
  }

  /** Another scene, or the same one after a lost connection: what was known is of the past. */
  begin() {
    this.asked = false;
    this.curve = this.quality = null;
    this.#forgetChart();
    this.#opened();
  }

  /** The `curve` message. */
  setCurve(curve) {
    this.curve = curve;
    this.#show();
  }

  /** @param {import('./cost_curve.js').Quality|undefined} quality of the newest `stats` */
  setQuality(quality) {
    this.quality = quality ?? null;
    const wish = JSON.stringify(quality?.wish ?? {});
    if (wish !== this.wishShown) this.#showWish(quality?.wish ?? {});
    this.wishShown = wish;
    this.#show();
  }

  get #open() {
    return byId('cost').open;
  }

  #opened() {
    if (!this.#open) return;
    if (!this.asked) this.actions.askCost();
    this.asked = true;
    this.#show();
  }

  #show() {
    if (!this.#open) return;
    const {curve, quality} = this;
    const known = curve && quality?.ms_measured > 0;
    write('cost-state', this.#stateText());
    write('cost-now', known ? `${quality.integrator}, ${quality.setting}` : '');
    write('cost-figures', known ? `Level ${quality.level}: ${digits(quality.ms_measured)} ms a step, error ${percent(quality.error_expected)} ${spanText(quality.span)}` : '');
    write('cost-up', (known && neighbourText(curve, quality, 1)) || '');
    write('cost-down', (known && neighbourText(curve, quality, -1)) || '');
    const level = known && levelOf(curve, quality.level);
    byId('cost-chart').hidden = !level;
    if (level) this.#draw(level);
  }

  #stateText() {
    const {quality, curve} = this;
    if (curve?.why) return `${kStates.unavailable} (${curve.why})`;
    if (!quality || !curve) return kStates.measuring;
    if (quality.state === 'own') return 'Stepped in the scene’s own way.';
    if (quality.state !== 'chosen') return kStates[quality.state];
    const {max_error: error, max_ms: ms} = quality.wish;
    const wish = error !== undefined ? `an error of ${percent(error)} ${spanText(quality.span)}` : `${digits(ms)} ms a step`;
    return quality.met ? `Within ${wish}.` : `Nothing keeps ${wish}; this comes nearest.`;
  }

  #draw(level) {
    const figure = byId('cost-chart');
    const columns = chartColumns(level, this.quality);
    figure.setAttribute('aria-label', chartText(level, this.quality));
    // What is drawn, for tests: a canvas does not tell.
    figure.dataset.ms = this.quality.ms_measured;
    figure.dataset.error = this.quality.error_expected;
    if (this.chart && this.chartLevel === level) this.chart.setData(columns);
    else this.#makeChart(level, columns);
  }

  async #makeChart(level, columns) {
    this.chartLevel = level;
    const {default: Chart} = await import('../uplot/uPlot.esm.js');
    if (this.chartLevel !== level) return;  // another one was wanted meanwhile
    this.chart?.destroy();
    this.chart = new Chart(chartOptions(byId('cost-chart').clientWidth), columns, byId('cost-chart'));
  }

  #forgetChart() {
    this.chart?.destroy();
    this.chart = this.chartLevel = null;
  }

  #redraw() {
    this.#forgetChart();
    this.#show();
  }

  // --- The control ---

  #showWish(wish) {
    const [[kind, value] = ['own']] = Object.entries(wish);
    byId('quality-kind').value = kind;
    this.#showNumber(value);
  }

  /** @param {number} [value] of the server; else where the number's range starts to be of use */
  #showNumber(value) {
    const wish = kWishes[byId('quality-kind').value];
    const input = byId('quality-number');
    byId('quality-value').hidden = input.disabled = !wish;
    if (!wish) return;
    byId('quality-unit').textContent = wish.unit;
    Object.assign(input, {min: wish.min, max: wish.max});
    if (value !== undefined) input.value = String(Number((wish.scale * value).toPrecision(6)));
    else if (!input.value || !input.checkValidity()) input.value = String(wish.start);
  }

  #submit() {
    const kind = byId('quality-kind').value;
    const wish = kWishes[kind];
    this.actions.setQuality(wish ? {[kind]: byId('quality-number').valueAsNumber / wish.scale} : {});
  }
}

/** The powers of ten of an axis: finer lines would hide the points. */
function decades(chart, axis, low, high) {
  const first = Math.ceil(Math.log10(low) - 1e-9), last = Math.floor(Math.log10(high) + 1e-9);
  return Array.from({length: Math.max(0, last - first + 1)}, (_, i) => 10 ** (first + i));
}

/** Log-log; colours as the page has them now. */
function chartOptions(width) {
  const style = getComputedStyle(document.documentElement);
  const colour = (name) => style.getPropertyValue(`--${name}`).trim();
  const font = '11px system-ui, sans-serif';
  const axis = (label, values) => ({
    label, values, splits: decades, font, labelFont: font, labelSize: 16, stroke: colour('soft'),
    grid: {stroke: colour('edge'), width: 1}, ticks: {stroke: colour('edge'), width: 1, size: 4},
  });
  const dots = (name, size, more) => ({stroke: colour(name), spanGaps: true, points: {show: true, size, fill: colour(name)}, ...more});
  const write = (text) => (chart, values) => values.map(text);
  return {
    width, height: kHeight,
    padding: [8, 8, 0, 0],
    legend: {show: false},
    cursor: {show: false},
    scales: {x: {time: false, distr: 3}, y: {distr: 3}},
    axes: [
      {...axis('ms a step', write(digits)), size: 24},
      {...axis('error, %', write((value) => digits(100 * value))), size: 44},
    ],
    series: [{}, dots('accent', 6, {width: 2}), dots('soft', 3, {width: 0, paths: () => null}), dots('warn', 11, {width: 0, paths: () => null})],
  };
}
