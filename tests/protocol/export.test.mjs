// Animated .glb files that both clients make of frames, by Khronos' validator and three.js, which shows the frames again.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { ballVolume, CLIENTS, cloth, frame, polygon, TETRAHEDRON, UPRIGHT, volumeWithin } from './exporting.mjs';
import { load, positionsOf, seenAt, validate } from './gltf.mjs';

// Cloth 0 becomes coarser, then tears; cloth 3 comes late.
const FRAMES = [
  frame(2, cloth(0, 3, 3, 0)),
  frame(2.25, cloth(0, 3, 3, 0.5)),
  frame(2.5, cloth(0, 2, 3, 1), cloth(3, 2, 2, 5)),
  frame(3, cloth(0, 2, 3, 2, [1]), cloth(3, 2, 2, 6)),
];

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
const SCENE = {
  cloths: [{ cloth: 0, name: 'sheet' }],
  obstacles: [
    { shape: 'convex', position: [9, 0, 0], vertices: 4, triangles: 4, quaternion: UPRIGHT },
    { shape: 'box', position: [0, 0, 5], size: [1, 2, 3], quaternion: UPRIGHT },
    { shape: 'capsule', position: [-9, 0, 0], radius: 0.5, length: 2, quaternion: UPRIGHT },
    { shape: 'plane', position: [0, -1, 0], normal: [0, 1, 0] },
  ],
};

/** What a mesh encloses, m3. */
function volumeOf(mesh) {
  const positions = positionsOf(mesh);
  return volumeWithin(Array.from(mesh.geometry.index.array, (node) => positions.slice(3 * node, 3 * node + 3)).flat());
}

const near = (found, expected, what) => {
  assert.equal(found.length, expected.length, what);
  found.forEach((value, i) => assert.ok(Math.abs(value - expected[i]) < 1e-5, `${what}: ${found} is not ${expected}`));
};

for (const [language, write] of CLIENTS) {
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
