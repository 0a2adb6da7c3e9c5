// What a viewer saves of what is seen: a picture, a video, a model.
import assert from 'node:assert/strict';
import {execFile} from 'node:child_process';
import {mkdtemp, readFile, rm, writeFile} from 'node:fs/promises';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {before, test} from 'node:test';
import {promisify} from 'node:util';
import {validate} from '../protocol/gltf.mjs';
import {kFirefox} from './browsers.mjs';
import {hide, openScene, pause, startServer, stats, until} from './harness.mjs';

let server, page, witness;
before(async () => {
  server = await startServer(['zheng2020-ball']);
  ({page, witness} = await openScene(server, 'zheng2020-ball', {deviceScaleFactor: 0.5, pictures: null}));  // it saves what it draws
  await until(page, () => weft.stats.balls.length > 0);
});

/** What a click has the page save: the file's name and bytes. */
async function saved(click) {
  if (kFirefox) return handedOver(click);
  const [download] = await Promise.all([page.waitForEvent('download'), click()]);
  const parts = [];
  for await (const part of await download.createReadStream()) parts.push(part);
  return {name: download.suggestedFilename(), bytes: Buffer.concat(parts)};
}

/** The same, as the page hands it to the browser: of Firefox's downloads the driver tells only those that a navigation began. */
async function handedOver(click) {
  await page.evaluate(() => {
    window.handed = new Promise((resolve) => {
      const {createObjectURL} = URL, {click: follow} = HTMLAnchorElement.prototype;
      const blobs = new Map();
      URL.createObjectURL = (blob) => {
        const address = createObjectURL.call(URL, blob);
        blobs.set(address, blob);
        return address;
      };
      HTMLAnchorElement.prototype.click = function () {
        follow.call(this);
        if (!blobs.has(this.href)) return;
        Object.assign(URL, {createObjectURL});
        HTMLAnchorElement.prototype.click = follow;
        const reader = new FileReader();
        reader.onload = () => resolve({name: this.download, base64: reader.result.split(',')[1]});
        reader.readAsDataURL(blobs.get(this.href));
      };
    });
  });
  await click();
  const {name, base64} = await page.evaluate(() => window.handed);
  return {name, bytes: Buffer.from(base64, 'base64')};
}

test('a video of what moves: begun and ended by the button, which tells how long it is', async () => {
  await page.click('#record');
  await page.waitForFunction(() => document.getElementById('record').textContent === 'Stop 0:01');
  const {name, bytes} = await saved(() => page.click('#record'));
  assert.match(name, /^weft-zheng2020-ball-\d+\.\d\ds\.webm$/);
  assert.equal(bytes.readUInt32BE(0), 0x1a45dfa3);  // EBML, of which WebM is made
  assert.ok(bytes.includes('webm'));
  assert.ok(bytes.length > 5000, `${bytes.length} bytes`);
  await page.waitForFunction(() => document.getElementById('record').textContent === 'Video');
});

test('hidden, a recording ends, and is saved', async () => {
  await page.click('#record');
  await page.waitForFunction(() => document.getElementById('record').textContent.startsWith('Stop'));
  const {name} = await saved(() => hide(page, true));
  assert.match(name, /\.webm$/);
  await hide(page, false);
  await until(page, () => weft.stats.connected && weft.stats.cloths.length > 0);
});

test('a picture as large as the canvas, of what is on it', async () => {
  await pause(page);
  const {name, bytes} = await saved(() => page.click('#save-picture'));
  const {time} = (await stats(page)).lastFrame;
  assert.equal(name, `weft-zheng2020-ball-${time.toFixed(2)}s.png`);
  const {width, height, colours} = await page.evaluate(async (text) => {
    const image = await createImageBitmap(new Blob([Uint8Array.from(atob(text), (character) => character.charCodeAt(0))]));
    const pen = new OffscreenCanvas(image.width, image.height).getContext('2d');
    pen.drawImage(image, 0, 0);
    const pixels = new Uint32Array(pen.getImageData(0, 0, image.width, image.height).data.buffer);
    return {width: image.width, height: image.height, colours: new Set(pixels).size};
  }, bytes.toString('base64'));
  assert.deepEqual([width, height], [450, 320]);
  assert.ok(colours > 100, `${colours} colours`);
});

/** A .glb's document and its buffer. */
function opened(bytes) {
  const jsonBytes = bytes.readUInt32LE(12);
  return {gltf: JSON.parse(bytes.toString('utf8', 20, 20 + jsonBytes)), binary: bytes.subarray(28 + jsonBytes)};
}
/** The numbers of an accessor of floats. */
function floats({gltf, binary}, index, each) {
  const {bufferView, count} = gltf.accessors[index];
  const {byteOffset} = gltf.bufferViews[bufferView];
  return Array.from({length: each * count}, (_, i) => binary.readFloatLE(byteOffset + 4 * i));
}

