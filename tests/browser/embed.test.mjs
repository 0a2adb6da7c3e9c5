// <weft-view> in a page of another origin, which knows nothing of Weft but the module.
import assert from 'node:assert/strict';
import {createServer} from 'node:http';
import {after, before, test} from 'node:test';
import {hide, openPage, startServer, viewersAre} from './harness.mjs';

let service, foreign, site, page, witness;

/** A page below a path of its own; `localhost` alone is let in by every server, what is below it is not. */
const markup = (address, origin) => `<!doctype html><title>A shop</title><link rel="icon" href="data:,">
  <style>weft-view { width: 200px; height: 150px; }</style>
  <script type="module" src="${address}/weft-view.js"></script>
  <h1>Our flags</h1>
  <weft-view id="near" server="${origin}" scene="zheng2020-distance" distance="0.8" quality="low" label="A cloth from near"></weft-view>
  <weft-view id="far" server="${origin.replace('http', 'ws')}/" scene="zheng2020-distance" distance="12" quality="low" controls></weft-view>
  <div style="height: 3000px"></div>
  <script>
    const seen = {};
    for (const view of document.querySelectorAll('weft-view')) view.addEventListener('weft-stats', ({detail}) => (seen[view.id] = detail));
  </script>`;

before(async () => {
  foreign = createServer(({url}, response) => {
    const address = new URL(url, 'http://host').searchParams.get('service');
    response.writeHead(200, {'content-type': 'text/html'}).end(markup(address, address));
  });
  await new Promise((resolve) => foreign.listen(0, '127.0.0.1', resolve));
  site = `http://shop.localhost:${foreign.address().port}`;
  service = await startServer(['zheng2020-distance', 'curtain'], {options: ['--allow-origin', site]});
  ({page, witness} = await openPage(`${site}/flags/index.html?service=${service.address}`));
});
after(() => foreign.close());

const ask = (id, expression) => page.$eval(`#${id}`, (view, text) => new Function('view', `return ${text}`)(view), expression);
const until = (condition, argument) => page.waitForFunction(condition, argument, {polling: 50});
/** Waits until a view that is shown anew has more pictures. */
async function plays(id) {
  const frames = await ask(id, 'view.frames');
  await until(([name, before]) => {
    const view = document.getElementById(name);
    return view.state === 'open' && view.frames > before + 2;
  }, [id, frames]);
}

test('two of them play, each at the level of its own distance', async () => {
  await plays('near');
  await plays('far');
  // Table 1 of the paper: nearer than 1 m level 6, beyond 10 m level 4.
  await until(() => seen.near?.cloths[0].level === 6 && seen.far?.cloths[0].level === 4);
  assert.equal(await page.evaluate(() => seen.near.viewers), 2);
  assert.equal(await ask('near', `view.shadowRoot.querySelector('canvas').getAttribute('aria-label')`), 'A cloth from near');
});

test('its inside is hidden from the page', async () => {
  assert.equal(await page.evaluate(() => document.querySelectorAll('canvas').length), 0);
});

test('hidden, out of sight or gone it is not connected; in sight again it is', async () => {
  await page.$eval('#near', (view) => (view.hidden = true));
  await viewersAre(service, 1);
  assert.equal(await ask('near', 'view.state'), 'closed');
  await page.$eval('#near', (view) => (view.hidden = false));
  await viewersAre(service, 2);

  await page.evaluate(() => scrollTo(0, 2000));
  await viewersAre(service, 0);
  await page.evaluate(() => scrollTo(0, 0));
  await plays('far');
  await viewersAre(service, 2);

  await hide(page, true);
  await viewersAre(service, 0);
  await hide(page, false);
  await viewersAre(service, 2);

  await page.evaluate(() => {
    window.kept = document.getElementById('near');
    window.kept.remove();
  });
  await viewersAre(service, 1);
  await page.evaluate(() => document.querySelector('h1').after(window.kept));
  await viewersAre(service, 2);
  await plays('near');
});

test('another scene by another attribute', async () => {
  await page.$eval('#near', (view) => view.setAttribute('scene', 'curtain'));
  await plays('near');
  const scenes = (await (await fetch(`${service.address}/v1/scenes`)).json()).scenes;
  assert.deepEqual(scenes.map(({name, viewers}) => [name, viewers]), [['zheng2020-distance', 1], ['curtain', 1]]);
});

test('with controls the wheel zooms; without them the page scrolls', async () => {
  const wheelOver = async (id) => {
    const box = await page.locator(`#${id}`).boundingBox();
    await page.mouse.move(box.x + 100, box.y + 75);
    await page.mouse.wheel(0, 100);
  };
  const before = await ask('far', 'Math.hypot(...view.eye)');
  await wheelOver('far');
  await until((distance) => Math.abs(Math.hypot(...document.getElementById('far').eye) - distance) > 0.1, before);
  assert.equal(await page.evaluate(() => scrollY), 0);
  const eye = await ask('near', 'view.eye');
  await wheelOver('near');
  await until(() => scrollY > 0);
  (await ask('near', 'view.eye')).forEach((value, axis) => assert.ok(Math.abs(value - eye[axis]) < 1e-9, `the eye went from ${eye}`));
});

test('a page that the server does not let in is told, and the rest of it goes on', async () => {
  const closed = await startServer(['curtain']);
  // The module comes from the server that does, the scene from the one that does not.
  const {page: other} = await openPage(`${site}/?service=${service.address}`);
  await other.$eval('#near', (view, server) => view.setAttribute('server', server), closed.address);
  await other.waitForSelector('#near p:not([hidden]) >> text=Not connected to the scene.');
  await viewersAre(closed, 0);
  await other.close();
});

test('the console is clean', () => assert.deepEqual(witness.errors, []));
