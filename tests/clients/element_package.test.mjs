// The package of the element weft-view: packed from the page's folder, installed into an empty project, and shown by a page of its own.
import assert from 'node:assert/strict';
import {execFile} from 'node:child_process';
import {once} from 'node:events';
import {mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync} from 'node:fs';
import {createServer} from 'node:http';
import {tmpdir} from 'node:os';
import path from 'node:path';
import {after, test} from 'node:test';
import {promisify} from 'node:util';
import {openPage, startServer} from '../browser/harness.mjs';

const run = promisify(execFile);
const project = mkdtempSync(path.join(tmpdir(), 'weft-element-'));
after(() => rmSync(project, {recursive: true}));

test('installed into an empty project it shows a scene, and loads nothing from elsewhere', async (context) => {
  const {stdout} = await run('npm', ['pack', '--silent', process.env.WEFT_PAGE], {cwd: project});
  writeFileSync(path.join(project, 'package.json'), '{"name": "project", "private": true}');
  await run('npm', ['install', '--no-audit', '--no-fund', '--loglevel=error', `./${stdout.trim().split('\n').at(-1)}`], {cwd: project});
  assert.deepEqual(readdirSync(path.join(project, 'node_modules', 'weft-view', 'app')).sort(), ['settings.js', 'show.js', 'view_link.js']);

  const host = createServer(({url}, response) => {
    const {pathname} = new URL(url, 'http://localhost');
    response.setHeader('Content-Type', pathname.endsWith('.js') ? 'text/javascript' : 'text/html');
    response.end(readFileSync(path.join(project, path.normalize(pathname))));
  }).listen(0, '127.0.0.1');
  context.after(() => host.close() && host.closeAllConnections());
  await once(host, 'listening');
  const site = `http://127.0.0.1:${host.address().port}`;
  const server = await startServer(['flag'], {options: ['--allow-origin', site]});
  writeFileSync(path.join(project, 'page.html'), `<!doctype html><title>A shop</title><link rel="icon" href="data:,">
    <script type="module" src="node_modules/weft-view/weft-view.js"></script>
    <weft-view server="ws://127.0.0.1:${server.port}" scene="flag" distance="12" quality="low"></weft-view>
    <script>document.querySelector('weft-view').addEventListener('weft-stats', ({detail}) => (window.level = detail.cloths[0].level));</script>`);
  const {page, witness} = await openPage(`${site}/page.html`);
  await page.waitForFunction(() => document.querySelector('weft-view').frames > 2 && window.level === 4);  // flag.json: beyond 8 m
  assert.deepEqual(witness.errors, []);
  assert.deepEqual(witness.requests.filter((url) => !url.startsWith(site) && !url.startsWith('ws:') && !url.startsWith('data:')), []);
  await page.close();
  await server.stop();
});
