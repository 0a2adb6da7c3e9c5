// The page that `weft cost` writes, opened as a file.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {mkdtempSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {pathToFileURL} from 'node:url';
import {BidiPage} from './bidi.mjs';
import {kFirefox} from './browsers.mjs';
import {openPage} from './harness.mjs';

const folder = mkdtempSync(join(tmpdir(), 'weft-cost-'));
const file = pathToFileURL(join(folder, 'cost.html')).href;
let page, witness;

before(async () => {
  execFileSync(process.env.WEFT_BINARY, ['cost', 'swing', '--levels', '3-4', '--duration', '0.1', '--budget', '30s',
    '--out', join(folder, 'cost.html')]);
  ({page, witness} = await openPage(file));
});
after(() => rmSync(folder, {recursive: true}));

const count = (selector) => page.locator(selector).count();

test('a panel a level, a curve an integrator', async () => {
  assert.equal(await page.title(), 'What accuracy costs: swing');
  assert.deepEqual(await page.locator('.panel h2').allTextContents(), ['Level 3', 'Level 4']);
  for (const level of [3, 4]) {
    for (const integrator of ['bdf2', 'backward_euler', 'xpbd', 'symplectic_euler']) {
      assert.equal(await count(`[data-level="${level}"] .curve[data-integrator="${integrator}"]`), 1, `${integrator} at ${level}`);
    }
    assert.equal(await count(`[data-level="${level}"] .point`), 35);
    assert.equal(await count(`[data-level="${level}"] .present`), 1);
    assert.ok(await count(`[data-level="${level}"] .point .ring`) >= 1);
  }
});

test('every point lies inside its diagram and has a tooltip', async () => {
  const outside = await page.locator('.point').evaluateAll((points) => points.filter((point) => {
    const {e: x, f: y} = point.transform.baseVal.consolidate().matrix;
    return !(x >= 62 && x <= 548 && y >= 10 && y <= 338);  // the axes' ends in report.html
  }).length);
  assert.equal(outside, 0);
  assert.match(await page.locator('.point title').first().textContent(), /^bdf2, 1 substep, tolerance 0\.1, 2 Newton \(the scene’s own choice\)\n.+ ms a frame, error /);
});

test('the caption states command, machine and reference', async () => {
  const text = await page.locator('body').innerText();
  assert.match(text, /weft cost swing --levels 3,4 /);
  assert.match(text, /on one thread of /);
  assert.match(text, /reference: BDF2 in double precision/);
});

test('another error is drawn when chosen', async () => {
  const first = () => page.locator('[data-level="3"] .curve').first().getAttribute('points');
  const before = await first();
  await page.selectOption('#measure', 'strain');
  assert.notEqual(await first(), before);
  assert.equal(await count('.panel'), 2);
  await page.selectOption('#measure', 'rms');
  assert.equal(await first(), before);
});

const kWhite = 'rgb(255, 255, 255)';
const paper = () => getComputedStyle(document.body).backgroundColor;

test('dark where the reader wants it dark', async () => {
  for (const wish of ['light', 'dark']) {
    const colour = await (kFirefox ? paperInFirefox : paperInChromium)(wish);
    if (wish === 'light') assert.equal(colour, kWhite);
    else assert.notEqual(colour, kWhite);
  }
});

async function paperInChromium(wish) {
  await page.emulateMedia({colorScheme: wish});
  return page.evaluate(paper);
}

/** By a preference of a browser of its own: WebDriver cannot set what the reader prefers. */
async function paperInFirefox(wish) {
  const reader = await BidiPage.open(file, {width: 900, height: 640}, {'layout.css.prefers-color-scheme.content-override': wish === 'dark' ? 0 : 1});
  try {
    return await reader.evaluate(paper);
  } finally {
    await reader.close();
  }
}

test('it loads nothing but itself and complains of nothing', () => {
  // Of the file itself Firefox tells nothing.
  assert.deepEqual(witness.requests.filter((url) => !url.startsWith('data:') && url !== file), []);
  assert.deepEqual(witness.errors, []);
});
