// The page on the server's own port: it connects, the cloth moves, the controls do what they say.
import assert from 'node:assert/strict';
import {before, test} from 'node:test';
import {areaAround, differingPixels, openScene, pause, startServer, stats, until} from './harness.mjs';

const kInside = 0.6;  // m: a square of the cloth, whose sides are 1 m, that its folds leave covered

let server, page, witness;
before(async () => {
  server = await startServer(['zheng2020-distance', 'flag']);
  ({page, witness} = await openScene(server, 'zheng2020-distance', {deviceScaleFactor: 1}));  // pixels are counted
});

const resume = async () => {
  await page.click('#pause');
  await until(page, () => !weft.stats.lastFrame.paused);
};

test('the page says that it is live, and which scene it shows', async () => {
  assert.equal(await page.textContent('#connection'), 'live');
  assert.equal(await page.inputValue('#scene'), 'zheng2020-distance');
  assert.deepEqual(await page.$$eval('#scene option', (options) => options.map(({value}) => value)), ['zheng2020-distance', 'flag']);
  assert.equal(await page.isVisible('#banner'), false);
});

test('the cloth is drawn, and it moves; paused it stands still', async () => {
  const area = await areaAround(page, (await stats(page)).cloths[0].centre, kInside);
  const shoot = () => page.screenshot({clip: area});
  const first = await shoot();
  const {frames, lastFrame} = await stats(page);
  await until(page, (time) => weft.stats.lastFrame.time > time + 0.5, lastFrame.time);
  const moved = await differingPixels(page, first, await shoot());
  assert.ok((await stats(page)).frames > frames);
  assert.ok(moved.differing > 0.01 * moved.all, `${moved.differing} of ${moved.all} pixels changed in half a second of wind`);

  await pause(page);
  const still = await shoot();
  const same = await differingPixels(page, still, await shoot(), 0);
  assert.equal(same.differing, 0);
  // The cloth's blue is there: without it this would compare two pictures of an empty floor.
  await page.evaluate(() => weft.setCameraDistance(19));
  await until(page, () => weft.stats.settled && weft.stats.distance > 18);
  const away = await differingPixels(page, still, await shoot());
  assert.ok(away.differing > 0.8 * away.all, `${away.differing} of ${away.all} pixels were cloth`);
  await page.keyboard.press('2');
  await resume();
});

test('pause, one step, reset', async () => {
  await pause(page);
  assert.equal(await page.textContent('#pause'), 'Resume');
  const {lastFrame: stood} = await stats(page);
  await page.click('#step');
  await until(page, (f) => weft.stats.lastFrame.f > f, stood.f);
  assert.equal((await stats(page)).lastFrame.f, stood.f + 1);
  await page.keyboard.press('.');
  await until(page, (f) => weft.stats.lastFrame.f > f + 1, stood.f);
  assert.equal((await stats(page)).lastFrame.f, stood.f + 2);
  await page.click('#reset');
  await until(page, (epoch) => weft.stats.lastFrame.epoch === epoch + 1, stood.epoch);
  assert.equal((await stats(page)).lastFrame.f, 0);
  await resume();
  assert.equal(await page.textContent('#pause'), 'Pause');
  assert.equal(await page.isDisabled('#step'), true);  // a moving scene has no single steps
});

test('space pauses and R resets, but not while a control has the focus that needs the key', async () => {
  await page.focus('#stage');
  await page.keyboard.press('Space');
  await until(page, () => weft.stats.lastFrame.paused);
  await page.keyboard.press('Space');
  await until(page, () => !weft.stats.lastFrame.paused);
  const {lastFrame: {epoch}} = await stats(page);
  await page.keyboard.press('r');
  await until(page, (before) => weft.stats.lastFrame.epoch === before + 1, epoch);
  await page.focus('#wind-speed');
  const {eye} = await stats(page);
  await page.keyboard.press('ArrowRight');
  assert.deepEqual((await stats(page)).eye, eye);  // the slider's key, not the camera's
});