test('a model of cloth and ball where they are, with the fabric', async () => {
  const {name, bytes} = await saved(() => page.click('#save-model'));
  assert.match(name, /^weft-zheng2020-ball-\d+\.\d\ds\.glb$/);
  await validate(new Uint8Array(bytes));
  const {gltf, binary} = opened(bytes);
  const {cloths: [cloth], balls: [ball]} = await stats(page);
  const node = (wanted) => gltf.nodes.find((each) => each.name === wanted);

  const primitive = gltf.meshes[node(cloth.name).mesh].primitives[0];
  const place = node(cloth.name).translation;
  const positions = floats({gltf, binary}, primitive.attributes.POSITION, 3).map((value, i) => value + place[i % 3]);
  assert.equal(positions.length, 3 * cloth.rows * cloth.cols);
  const told = await page.evaluate(() => weft.positions());
  const worst = Math.max(...told.map((value, i) => Math.abs(value - positions[i])));
  assert.ok(worst < 1e-5, `a node is ${worst} m off`);
  assert.equal(gltf.accessors[primitive.indices].count, 6 * cloth.faces);
  assert.equal(gltf.images.length, 1);

  const {translation, scale} = node(`ball-${ball.ball}`);
  translation.forEach((value, axis) => assert.ok(Math.abs(value - ball.position[axis]) < 1e-5, `ball at ${translation}, not at ${ball.position}`));
  assert.deepEqual(scale, [ball.radius, ball.radius, ball.radius]);  // though it is drawn a little smaller: see BallsView
  assert.equal(gltf.animations, undefined);
});

test('a cloth can start from the model', async () => {
  const folder = await mkdtemp(join(tmpdir(), 'weft-model-'));
  const {bytes} = await saved(() => page.click('#save-model'));
  const {cloths: [{name, level}]} = await stats(page);
  const scene = {cloths: [{name, size: [1, 1], levels: {min: level, max: level}, nodes: {file: 'model.glb'}}]};
  await writeFile(join(folder, 'model.glb'), bytes);
  await writeFile(join(folder, 'scene.json'), JSON.stringify(scene));
  const out = join(folder, 'start.csv');
  await promisify(execFile)(process.env.WEFT_BINARY, ['run', join(folder, 'scene.json'), '--frames', '1', '--out', out]);
  const rows = (await readFile(out, 'utf8')).split('\n').filter((line) => line.startsWith('0,'));
  const told = await page.evaluate(() => weft.positions());
  const started = rows.flatMap((row) => row.split(',').slice(4, 7).map(Number));
  assert.equal(started.length, told.length);
  const worst = Math.max(...told.map((value, i) => Math.abs(value - started[i])));
  assert.ok(worst < 1e-5, `a node is ${worst} m off`);
  await rm(folder, {recursive: true});
});

test('a model of what moves: its last frame is the last one that came', async () => {
  await page.click('#pause');  // goes on
  const text = () => document.getElementById('save-motion').textContent;
  await until(page, () => !weft.stats.lastFrame.paused);
  const begin = (await stats(page)).lastFrame.time;
  await page.click('#save-motion');
  await page.waitForFunction(() => document.getElementById('save-motion').textContent === 'Stop 0:02');
  await pause(page);
  const {time} = (await stats(page)).lastFrame;
  const told = await page.evaluate(() => weft.positions());
  const {name, bytes} = await saved(() => page.click('#save-motion'));
  assert.match(name, /^weft-zheng2020-ball-\d+\.\d\ds\.glb$/);
  assert.equal(await page.evaluate(text), 'Motion');
  await validate(new Uint8Array(bytes));
  const {gltf, binary} = opened(bytes);
  const [{channels, samplers}] = gltf.animations;
  const times = Math.max(...samplers.map(({input}) => gltf.accessors[input].max[0]));
  assert.ok(times >= 2 && times <= time - begin, `${times} s, of ${begin} s to ${time} s`);
  const ways = new Set(channels.map(({target}) => `${gltf.nodes[target.node].name.replace(/-frame.*/, '')} ${target.path}`));
  const {cloths: [cloth], balls: [ball]} = await stats(page);
  assert.ok(ways.has(`${cloth.name} weights`) && ways.has(`ball-${ball.ball} translation`), [...ways].join());

  // The cloth's last mesh at its last target, if its level lasted for more than a frame: frames are 1/30 s apart, the
  // scene's own step, and none is left out.
  const mesh = gltf.meshes[gltf.nodes.findLast(({name: each}) => each.startsWith(cloth.name)).mesh];
  const [{attributes, targets}] = mesh.primitives;
  const first = floats({gltf, binary}, attributes.POSITION, 3);
  const last = targets ? floats({gltf, binary}, targets.at(-1).POSITION, 3) : first.map(() => 0);
  const worst = Math.max(...told.map((value, i) => Math.abs(value - first[i] - last[i])));
  assert.ok(worst < 1e-5, `a node is ${worst} m off`);
  assert.equal(gltf.images.length, 1);
});

test('nothing was loaded from elsewhere, and the console is clean', () => {
  const elsewhere = witness.requests.filter((url) => !['data:', 'blob:'].includes(new URL(url).protocol) && new URL(url).origin !== server.address);
  assert.deepEqual(elsewhere, []);
  assert.deepEqual(witness.errors, []);
});
