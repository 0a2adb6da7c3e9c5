// The JavaScript package: packed, installed into an empty project, and used there from Node, from a page, and from TypeScript.
import assert from 'node:assert/strict';
import {execFile} from 'node:child_process';
import {once} from 'node:events';
import {cpSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {createServer} from 'node:http';
import {tmpdir} from 'node:os';
import path from 'node:path';
import {after, before, test} from 'node:test';
import {fileURLToPath} from 'node:url';
import {promisify} from 'node:util';

import {openPage, startServer} from '../browser/harness.mjs';

const run = promisify(execFile);
const kSource = fileURLToPath(new URL('../../protocol/clients/js', import.meta.url));
const kQuietly = ['--ignore-scripts', '--no-audit', '--no-fund', '--prefer-offline', '--loglevel=error'];

const folder = mkdtempSync(path.join(tmpdir(), 'weft-package-'));
const source = path.join(folder, 'source'), project = path.join(folder, 'project');
after(() => rmSync(folder, {recursive: true}));

before(async () => {
  cpSync(kSource, source, {recursive: true, filter: (name) => !/\/(node_modules|types)$/.test(name)});
  await run('npm', ['ci', ...kQuietly], {cwd: source});
  const {stdout} = await run('npm', ['pack', '--silent'], {cwd: source});
  mkdirSync(project);
  writeFileSync(path.join(project, 'package.json'), '{"name": "project", "private": true, "type": "module"}');
  await run('npm', ['install', ...kQuietly, path.join(source, stdout.trim().split('\n').at(-1))], {cwd: project});
});

/** A file of the project. */
const write = (name, text) => writeFileSync(path.join(project, name), text);
const installed = (...names) => path.join(project, 'node_modules', 'weft-client', ...names);

test('the package has the modules and their types, and nothing else', () => {
  const modules = readdirSync(kSource).filter((name) => name.endsWith('.js'));
  assert.deepEqual(readdirSync(installed()).sort(), [...modules, 'README.md', 'package.json', 'types'].sort());
  assert.deepEqual(readdirSync(installed('types')).sort(), modules.map((name) => name.replace('.js', '.d.ts')).sort());
});

test('from Node', async () => {
  const server = await startServer(['flag']);
  write('program.js', `
    import { connect, WeftError } from 'weft-client';
    const scene = await connect(process.argv[2]);
    const told = await scene.camera({ distance: 0.8 });
    const { cloths: [cloth] } = await scene.nextFrame(({ stamp }) => stamp.f >= told.f);
    const refused = await scene.setWind([1, 0, 0], 1000).catch((error) => error instanceof WeftError && error.path);
    console.log(JSON.stringify([cloth.rows, cloth.cols, cloth.positions.length, refused]));
    scene.close();`);
  const {stdout} = await run('node', ['program.js', `ws://127.0.0.1:${server.port}/v1/scenes/flag`], {cwd: project});
  assert.deepEqual(JSON.parse(stdout), [65, 65, 3 * 65 * 65, '/speed']);  // flag.json: level 6 within 3 m
  await server.stop();
});

test('from a page, without a bundler', async (context) => {
  const host = createServer((request, response) => {
    const {pathname} = new URL(request.url, 'http://localhost');
    response.setHeader('Content-Type', pathname.endsWith('.js') ? 'text/javascript' : 'text/html');
    response.end(readFileSync(path.join(project, path.normalize(pathname))));
  }).listen(0, '127.0.0.1');
  context.after(() => host.close() && host.closeAllConnections());
  await once(host, 'listening');
  const address = `http://127.0.0.1:${host.address().port}`;
  const server = await startServer(['flag', '--allow-origin', address]);
  write('favicon.ico', '');
  write('page.html', `<!doctype html><title>waiting</title><script type="module">
    import { connect } from './node_modules/weft-client/weft.js';
    const scene = await connect('ws://127.0.0.1:${server.port}/v1/scenes/flag');
    const told = await scene.camera({ distance: 12 });
    const frame = await scene.nextFrame(({ stamp }) => stamp.f >= told.f);
    document.title = frame.cloths[0].positions.length;</script>`);
  const {page, witness} = await openPage(`${address}/page.html`);
  await page.waitForFunction(() => document.title !== 'waiting');
  assert.equal(await page.title(), String(3 * 17 * 17));  // flag.json: level 4 beyond 8 m
  assert.deepEqual(witness.errors, []);
  assert.deepEqual(witness.requests.filter((url) => !url.startsWith(address) && !url.startsWith('ws:')), []);
  await page.close();
  await server.stop();
});

/** TypeScript's errors in a program of the project: the line of each. */
async function errors(text) {
  write('program.ts', text);
  write('tsconfig.json', JSON.stringify({
    compilerOptions: {strict: true, noEmit: true, target: 'es2022', module: 'nodenext', lib: ['es2022', 'dom'], types: []},
    files: ['program.ts'],
  }));
  const told = await run(path.join(source, 'node_modules', '.bin', 'tsc'), {cwd: project}).then(() => '', ({stdout}) => stdout);
  return told.trim().split('\n').filter(Boolean).map((line) => Number(line.match(/^program\.ts\((\d+),/)?.[1] ?? assert.fail(line)));
}

test('from TypeScript: a good program has no errors, and each mistake is found', async () => {
  assert.deepEqual(await errors(`
    import { connect, WeftError, type Frame, type Options } from 'weft-client';
    const options: Options = { reconnect: true, onframe: (frame: Frame) => { console.log(frame.stamp.f); } };
    const scene = await connect('ws://127.0.0.1:8080/v1/scenes/flag', options);
    const ball: number = await scene.addBall([0, 1, 2], 0.2, { motion: 'dynamic' });
    await scene.throwBall(ball, [0, 0, -6]).catch((error: WeftError) => console.log(error.path));
    const positions: Float32Array = (await scene.nextFrame()).cloths[0].positions;
    const names: string[] = (await scene.listScenes()).map(({ name }) => name);
    console.log(positions, names);`), []);
  assert.deepEqual(await errors(`
    import { connect } from 'weft-client';
    const scene = await connect('ws://127.0.0.1:8080/v1/scenes/flag', { windw: 2 });
    await scene.throwBall('1', [0, 0, -6]);
    await scene.addBall([0, 1, 2], 0.2, { motion: 'flying' });
    await scene.camera({ distance: [1, 2, 3] });
    (await scene.nextFrame()).cloths[0].position;`), [3, 4, 5, 6, 7]);
});
