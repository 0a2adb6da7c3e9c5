// The cost panel: it asks only when it is opened, shows the curve and where the scene runs, and sets the quality.
import assert from 'node:assert/strict';
import {before, test} from 'node:test';
import {fileURLToPath} from 'node:url';
import {digits, percent, spanText} from '../../web/panels/cost_curve.js';
import {openScene, startServer, until} from './harness.mjs';

let server, page, witness;
before(async () => {
  server = await startServer([fileURLToPath(new URL('scenes/small.json', import.meta.url))]);
  ({page, witness} = await openScene(server, 'small', {deviceScaleFactor: 1}));  // the chart's colours are read
});

const text = (id) => page.textContent(`#${id}`);
const quality = () => page.evaluate(() => weft.stats.server.quality);

/** What the page shows and the stats it shows, of one moment: both are read between two messages. */
const shown = () => page.evaluate(() => ({
  quality: weft.stats.server.quality,
  figures: document.getElementById('cost-figures').textContent,
  now: document.getElementById('cost-now').textContent,
  state: document.getElementById('cost-state').textContent,
  dot: {...document.getElementById('cost-chart').dataset},
}));

function assertAgree({quality, figures, now, dot}) {
  assert.equal(figures, `Level ${quality.level}: ${digits(quality.ms_measured)} ms a step, error ${percent(quality.error_expected)} ${spanText(quality.span)}`);
  assert.equal(now, `${quality.integrator}, ${quality.setting}`);
  assert.deepEqual([Number(dot.ms), Number(dot.error)], [quality.ms_measured, quality.error_expected]);
}

test('closed, it asks for nothing', async () => {
  await until(page, () => weft.stats.server !== null);
  assert.equal(await quality(), undefined);
});

test('opened by the keyboard, it measures and then draws the curve', {timeout: 240_000}, async () => {
  await page.focus('#cost summary');
  await page.keyboard.press('Enter');
  await until(page, () => weft.stats.server.quality?.state === 'measuring');
  assert.match(await text('cost-state'), /^Measuring/);
  assert.equal(await page.isVisible('#cost-chart'), false);
  await page.waitForSelector('#cost-chart canvas', {timeout: 200_000});
  const seen = await shown();
  assert.equal(seen.state, 'Stepped in the scene’s own way.');
  assert.equal(seen.now, 'bdf2, 2 substeps, tolerance 0.05');
  assertAgree(seen);
  assert.match(await page.getAttribute('#cost-chart', 'aria-label'), /^Error against time of a step at level \d: \d+ best choices from /);
  // Something of each colour: the curve and the dot.
  const colours = await page.evaluate(() => {
    const canvas = document.querySelector('#cost-chart canvas');
    const {data} = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    const style = getComputedStyle(document.documentElement);
    const probe = document.createElement('canvas').getContext('2d');
    return ['--accent', '--warn'].map((name) => {
      probe.fillStyle = style.getPropertyValue(name);
      probe.fillRect(0, 0, 1, 1);
      const [r, g, b] = probe.getImageData(0, 0, 1, 1).data;
      let count = 0;
      for (let at = 0; at < data.length; at += 4) count += data[at] === r && data[at + 1] === g && data[at + 2] === b && data[at + 3] === 255;
      return count;
    });
  });
  assert.ok(colours.every((count) => count > 4), `${colours} pixels of curve and dot`);
});

test('the next levels are told beside the present one', async () => {
  const {level} = await quality();
  for (const [id, other] of [['cost-up', level + 1], ['cost-down', level - 1]]) {
    const line = await text(id);
    if (other < 3 || other > 4) assert.equal(line, '');
    else assert.match(line, new RegExp(`^Level ${other}: \\S+ × the time \\(\\S+ ms\\), .* instead of .*; steps .* % instead of .* %\\.$`));
  }
});

test('a time is set, kept to and told', async () => {
  await page.selectOption('#quality-kind', 'max_ms');
  await page.fill('#quality-number', '1000');
  await page.click('#quality-set');
  await until(page, () => weft.stats.server.quality.wish.max_ms === 1000 && weft.stats.server.quality.state === 'chosen');
  const seen = await shown();
  assert.equal(seen.state, seen.quality.met ? 'Within 1000 ms a step.' : 'Nothing keeps 1000 ms a step; this comes nearest.');
  assertAgree(seen);
});

test('an error is set in per cent; what cannot be met is said', async () => {
  await page.selectOption('#quality-kind', 'max_error');
  await page.fill('#quality-number', '0.0001');
  await page.press('#quality-number', 'Enter');
  await until(page, () => weft.stats.server.quality.wish.max_error === 1e-6);
  const seen = await shown();
  const wish = `an error of 0.0001 % ${spanText(seen.quality.span)}`;
  assert.equal(seen.state, seen.quality.met ? `Within ${wish}.` : `Nothing keeps ${wish}; this comes nearest.`);
  assertAgree(seen);
});

test('what another viewer set is shown in the control', async () => {
  const {page: other} = await openScene(server, 'small');
  await other.click('#cost summary');
  await other.selectOption('#quality-kind', 'max_ms');
  await other.fill('#quality-number', '40');
  await other.click('#quality-set');
  await until(page, () => document.getElementById('quality-kind').value === 'max_ms' && document.getElementById('quality-number').value === '40');
  await other.close();
});

test('the scene’s own again', async () => {
  await page.selectOption('#quality-kind', 'own');
  assert.equal(await page.isVisible('#quality-number'), false);
  await page.click('#quality-set');
  await until(page, () => weft.stats.server.quality.state === 'own');
  assertAgree(await shown());
});

test('nothing was loaded from elsewhere, and the console is clean', () => {
  const elsewhere = witness.requests.filter((url) => !['data:', 'blob:'].includes(new URL(url).protocol) && new URL(url).origin !== server.address);
  assert.deepEqual(elsewhere, []);
  assert.ok(witness.requests.some((url) => url.endsWith('/uplot/uPlot.esm.js')), 'the chart was loaded');
  assert.deepEqual(witness.errors, []);
});
