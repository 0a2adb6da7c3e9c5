// .obj files that both clients make of a frame: line by line, by the geometry of what is in them, and by three.js.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { OBJLoader } from 'three/addons/loaders/OBJLoader.js';
import { objText } from '../../protocol/clients/js/weft.js';
import { ballVolume, CLIENTS, cloth, frame, polygon, TETRAHEDRON, UPRIGHT, volumeWithin } from './exporting.mjs';

const NEAR = 1e-6;  // m: floats up to 8 m are exact to half of it

// A quarter turn about y takes x to -z and z to x, one about z takes x to y and y to -x; told as floats are, to seven digits.
const HALF = 0.7071068;
const ABOUT_Y = [HALF, 0, HALF, 0], ABOUT_Z = [HALF, 0, 0, HALF];

// A cloth with a hole, two balls, and an obstacle of each shape: the box has moved, the others are where the scene has them.
const SCENE = {
  cloths: [{ cloth: 0, name: 'sheet' }, { cloth: 2, name: '' }],
  obstacles: [
    { shape: 'plane', position: [0, -1, 0], normal: [0, 1, 0] },
    { shape: 'box', position: [0, 0, 0], size: [1, 2, 3], quaternion: UPRIGHT },
    { shape: 'capsule', position: [-3, 1, 2], radius: 0.5, length: 2, quaternion: ABOUT_Z },
    { shape: 'convex', position: [1, 2, 3], vertices: 4, triangles: 4, quaternion: ABOUT_Y },
    { shape: 'mesh', position: [-1, 2, 5], vertices: 4, triangles: 4, quaternion: UPRIGHT },
    { shape: 'mesh', position: [0, 0, 0], vertices: 4, triangles: 4, quaternion: UPRIGHT },  // nobody has asked for its surface
    { shape: 'torus', position: [0, 0, 0], quaternion: UPRIGHT },  // of a later server
  ],
};
const SURFACES = [null, null, null, TETRAHEDRON, TETRAHEDRON];
const BALLS = [
  { ball: 3, position: [1, 2, -3], radius: 0.25, motion: 'dynamic' },
  { ball: 11, position: [-4, 0.5, 2], radius: 1.5, motion: 'kinematic' },
];
const FULL = { ...frame(0, cloth(0, 3, 4, 1, [2]), cloth(2, 2, 2, 5)), balls: BALLS,
  obstacles: [{ obstacle: 1, position: [5, 6, 7], quaternion: ABOUT_Y }] };
const BODIES = ['ball-3', 'ball-11', 'obstacle-1', 'obstacle-2', 'obstacle-3', 'obstacle-4'];

/**
 * The objects of a file, in order: `v`, `vt` and `vn`, rows of numbers, and `f`, corners as [v, vt, vn], counted from 0 in the object;
 * fails where a face has a corner that is not its own object's.
 */
function objectsOf(text) {
  assert.ok(text.endsWith('\n') && !text.endsWith('\n\n'));
  const objects = [], total = { v: 0, vt: 0, vn: 0 };
  let before;
  for (const line of text.trimEnd().split('\n')) {
    const [keyword, ...words] = line.split(' ');
    if (keyword === 'o') {
      before = { ...total };
      objects.push({ name: words.join(' '), v: [], vt: [], vn: [], f: [] });
    } else if (keyword === 'f') {
      objects.at(-1).f.push(words.map((word) => word.split('/').map((number, i) => number && number - 1 - before[['v', 'vt', 'vn'][i]])));
    } else {
      objects.at(-1)[keyword].push(words.map(Number));
      ++total[keyword];
    }
  }
  for (const { name, f, ...counted } of objects) {
    for (const corner of f.flat()) {
      corner.forEach((index, i) => assert.ok(index === '' || (index >= 0 && index < counted[['v', 'vt', 'vn'][i]].length), `${name}: ${corner}`));
    }
  }
  return objects;
}

