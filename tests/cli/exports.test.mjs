// Files of `weft run` read by others: .glb by Khronos' validator and three.js, .usda by three.js; each frame is that of the .csv.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {USDLoader} from 'three/addons/loaders/USDLoader.js';
import {load, positionsOf, seenAt} from '../protocol/gltf.mjs';

let folder;
before(() => {folder = mkdtempSync(join(tmpdir(), 'weft-exports-'));});
after(() => rmSync(folder, {recursive: true}));

const path = (name) => join(folder, name);
const run = (scene, frames, level, names, ...more) => execFileSync(process.env.WEFT_BINARY, ['run', scene,
  '--frames', String(frames), '--level', String(level), ...names.flatMap((name) => ['--out', path(name)]), ...more]);

/** Positions by frame, of a .csv: frame, time, row, col, x, y, z, ... */
function framesOf(name) {
  const frames = [];
  for (const line of readFileSync(path(name), 'utf8').trim().split('\n').slice(1)) {
    const [frame, time, , , x, y, z] = line.split(',').map(Number);
    (frames[frame] ??= {time, positions: []}).positions.push(x, y, z);
  }
  return frames;
}

function near(found, expected, tolerance, what) {
  assert.equal(found.length, expected.length, what);
  const worst = found.reduce((most, value, i) => Math.max(most, Math.abs(value - expected[i])), 0);
  assert.ok(worst <= tolerance, `${what}: off by ${worst}`);
}

const validated = (name) => load(new Uint8Array(readFileSync(path(name))));
/** The meshes seen at that time whose names begin so. */
const named = (gltf, time, name) => seenAt(gltf, time).filter((mesh) => mesh.name.startsWith(name));

test('a .glb of any length has each frame, one stretch of it seen at a time', async () => {
  run('zheng2020-ball', 150, 3, ['long.glb', 'long.csv'], '--set', '/cloths/0/levels={"min": 3, "max": 3}');
  const frames = framesOf('long.csv');
  const gltf = await validated('long.glb');
  for (const frame of [0, 1, 59, 61, 90, 119, 121, 149]) {
    const seen = named(gltf, frames[frame].time, 'cloth');
    assert.equal(seen.length, 1, `frame ${frame}`);
    near(positionsOf(seen[0]), frames[frame].positions, 1e-4, `frame ${frame}`);
  }
});

test('a torn cloth is torn in a .glb', async () => {
  run('paper-screen', 120, 5, ['torn.glb', 'torn.usda', 'torn.csv']);
  const gltf = await validated('torn.glb');
  const frames = framesOf('torn.csv');
  const triangles = (time) => named(gltf, time, 'paper')[0].geometry.index.count / 3;
  assert.equal(triangles(0), 2 * 32 * 32);
  assert.ok(triangles(frames[120].time) < 2 * 32 * 32);
  // As many faces as in the last of the .usda's samples, of 4 corners each.
  const samples = /int\[\] faceVertexCounts\.timeSamples = \{\n([^}]*)\}/.exec(readFileSync(path('torn.usda'), 'utf8'))[1];
  const last = samples.trim().split('\n').at(-1);
  assert.equal(triangles(frames[120].time), 2 * last.split('[')[1].split(',').filter((count) => count.includes('4')).length);
});

test('all cloths, balls and obstacles are in one .glb', async () => {
  run('paper-screen', 60, 4, ['all.glb'], '--set',
    '/cloths/-={"name": "second", "size": [0.5, 0.5], "levels": {"min": 3, "max": 3}, "position": [3, 0, 0], "pins": ["top"]}');
  const gltf = await validated('all.glb');
  const names = new Set();
  gltf.scene.traverse((node) => {if (node.isMesh) names.add(node.name.replace(/\d+$/, ''));});
  assert.deepEqual([...names].sort(), ['ball-', 'obstacle-', 'paper', 'second']);
});

test('a .usda has each frame; three.js reads its meshes and how bodies move', async () => {
  run('zheng2020-ball', 30, 4, ['sheet.usda', 'sheet.csv', 'sheet.glb']);
  const frames = framesOf('sheet.csv');
  const text = readFileSync(path('sheet.usda'), 'utf8');
  const points = /point3f\[\] points\.timeSamples = \{\n([^}]*)\}/.exec(text)[1].trim().split('\n');
  assert.equal(points.length, 31);
  points.forEach((line, frame) => {
    const [, code, values] = /^ *(\d+): (.*),$/.exec(line);
    assert.equal(Number(code), frame);
    near(values.match(/[-\d.e]+/g).map(Number), frames[frame].positions, 1e-6, `frame ${frame}`);
  });
  assert.match(text, /timeCodesPerSecond = 30\n {4}upAxis = "Y"/);  // the scene's time step is 1/30 s

  const group = new USDLoader().parse(text);
  const meshes = {};
  group.traverse((node) => {if (node.isMesh) meshes[node.name] = node;});
  assert.deepEqual(Object.keys(meshes).sort(), ['ball_1', 'cloth']);
  const {position, normal, uv} = meshes.cloth.geometry.attributes;
  assert.equal(position.count, 16 * 16 * 6);  // each corner of each triangle
  assert.equal(normal.count, position.count);
  assert.equal(uv.count, position.count);

  const way = group.animations[0].tracks.find((track) => track.name === 'ball_1.position');
  const gltf = await validated('sheet.glb');
  for (const frame of [0, 10, 30]) {
    const [ball] = named(gltf, frames[frame].time, 'ball-1');
    near([...way.createInterpolant().evaluate(frames[frame].time)], ball.position.toArray(), 1e-5, `frame ${frame}`);
  }
});
