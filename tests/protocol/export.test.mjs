// Files that both clients make of frames: .glb by Khronos' validator and three.js, which shows the frames again; .obj line by line.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { glbBytes, objText } from '../../protocol/clients/js/weft.js';
import { load, positionsOf, seenAt, validate } from './gltf.mjs';

let folder;
before(() => { folder = mkdtempSync(join(tmpdir(), 'weft-export-')); });
after(() => rmSync(folder, { recursive: true }));

/** A grid of nodes 1 m apart, from (0, lift, 0). */
function cloth(index, rows, cols, lift, torn = []) {
  const nodes = Array.from({ length: rows * cols }, (_, i) => [i % cols, lift, Math.floor(i / cols)]);
  return { cloth: index, rows, cols, origin: [0, 0, 0], positions: Float32Array.from(nodes.flat()), torn };
}
const frame = (time, ...cloths) => ({ stamp: { time, epoch: 0 }, cloths, balls: [], obstacles: [] });

// Cloth 0 becomes coarser, then tears; cloth 3 comes late.
const FRAMES = [
  frame(2, cloth(0, 3, 3, 0)),
  frame(2.25, cloth(0, 3, 3, 0.5)),
  frame(2.5, cloth(0, 2, 3, 1), cloth(3, 2, 2, 5)),
  frame(3, cloth(0, 2, 3, 2, [1]), cloth(3, 2, 2, 6)),
];

/** `surfaces`: of the scene's first obstacles, where they have one. */
function byPython(frames, { scene, surfaces = [] } = {}) {
  const told = { scene, surfaces, frames: frames.map(({ stamp, cloths, balls, obstacles }) => (
    { ...stamp, balls, obstacles, cloths: cloths.map((each) => ({ ...each, positions: [...each.positions] })) })) };
  const { status, stderr } = spawnSync('/usr/bin/python3', [fileURLToPath(new URL('export_frames.py', import.meta.url)), folder],
    { input: JSON.stringify(told), encoding: 'utf8' });
  if (status !== 0) throw new RangeError(stderr);
  return { glb: new Uint8Array(readFileSync(join(folder, 'frames.glb'))), obj: readFileSync(join(folder, 'frame.obj'), 'utf8') };
}
const byJavaScript = (frames, { scene, surfaces = [] } = {}) => (
  { glb: glbBytes(frames, { scene, surfaces: new Map(surfaces.entries()) }), obj: objText(frames.at(-1)) });

/** What is seen of cloths at a time since the first frame, by name. */
const clothsAt = (gltf, time) => Object.fromEntries(seenAt(gltf, time).filter(({ name }) => name.startsWith('cloth')).map((mesh) =>
  [mesh.name.replace(/-frame.*/, ''), { positions: positionsOf(mesh), triangles: mesh.geometry.index.count / 3 }]));

// A sheet that tilts about z for 130 frames, a ball that is there in frames 10 to 19, a box that turns and rises, a plane that has no end.
const SLOPE = (i) => i / 100;
const LONG = Array.from({ length: 130 }, (_, i) => {
  const sheet = cloth(0, 3, 3, 0), turn = i * Math.PI / 260;
  sheet.positions = sheet.positions.map((value, at) => (at % 3 === 1 ? SLOPE(i) * sheet.positions[at - 1] : value));
  return { ...frame(i / 32, sheet),
    balls: i >= 10 && i < 20 ? [{ ball: 7, position: [i, 2, 0], radius: 0.5, motion: 'dynamic' }] : [],
    obstacles: i > 0 ? [{ obstacle: 1, position: [0, i / 8, 5], quaternion: [Math.cos(turn / 2), 0, Math.sin(turn / 2), 0] }] : [] };
});
const UPRIGHT = [1, 0, 0, 0];
const SCENE = {
  cloths: [{ cloth: 0, name: 'sheet' }],
  obstacles: [
    { shape: 'convex', position: [9, 0, 0], vertices: 4, triangles: 4, quaternion: UPRIGHT },
    { shape: 'box', position: [0, 0, 5], size: [1, 2, 3], quaternion: UPRIGHT },
    { shape: 'capsule', position: [-9, 0, 0], radius: 0.5, length: 2, quaternion: UPRIGHT },
    { shape: 'plane', position: [0, -1, 0], normal: [0, 1, 0] },
  ],
};
const TETRAHEDRON = { vertices: [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1], triangles: [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3] };