const minus = (a, b) => a.map((value, i) => value - b[i]);
const length = (a) => Math.hypot(...a);
const close = (a, b) => length(minus(a, b)) < NEAR;
const near = (found, expected, what) => assert.ok(Math.abs(found - expected) < NEAR, `${what}: ${found} is not ${expected}`);
/** Each expected place is among those found, and each found among the expected. */
function samePlaces(found, expected, what) {
  for (const place of expected) assert.ok(found.some((each) => close(each, place)), `${what}: none at ${place}`);
  for (const place of found) assert.ok(expected.some((each) => close(each, place)), `${what}: one at ${place}`);
}
const volumeOf = ({ v, f }) => volumeWithin(f.flatMap((corners) => corners.flatMap(([node]) => v[node])));

for (const [language, write] of CLIENTS) {
  test(`${language}: an .obj has each cloth's nodes, coordinates and normals, and the faces that are not torn`, () => {
    const { obj } = write([frame(0, cloth(0, 2, 3, 2, [1]), cloth(3, 2, 2, 0.1))]);
    assert.deepEqual(obj.split('\n'), [
      'o cloth-0', 'v 0 2 0', 'v 1 2 0', 'v 2 2 0', 'v 0 2 1', 'v 1 2 1', 'v 2 2 1',
      'vt 0 1', 'vt 0.5 1', 'vt 1 1', 'vt 0 0', 'vt 0.5 0', 'vt 1 0', ...Array(6).fill('vn 0 1 0'), 'f 1/1/1 4/4/4 5/5/5 2/2/2',
      'o cloth-3', 'v 0 0.100000001 0', 'v 1 0.100000001 0', 'v 0 0.100000001 1', 'v 1 0.100000001 1',
      'vt 0 1', 'vt 1 1', 'vt 0 0', 'vt 1 0', ...Array(4).fill('vn 0 1 0'), 'f 7/7/7 9/9/9 10/10/10 8/8/8', '']);
  });

  test(`${language}: without the scene an .obj has cloths and balls`, () => {
    assert.deepEqual(objectsOf(write([FULL]).obj).map(({ name }) => name), ['cloth-0', 'cloth-2', 'ball-3', 'ball-11']);
  });

  test(`${language}: an .obj has each body where it is, by its geometry`, () => {
    const objects = objectsOf(write([FULL], { scene: SCENE, surfaces: SURFACES }).obj);
    assert.deepEqual(objects.map(({ name }) => name), ['sheet', 'cloth-2', ...BODIES]);
    const [sheet, , ...bodies] = objects, named = Object.fromEntries(bodies.map((each) => [each.name, each]));
    assert.deepEqual([sheet.v.length, sheet.vt.length, sheet.vn.length, sheet.f.length], [12, 12, 12, 5]);

    for (const { name, v, vt, vn, f } of bodies) {
      assert.equal(vt.length, 0);
      assert.equal(vn.length, v.length, name);
      for (const normal of vn) near(length(normal), 1, `${name}: a normal's length`);
      assert.ok(f.every((corners) => corners.length === 3 && corners.every(([node, , normal]) => node === normal)), name);
      const shown = new Set(f.flat().map(([node]) => node)).size;
      assert.ok(shown >= v.length - 2, `${name}: ${shown} of ${v.length}`);  // at each pole of a ball one of 33 is in no face
    }
    for (const { ball, position, radius } of BALLS) {
      const { name, v, vn } = named[`ball-${ball}`];
      v.forEach((place, i) => {
        near(length(minus(place, position)), radius, name);
        assert.ok(close(vn[i], minus(place, position).map((part) => part / radius)), `${name}: ${vn[i]}`);
      });
      assert.ok(Math.abs(volumeOf(named[name]) - ballVolume(radius)) < 1e-5, name);
    }

    // 1, 2, 3 m along x, y, z, turned: 3, 2, 1 m, about (5, 6, 7).
    const box = named['obstacle-1'], signs = [-1, 1];
    const corners = signs.flatMap((x) => signs.flatMap((y) => signs.map((z) => [5 + x * 1.5, 6 + y, 7 + z * 0.5])));
    samePlaces(box.v, corners, 'box');
    assert.ok(Math.abs(volumeOf(box) - 6) < 1e-5);
    const sides = box.vn.map((normal) => normal.findIndex((part) => Math.abs(part) > 0.5));
    box.vn.forEach((normal, i) => {
      const out = [0, 0, 0];
      out[sides[i]] = Math.sign(box.v[i][sides[i]] - [5, 6, 7][sides[i]]);
      assert.ok(close(normal, out), `box: ${normal} at ${box.v[i]}`);
    });

    // Its stretch of 2 m lies along x, about (-3, 1, 2).
    const capsule = named['obstacle-2'];
    for (const [x, y, z] of capsule.v) {
      const along = Math.min(Math.max(x, -4), -2);
      near(Math.hypot(x - along, y - 1, z - 2), 0.5, 'capsule');
    }
    const ends = capsule.v.map(([x]) => x);
    near(Math.min(...ends), -4.5, 'capsule');
    near(Math.max(...ends), -1.5, 'capsule');
    assert.ok(Math.abs(volumeOf(capsule) - ballVolume(0.5) - 2 * polygon(0.5)) < 1e-5);

    // (x, y, z) is at (z, y, -x) of (1, 2, 3).
    samePlaces(named['obstacle-3'].v, [[1, 2, 3], [1, 2, 2], [1, 3, 3], [2, 2, 3]], 'convex');
    samePlaces(named['obstacle-3'].vn, [[-1, 0, 0], [0, -1, 0], [0, 0, 1], [1, 1, -1].map((part) => part / Math.sqrt(3))], 'convex');
    samePlaces(named['obstacle-4'].v, [[-1, 2, 5], [0, 2, 5], [-1, 3, 5], [-1, 2, 6]], 'mesh');
    for (const name of ['obstacle-3', 'obstacle-4']) assert.ok(Math.abs(volumeOf(named[name]) - 1 / 6) < 1e-5, name);
  });

  test(`${language}: three.js reads an .obj as the objects, faces and normals that it has`, () => {
    const { obj } = write([FULL], { scene: SCENE, surfaces: SURFACES });
    const objects = objectsOf(obj), read = new OBJLoader().parse(obj).children;
    assert.deepEqual(read.map(({ name }) => name), ['sheet', 'cloth-2', ...BODIES]);
    read.forEach(({ name, geometry: { attributes } }, i) => {
      const { v, vn, vt, f } = objects[i];
      const corners = f.flatMap((face) => face.slice(2).flatMap((_, k) => [face[0], face[k + 1], face[k + 2]]));
      assert.deepEqual([...attributes.position.array], [...Float32Array.from(corners.flatMap(([node]) => v[node]))], name);
      assert.deepEqual([...attributes.normal.array], [...Float32Array.from(corners.flatMap(([, , normal]) => vn[normal]))], name);
      if (vt.length) assert.deepEqual([...attributes.uv.array], [...Float32Array.from(corners.flatMap(([, at]) => vt[at]))], name);
    });
  });

  test(`${language}: an .obj of no cloth, and of one without a face, can be read`, () => {
    assert.deepEqual(objectsOf(write([{ ...frame(0), balls: BALLS }]).obj).map(({ name }) => name), ['ball-3', 'ball-11']);
    assert.deepEqual(objectsOf(write([frame(0, cloth(0, 2, 2, 1, [0]))]).obj).map(({ v, f }) => [v.length, f.length]), [[4, 0]]);
  });
}

test('positions from an origin near the cloth are written in the world, as exact as they are from there', () => {
  assert.match(objText(frame(0, { ...cloth(0, 2, 2, 1), origin: [16, -32, 0] })), /^o cloth-0\nv 16 -31 0\n/);
  const far = objectsOf(objText(frame(0, { ...cloth(0, 2, 2, 0.1), origin: [0, 1e6, 0] })));
  near(far[0].v[0][1] - 1e6, 0.1, 'y');  // a float has 1/16 m there
});
