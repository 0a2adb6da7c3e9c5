// Gallery and scene as axe-core judges them, light and dark, in a window and on a phone: nothing that keeps somebody out.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {before, test} from 'node:test';
import {fileURLToPath} from 'node:url';
import {kFirefox} from './browsers.mjs';
import {openPage, openScene, startServer, until} from './harness.mjs';

const kAxe = readFileSync(fileURLToPath(import.meta.resolve('axe-core/axe.min.js')), 'utf8');
const kGrave = ['serious', 'critical'];

let server;
before(async () => (server = await startServer(['flag', 'zheng2020-ball', 'fan', 'round-table'], {options: ['--split', '5,4']})));

/** What axe-core finds on a page as it is now, in words. */
async function findings(page, where = {}, options = {}) {
  await page.evaluate(kAxe);  // by the debugger: the page's own policy allows no script but the server's
  const {violations} = await page.evaluate(([part, how]) => axe.run(part, how), [where, options]);
  return violations.map(({id, impact, help, nodes}) =>
    ({impact, text: `${impact} ${id}: ${help}\n${nodes.map(({html, failureSummary}) => `    ${html}\n    ${failureSummary}`).join('\n')}`}));
}
function isNone(found, what) {
  const grave = found.filter(({impact}) => kGrave.includes(impact));
  assert.equal(grave.length, 0, `${what}:\n${grave.map(({text}) => text).join('\n')}`);
}
const isSound = async (page, what) => isNone(await findings(page, {include: ['html']}), what);

/** Whether the panels can be read before the worst that can be behind them: axe-core cannot see what a canvas shows. */
async function isReadable(page, behind) {
  const worst = await page.addStyleTag({content: `html, body { background: ${behind} !important } #stage { display: none !important }`});
  isNone(await findings(page, {include: ['.panel', '#loupe']}, {runOnly: ['color-contrast']}), `panels before ${behind}`);
  await worst.evaluate((style) => style.remove());
}
const openAll = (page) => page.evaluate(() => document.querySelectorAll('details').forEach((part) => (part.open = true)));

for (const colorScheme of ['light', 'dark']) {
  test(`the gallery, ${colorScheme}`, async () => {
    const {page} = await openPage(`${server.address}/?quality=low`, {colorScheme});
    await page.waitForSelector('.card[data-frames]');
    await isSound(page, 'gallery');
    await page.close();
  });

  test(`a scene at several levels, ${colorScheme}`, async () => {
    const {page} = await openPage(`${server.address}/?quality=low&split=fan`, {colorScheme});
    await page.waitForFunction(() => document.querySelectorAll('#split-panes dd')[1]?.textContent.endsWith(' ms'));
    await isSound(page, 'split');
    await page.close();
  });

  test(`a scene with all its panels, ${colorScheme}`, async () => {
    const {page} = await openScene(server, 'zheng2020-ball', {colorScheme});
    await openAll(page);
    for (const button of await page.$$('[aria-expanded=false]')) if (await button.isVisible()) await button.click();
    await isSound(page, 'zheng2020-ball');
    await isReadable(page, colorScheme === 'light' ? 'black' : 'white');
    await page.selectOption('#scene', 'round-table');  // with obstacles
    await until(page, () => weft.stats.scene === 'round-table' && weft.stats.cloths.length > 0);
    await isSound(page, 'round-table');
    await page.close();
  });
}

test('on a phone', async () => {
  const phone = {viewport: {width: 390, height: 844}, hasTouch: true, isMobile: true};
  const {page} = await openPage(`${server.address}/?quality=low`, phone);
  await page.waitForSelector('.card[data-frames]');
  await isSound(page, 'gallery');
  const press = (selector) => (kFirefox ? page.click(selector) : page.tap(selector));  // WebDriver's taps click nothing there
  await press('.card[data-scene=flag]');
  await until(page, () => weft.stats.connected && weft.stats.cloths.length > 0);
  await press('#fold');
  await isSound(page, 'flag');
  await page.close();
});

test('with the banners: no such scene, a wind that is offered, a link to copy', async () => {
  const {page: refused} = await openPage(`${server.address}/?quality=low&scene=nonsense`);
  await refused.waitForSelector('#banner:not([hidden])');
  await isSound(refused, 'no such scene');
  await refused.close();
  const {page: offered} = await openScene(server, 'flag&wind=1,0,0,3');
  await offered.evaluate(() => Object.defineProperty(navigator, 'clipboard', {value: undefined}));
  await offered.click('#copy-link');
  await offered.waitForSelector('#wind-linked:not([hidden])');
  await isSound(offered, 'offers');
  await offered.close();
});