/** What a mesh encloses, m3, by its triangles as seen from outside: the sum of a . (b x c) / 6. */
function volumeOf(mesh) {
  const positions = positionsOf(mesh), { index } = mesh.geometry;
  const node = (i) => positions.slice(3 * index.getX(i), 3 * index.getX(i) + 3);
  let sum = 0;
  for (let i = 0; i < index.count; i += 3) {
    const [a, b, c] = [node(i), node(i + 1), node(i + 2)];
    sum += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return sum / 6;
}
const EDGES = 32, QUARTER = 8;  // of the clients' balls
/** A regular polygon in a circle. */
const polygon = (radius) => EDGES / 2 * radius ** 2 * Math.sin(2 * Math.PI / EDGES);
/** The clients' ball: frustums of polygons, each of height (A + B + sqrt(A B)) / 3. */
const ballVolume = (radius) => Array.from({ length: 2 * QUARTER }, (_, i) => {
  const [from, to] = [i, i + 1].map((ring) => ring * Math.PI / (2 * QUARTER));
  const [a, b] = [from, to].map((polar) => polygon(radius * Math.sin(polar)));
  return radius * (Math.cos(from) - Math.cos(to)) * (a + b + Math.sqrt(a * b)) / 3;
}).reduce((sum, part) => sum + part, 0);

const near = (found, expected, what) => {
  assert.equal(found.length, expected.length, what);
  found.forEach((value, i) => assert.ok(Math.abs(value - expected[i]) < 1e-5, `${what}: ${found} is not ${expected}`));
};

for (const [language, write] of [['JavaScript', byJavaScript], ['Python', byPython]]) {
  test(`${language}: a .glb is valid, and shows each frame at its time`, async () => {
    const { glb } = write(FRAMES);
    const gltf = await load(glb);
    for (const { stamp, cloths } of FRAMES) {
      const expected = Object.fromEntries(cloths.map(({ cloth: index, rows, cols, positions, torn }) => [`cloth-${index}`,
        { positions: [...positions], triangles: 2 * ((rows - 1) * (cols - 1) - torn.length) }]));
      assert.deepEqual(clothsAt(gltf, stamp.time - FRAMES[0].stamp.time), expected, `at ${stamp.time} s`);
    }
    // Half way between two frames of one mesh: (0 + 0.5) / 2 m.
    assert.equal(clothsAt(gltf, 0.125)['cloth-0'].positions[1], 0.25);
  });

  test(`${language}: a long .glb has each frame with its normals, and all bodies where they are`, async () => {
    const gltf = await load(write(LONG, { scene: SCENE, surfaces: [TETRAHEDRON] }).glb);
    for (const i of [0, 9, 10, 19, 20, 59, 60, 61, 119, 120, 129]) {
      const seen = Object.fromEntries(seenAt(gltf, LONG[i].stamp.time).map((mesh) => [mesh.name.replace(/-frame.*/, ''), mesh]));
      const bodies = ['obstacle-0', 'obstacle-1', 'obstacle-2', 'sheet'];  // the plane is left out
      assert.deepEqual(Object.keys(seen).sort(), i >= 10 && i < 20 ? ['ball-7', ...bodies] : bodies, `frame ${i}`);
      const { sheet } = seen;
      near(positionsOf(sheet), [...LONG[i].cloths[0].positions], `sheet in frame ${i}`);
      const normal = [0, 1, 2].map((axis) => sheet.geometry.attributes.normal.getComponent(4, axis) +
        sheet.morphTargetInfluences.reduce((sum, weight, k) => sum + weight * sheet.geometry.morphAttributes.normal[k].getComponent(4, axis), 0));
      near(normal, [-SLOPE(i), 1, 0].map((value) => value / Math.hypot(SLOPE(i), 1)), `normal in frame ${i}`);  // of y = slope x
      const box = seen['obstacle-1'], turn = i * Math.PI / 260;
      near(box.position.toArray(), [0, i / 8, 5], `box in frame ${i}`);
      near(box.quaternion.toArray(), [0, Math.sin(turn / 2), 0, Math.cos(turn / 2)], `box in frame ${i}`);
      if (seen['ball-7']) near(seen['ball-7'].position.toArray(), [i, 2, 0], `ball in frame ${i}`);
    }
    const volumes = Object.fromEntries(seenAt(gltf, LONG[10].stamp.time).map((mesh) => [mesh.name, volumeOf(mesh)]));
    const expected = { 'ball-7': ballVolume(0.5), 'obstacle-0': 1 / 6, 'obstacle-1': 6, 'obstacle-2': ballVolume(0.5) + 2 * polygon(0.5) };
    for (const [name, volume] of Object.entries(expected)) near([volumes[name]], [volume], `${name}, m3`);
  });

  test(`${language}: an .obj has each cloth's nodes and the faces that are not torn`, () => {
    assert.deepEqual(write(FRAMES).obj.split('\n'), [
      'o cloth-0', 'v 0 2 0', 'v 1 2 0', 'v 2 2 0', 'v 0 2 1', 'v 1 2 1', 'v 2 2 1', 'f 1 4 5 2',
      'o cloth-3', 'v 0 6 0', 'v 1 6 0', 'v 0 6 1', 'v 1 6 1', 'f 7 9 10 8', '']);
  });

  test(`${language}: a single frame, and one without a face, are valid`, async () => {
    for (const only of [frame(0, cloth(0, 2, 2, 1)), frame(0, cloth(0, 2, 2, 1, [0]))]) {
      await validate(write([only]).glb);
    }
  });

  test(`${language}: frames that make no animation are refused`, () => {
    assert.throws(() => write([]), /frames is empty; allowed: 1 or more/);
    assert.throws(() => write([FRAMES[1], FRAMES[0]]), /frames\[1\] is at 2 s; allowed: after 2.25 s/);
    assert.throws(() => write([FRAMES[0], { ...FRAMES[1], stamp: { time: 9, epoch: 1 } }]), /epoch/);
  });
}

test('positions from an origin near the cloth are written in the world', () => {
  assert.match(objText(frame(0, { ...cloth(0, 2, 2, 1), origin: [16, -32, 0] })), /^o cloth-0\nv 16 -31 0\n/);
});
