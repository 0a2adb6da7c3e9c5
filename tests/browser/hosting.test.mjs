// The page away from the server, behind a proxy, and with an address that leads nowhere.
import assert from 'node:assert/strict';
import {createServer, request as httpRequest} from 'node:http';
import {connect} from 'node:net';
import {readFile} from 'node:fs/promises';
import {extname, join, normalize} from 'node:path';
import {after, before, test} from 'node:test';
import {setTimeout as sleep} from 'node:timers/promises';
import {kPatienceMs, openPage, startServer, stats, until} from './harness.mjs';

const kTypes = {'.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.svg': 'image/svg+xml'};

let service, host, site;
before(async () => {
  service = await startServer(['flag', 'curtain', 'round-table']);
  host = createServer(async (request, response) => {
    const path = new URL(request.url, 'http://host').pathname;
    const file = join(process.env.WEFT_PAGE, normalize(path === '/' ? '/index.html' : path));
    try {
      const content = await readFile(file);
      response.writeHead(200, {'content-type': kTypes[extname(file)] ?? 'application/octet-stream'}).end(content);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((resolve) => host.listen(0, '127.0.0.1', resolve));
  site = `http://127.0.0.1:${host.address().port}`;
});
after(() => host.close());

const serviceSocket = () => service.address.replace('http', 'ws');

test('any static host will do, the service is a parameter', async () => {
  const {page, witness} = await openPage(`${site}/?quality=low&server=${serviceSocket()}&scene=curtain`);
  await until(page, () => weft.stats.connected && weft.stats.frames > 3);
  assert.equal((await stats(page)).scene, 'curtain');
  const origins = new Set(witness.requests.map((url) => new URL(url).origin).filter((origin) => origin !== 'null'));
  for (const origin of origins) assert.ok([site, service.address].includes(origin), `a request to ${origin}`);
  assert.deepEqual(witness.errors, []);
  await page.close();
});

/**
 * A proxy that has the service below `path`, and nothing else.
 * @returns {Promise<{address: string, asked: string[], stop: () => void}>} `asked`: the path of each request
 */
async function startProxy(path) {
  const asked = [];
  const onward = ({url, headers}) => {
    asked.push(url);
    return url.startsWith(path) && {host: '127.0.0.1', port: service.port, path: url.slice(path.length - 1), headers};
  };
  const proxy = createServer((request, response) => {
    const there = onward(request);
    if (!there) return response.writeHead(404).end();
    httpRequest(there, (answer) => {
      response.writeHead(answer.statusCode, answer.headers);
      answer.pipe(response);
    }).end();
  });
  proxy.on('upgrade', (request, socket) => {
    const there = onward(request);
    if (!there) return socket.end('HTTP/1.1 404 Not Found\r\n\r\n');
    const lines = Object.entries(there.headers).map(([name, value]) => `${name}: ${value}\r\n`);
    const service = connect(there.port, there.host);
    service.write(`GET ${there.path} HTTP/1.1\r\n${lines.join('')}\r\n`);
    for (const [from, to] of [[socket, service], [service, socket]]) from.on('error', () => to.destroy()).pipe(to);
  });
  await new Promise((resolve) => proxy.listen(0, '127.0.0.1', resolve));
  return {
    address: `http://127.0.0.1:${proxy.address().port}${path}`,
    asked,
    stop: () => {
      proxy.closeAllConnections();
      proxy.close();
    },
  };
}

test('behind a proxy the page asks for everything below its own path', async () => {
  const proxy = await startProxy('/cloth/');
  const {page, witness} = await openPage(`${proxy.address}?quality=low`);
  await page.click('.card[data-scene=flag]');
  await until(page, () => weft.stats.connected && weft.stats.frames > 3);
  assert.equal((await stats(page)).scene, 'flag');
  await page.selectOption('#scene', 'round-table');
  await until(page, () => weft.stats.connected && weft.stats.scene === 'round-table' && weft.stats.cloths.length > 0);
  for (let tries = 0; !proxy.asked.some((path) => path.includes('/meshes/')) && tries < kPatienceMs / 100; ++tries) await sleep(100);
  await page.close();
  proxy.stop();
  for (const path of ['app/main.js', 'three/three.module.js', 'connection/worker.js', 'v1/scenes', 'v1/scenes/flag', 'v1/scenes/round-table/meshes/0']) {
    assert.ok(proxy.asked.includes(`/cloth/${path}`), `no request for ${path} in ${proxy.asked}`);
  }
  assert.deepEqual(proxy.asked.filter((path) => !path.startsWith('/cloth/')), []);
  assert.deepEqual(witness.errors, []);
});

test('without a scene it is the gallery of the service, with its pictures', async () => {
  const {page} = await openPage(`${site}/?quality=low&server=${serviceSocket()}`);
  await page.waitForSelector('.card[data-scene=flag][data-frames]');
  assert.deepEqual(await page.$$eval('.card', (cards) => cards.map(({dataset}) => dataset.scene)), ['flag', 'curtain', 'round-table']);
  assert.equal(new URL(await page.getAttribute('.card[data-scene=curtain]', 'href')).searchParams.get('server'), serviceSocket());
  await page.close();
});

test('without a scene a service that is not there is told, and tried again', async () => {
  const {page} = await openPage(`${site}/?quality=low&server=ws://127.0.0.1:9`);
  await page.waitForSelector('#banner:not([hidden]) >> text=No list of scenes from 127.0.0.1:9.');
  assert.equal(await page.isVisible('#banner-retry'), true);
  await page.close();
});

test('a scene that does not exist is told, and another can be chosen', async () => {
  const {page} = await openPage(`${service.address}/?quality=low&scene=nonsense`);
  await page.waitForSelector('#banner:not([hidden]) >> text=This server has no scene “nonsense”. Choose one from the list.');
  assert.equal(await page.textContent('#connection'), 'not connected');
  await page.selectOption('#scene', 'curtain');
  await until(page, () => weft.stats.connected && weft.stats.scene === 'curtain');
  assert.equal(await page.isVisible('#banner'), false);
  await page.close();
});

test('a service that is not there is told, and tried again', async () => {
  const {page} = await openPage(`${site}/?quality=low&server=ws://127.0.0.1:9&scene=flag`);
  await page.waitForSelector('#banner:not([hidden]) >> text=No answer from 127.0.0.1:9.');
  assert.equal(await page.isVisible('#banner-retry'), true);
  await page.close();
});

test('an address that is none is told', async () => {
  const {page} = await openPage(`${site}/?server=ftp://somewhere`);
  await page.waitForSelector('#banner:not([hidden]) >> text=server=ftp://somewhere is not an address like ws://host:8080');
  await page.close();
});

test('a browser without WebGL is told, in the gallery and in a scene', async () => {
  for (const query of ['', '?scene=flag']) {
    const {page} = await openPage(`${service.address}/${query}`, {before: () => (HTMLCanvasElement.prototype.getContext = () => null)});
    await page.waitForSelector('#banner:not([hidden]) >> text=The page cannot start: ');
    await page.close();
  }
});
