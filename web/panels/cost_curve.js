/**
 * What the server's `curve` and `stats.quality` mean for the cost panel. No page in here: tested in Node.
 *
 * @typedef {{integrator: string, setting: string, ms: number, error: number, span: number, best: boolean, own: boolean}} Point
 * @typedef {{level: number, space: number, floor: number, points: Point[]}} Level points from cheap to dear
 * @typedef {{wish: {max_error?: number, max_ms?: number}, state: string, integrator?: string, setting?: string, level?: number,
 *   ms_expected?: number, ms_measured?: number, error_expected?: number, span?: number, met?: boolean}} Quality `span`: s of the scene, from its start
 */

/** "0.42 %" of a share: two digits that matter. */
export function percent(share) {
  return `${digits(100 * share)} %`;
}

/** Two digits that matter, without exponent for what people meet. */
export function digits(value) {
  const rounded = Number(value.toPrecision(2));
  return rounded !== 0 && Math.abs(rounded) < 1e-4 ? rounded.toExponential() : String(rounded);
}

/** Over which an error was measured. */
export const spanText = (span) => `over the scene’s first ${digits(span)} s`;

/** @param {{levels: Level[]}} curve @returns {Level|undefined} */
export const levelOf = (curve, level) => curve.levels.find((each) => each.level === level);

/**
 * The way that a level would be stepped for a wish, where everything takes `slowness` times what the curve says.
 * The server's own choice (server/study/quality.cpp), foreseen for levels that it does not simulate now.
 * @param {Level} level @param {Quality['wish']} wish @returns {Point|undefined}
 */
export function choiceFor(level, wish, slowness = 1) {
  const best = level.points.filter((point) => point.best);
  if (wish.max_error !== undefined) return best.find(({error}) => error <= wish.max_error) ?? best.at(-1);
  if (wish.max_ms !== undefined) return best.findLast(({ms}) => slowness * ms <= wish.max_ms) ?? best[0];
  return level.points.find((point) => point.own);
}

/**
 * What the next level up (`by` 1) or down (-1) would cost and gain, in words; null where there is none.
 * @param {{levels: Level[]}} curve @param {Quality} quality
 */
export function neighbourText(curve, quality, by) {
  const here = levelOf(curve, quality.level), there = levelOf(curve, quality.level + by);
  if (!here || !there) return null;
  const slowness = quality.ms_measured / quality.ms_expected;
  const choice = choiceFor(there, quality.wish, slowness);
  if (!choice) return null;
  const grid = there.space > 0 ? `grid error ${percent(there.space)}` : 'the finest grid known';
  const instead = here.space > 0 ? percent(here.space) : 'the finest';
  return `Level ${there.level}: ${digits(choice.ms / quality.ms_expected)} × the time (${digits(slowness * choice.ms)} ms), ` +
    `${grid} instead of ${instead}; steps ${percent(choice.error)} instead of ${percent(quality.error_expected)}.`;
}

/**
 * Columns for the chart: times ascending, then the best choices, the others, and where the scene runs now; null where a column
 * has nothing. Errors of zero cannot be drawn on a logarithmic axis and are left out.
 * @param {Level} level @param {Quality} quality
 */
export function chartColumns(level, quality) {
  const rows = level.points.filter(({ms, error}) => ms > 0 && error > 0)
    .map(({ms, error, best}) => best ? [ms, error, null, null] : [ms, null, error, null]);
  if (quality.ms_measured > 0 && quality.error_expected > 0) rows.push([quality.ms_measured, null, null, quality.error_expected]);
  rows.sort((a, b) => a[0] - b[0]);
  return [0, 1, 2, 3].map((column) => rows.map((row) => row[column]));
}

/** The chart in words. */
export function chartText(level, quality) {
  const best = level.points.filter((point) => point.best);
  const point = (ms, error) => `${digits(ms)} ms, error ${percent(error)}`;
  return `Error against time of a step at level ${level.level}: ${best.length} best choices from ${point(best[0].ms, best[0].error)} ` +
    `to ${point(best.at(-1).ms, best.at(-1).error)}. ` +
    `Now ${point(quality.ms_measured, quality.error_expected)}.`;
}