test('wind by the sliders', async () => {
  await page.fill('#wind-speed', '8');
  await page.fill('#wind-heading', '90');
  await page.fill('#wind-tilt', '0');
  // What the page knows of the wind comes from the server alone.
  await until(page, () => weft.stats.wind.speed === 8 && Math.abs(weft.stats.wind.direction[0] - 1) < 1e-9);
  assert.equal(await page.textContent('#wind-arrow-text'), 'wind 8.0 m/s');
  // Along +x the cloth is blown to its right.
  await until(page, () => weft.stats.cloths[0].centre[0] > 0.05);
  await page.fill('#wind-gusts', '0.4');
  await until(page, () => weft.stats.wind.gusts === 0.4 && weft.stats.wind.speed === 8);
  assert.equal(await page.textContent('#wind-gusts-value'), '40 %');
  assert.equal(await page.inputValue('#wind-gust-time'), '3');  // the scene's own, the default
  await page.fill('#wind-gust-time', '1.5');
  await until(page, () => weft.stats.wind.time_scale === 1.5 && weft.stats.wind.gusts === 0.4);
  assert.equal(await page.textContent('#wind-gust-time-value'), '1.5 s');
  await page.fill('#wind-gusts', '0');
  await page.fill('#wind-eddies', '0.6');
  await until(page, () => weft.stats.wind.gusts === undefined && weft.stats.wind.turbulence === 0.6);
  assert.equal(await page.textContent('#wind-eddies-value'), '60 %');
  await page.fill('#wind-eddy-size', '0.2');
  await until(page, () => weft.stats.wind.length_scale === 0.2 && weft.stats.wind.turbulence === 0.6);
  await page.fill('#wind-eddies', '0');
  await until(page, () => weft.stats.wind.turbulence === undefined);
  await page.fill('#wind-speed', '0');
  await until(page, () => weft.stats.wind.speed === 0);
  assert.equal(await page.isVisible('#wind-arrow'), false);
});

test('the picture’s age and what limits it are told', async () => {
  const told = await page.waitForFunction(() => document.getElementById('number-age').textContent.match(/^(\d+) ms, (\d+) on the way$/));
  const [, age, onWay] = (await told.jsonValue()).map(Number);
  assert.ok(onWay <= age, `${onWay} of ${age} ms on the way`);  // the rest is the page's own
  await pause(page);
  await page.waitForFunction(() => document.getElementById('number-limit').textContent === 'it stands still');
  await resume();
  await page.waitForFunction(() => document.getElementById('number-limit').textContent !== 'it stands still');
});

test('W toggles the wireframe', async () => {
  await pause(page);
  const area = await areaAround(page, (await stats(page)).cloths[0].centre, kInside);
  const plain = await page.screenshot({clip: area});
  await page.focus('#stage');
  await page.keyboard.press('w');
  await until(page, () => weft.stats.settled);
  assert.equal(await page.isChecked('#wireframe'), true);
  const wired = await differingPixels(page, plain, await page.screenshot({clip: area}));
  assert.ok(wired.differing > 0.2 * wired.all, `${wired.differing} of ${wired.all} pixels have wires`);
  await page.click('#wireframe');
  await until(page, () => weft.stats.settled);
  const back = await differingPixels(page, plain, await page.screenshot({clip: area}), 0);
  assert.equal(back.differing, 0);
  await resume();
});

test('the choice of scene', async () => {
  await page.selectOption('#scene', 'flag');
  await until(page, () => weft.stats.scene === 'flag' && weft.stats.cloths.length > 0);
  const {scenes} = await (await fetch(`${server.address}/v1/scenes`)).json();
  assert.equal(await page.textContent('#scene-title'), scenes.find(({name}) => name === 'flag').title);
  assert.equal(new URL(page.url()).searchParams.get('scene'), 'flag');
  // The other scene's clock ran on without this page: its cloth is another one.
  assert.equal((await stats(page)).cloths[0].name, 'flag');
});

test('every control has a name and can be reached by the Tab key', async () => {
  const nameless = await page.$$eval('button, input, select, summary', (controls) =>
    controls.filter((control) =>
      !(control.labels?.length || control.textContent.trim() || control.getAttribute('aria-label')) || control.tabIndex < 0)
      .map((control) => control.outerHTML));
  assert.deepEqual(nameless, []);
});

test('nothing was loaded from elsewhere, and the console is clean', () => {
  const elsewhere = witness.requests.filter((url) => !['data:', 'blob:'].includes(new URL(url).protocol) && new URL(url).origin !== server.address);
  assert.deepEqual(elsewhere, []);
  assert.ok(witness.requests.some((url) => url.endsWith('/three/three.module.js')), 'requests were seen at all');
  assert.deepEqual(witness.errors, []);
});
