/** Received frames as files: Wavefront .obj and animated .glb (glTF 2.0) of all that a scene shows; lengths in m, y up. */
import { bodiesOf } from './body_meshes.js';
import { Glb } from './glb.js';
import { addBalls, addObstacles } from './glb_bodies.js';
import { normalsOf, quads } from './surfaces.js';

/**
 * @typedef {import('./types.js').Cloth} Cloth
 * @typedef {import('./types.js').Frame} Frame
 * @typedef {{png: Uint8Array, repeat: [number, number], roughness?: number}} Fabric a picture that is repeated so often along u and v,
 *   from the lower left corner on
 * @typedef {object} SceneOptions
 * @property {any} [scene] the `scene` message: cloths are called as there, and its obstacles are drawn
 * @property {import('./body_meshes.js').Surfaces} [surfaces] of those obstacles that are meshes, as `surface` tells them
 * @typedef {SceneOptions & {fabricOf?: (cloth: number) => Fabric | undefined}} GlbOptions fabricOf: what a cloth is made of
 */

const LONGEST = 60;  // frames that one mesh shows: programs give each of its targets a place on the graphics card

/**
 * The text of an .obj file: an object each cloth, of quads with texture coordinates (u, 1 - v), without those that are torn; then an
 * object each ball and, if `scene` tells of them, each obstacle, planes left out; all with normals.
 * @param {Frame} frame
 * @param {SceneOptions} [options]
 * @returns {string}
 */
export function objText(frame, { scene, surfaces = new Map() } = {}) {
  /** @type {string[]} */ const lines = [];
  let before = 1;  // vertices count from 1 through the file
  for (const cloth of frame.cloths) {
    const { positions, origin } = cloth;
    lines.push(`o ${nameOf(cloth.cloth, scene)}`);
    pushRows(lines, 'v', 3, Array.from(positions, (value, i) => value + origin[i % 3]));
    pushRows(lines, 'vt', 2, coordinates(cloth).map((value, i) => (i % 2 === 0 ? value : 1 - value)));
    pushRows(lines, 'vn', 3, normalsOf(positions, trianglesOf(cloth)));
    for (const quad of quads(cloth)) lines.push(`f ${quad.map((node) => Array(3).fill(node + before).join('/')).join(' ')}`);
    before += cloth.rows * cloth.cols;
  }
  for (const { name, shape: { positions, normals, triangles } } of bodiesOf(frame, scene?.obstacles ?? [], surfaces)) {
    lines.push(`o ${name}`);
    pushRows(lines, 'v', 3, positions);
    pushRows(lines, 'vn', 3, normals);
    for (let i = 0; i < triangles.length; i += 3) {
      lines.push(`f ${Array.from(triangles.subarray(i, i + 3), (node) => `${node + before}//${node + before}`).join(' ')}`);
    }
    before += positions.length / 3;
  }
  return `${lines.join('\n')}\n`;
}

/**
 * The bytes of a .glb file, an animation that begins at 0 s. A cloth is a mesh with a morph target a frame: one after another, each of 60
 * frames at most, and another from where its level or its tears change. Balls are nodes that move, and so are obstacles if `scene`
 * tells of them, planes left out. Throws a RangeError unless there are frames, of one epoch, each later than the one before.
 * @param {Frame[]} frames
 * @param {GlbOptions} [options]
 * @returns {Uint8Array}
 */
export function glbBytes(frames, { scene, surfaces = new Map(), fabricOf = () => undefined } = {}) {
  const times = timesOf(frames), glb = new Glb();
  const plain = glb.addMaterial({ doubleSided: true, pbrMetallicRoughness: { metallicFactor: 0 } });
  const wear = tailor(glb, fabricOf, plain);
  for (const index of new Set(frames.flatMap(({ cloths }) => cloths.map(({ cloth }) => cloth)))) {
    const shown = frames.map(({ cloths }) => cloths.find(({ cloth }) => cloth === index));
    const name = nameOf(index, scene);
    for (let from = 0, to; from < shown.length; from = to) {
      const mesh = meshOf(shown[from]);
      for (to = from + 1; to < shown.length && to - from < LONGEST && meshOf(shown[to]) === mesh;) ++to;
      if (!mesh) continue;
      // The next mesh takes over at its own first frame, and this one has to be there by then.
      const goesOn = to < shown.length && meshOf(shown[to]) === mesh ? 1 : 0;
      addSpan(glb, { name, cloths: /** @type {Cloth[]} */ (shown.slice(from, to + goesOn)), from, to, times, ...wear(index) });
    }
  }
  addBalls(glb, frames, times);
  addObstacles(glb, frames, times, scene?.obstacles ?? [], surfaces);
  return glb.bytes();
}

/** As the scene calls it, else by its place. @param {number} cloth @param {any} scene @returns {string} */
const nameOf = (cloth, scene) => scene?.cloths.find((/** @type {any} */ told) => told.cloth === cloth)?.name || `cloth-${cloth}`;

/** @param {Cloth} cloth */
const trianglesOf = (cloth) => Uint32Array.from(quads(cloth).flatMap(([a, b, c, d]) => [a, b, c, a, c, d]));

/** Lines of `size` numbers each. @param {string[]} lines @param {string} keyword @param {number} size @param {ArrayLike<number>} values */
function pushRows(lines, keyword, size, values) {
  for (let i = 0; i < values.length; i += size) {
    let line = keyword;
    for (let k = i; k < i + size; ++k) line += ` ${digits(values[k])}`;
    lines.push(line);
  }
}

/** Nine digits read back to the same float; what is no float, far from the world's origin, has all of its digits. @param {number} value */
const digits = (value) => (Math.fround(value) === value ? Number(value.toPrecision(9)) : value);

/** Since the first frame, s. @param {Frame[]} frames */
function timesOf(frames) {
  if (frames.length === 0) throw new RangeError('frames is empty; allowed: 1 or more');
  frames.slice(1).forEach(({ stamp }, i) => {
    const { epoch, time } = frames[i].stamp;
    if (stamp.epoch !== epoch) throw new RangeError(`frames[${i + 1}] is of epoch ${stamp.epoch}; allowed: ${epoch}, as the others`);
    if (!(stamp.time > time)) throw new RangeError(`frames[${i + 1}] is at ${stamp.time} s; allowed: after ${time} s`);
  });
  return frames.map(({ stamp }) => stamp.time - frames[0].stamp.time);
}

/**
 * Gives a cloth its material and how often that repeats; the same picture is stored once.
 * @param {Glb} glb @param {(cloth: number) => Fabric | undefined} fabricOf @param {number} plain
 */
function tailor(glb, fabricOf, plain) {
  /** @type {Map<Uint8Array, number>} */
  const made = new Map();
  return (/** @type {number} */ cloth) => {
    const fabric = fabricOf(cloth);
    if (!fabric) return { material: plain };
    const { png, repeat, roughness = 0.92 } = fabric;
    if (!made.has(png)) {
      made.set(png, glb.addMaterial({ name: 'fabric', doubleSided: true,
        pbrMetallicRoughness: { baseColorTexture: { index: glb.addTexture(png) }, metallicFactor: 0, roughnessFactor: roughness } }));
    }
    return { material: made.get(png), repeat };
  };
}

/** What frames share that one mesh shows; none without a face. @param {Cloth | undefined} cloth */
const meshOf = (cloth) => (cloth && cloth.torn.length < (cloth.rows - 1) * (cloth.cols - 1)
  ? [cloth.rows, cloth.cols, ...cloth.origin, ...cloth.torn].join() : undefined);

/**
 * @param {Glb} glb
 * @param {{name: string, cloths: Cloth[], from: number, to: number, times: number[], material?: number, repeat?: [number, number]}} span
 *   shown from frame `from` until frame `to`
 */
function addSpan(glb, { name, cloths, from, to, times, material, repeat }) {
  const triangles = trianglesOf(cloths[0]);
  const [first, ...later] = cloths.map(({ positions }) => ({ positions, normals: normalsOf(positions, triangles) }));
  const add = (/** @type {Float32Array} */ values) => glb.add(values, 'VEC3');
  const since = (/** @type {'positions'|'normals'} */ what) => (/** @type {typeof first} */ frame) =>
    add(frame[what].map((value, i) => value - first[what][i]));
  const [positions, normals] = [later.map(since('positions')), later.map(since('normals'))];
  const mesh = glb.addMesh({
    name,
    primitives: [{
      attributes: { POSITION: add(first.positions), NORMAL: add(first.normals), TEXCOORD_0: glb.add(coordinates(cloths[0], repeat), 'VEC2') },
      indices: glb.add(triangles, 'SCALAR'),
      material,
      ...(later.length && { targets: later.map((_, i) => ({ POSITION: positions[i], NORMAL: normals[i] })) }),
    }],
    ...(later.length && { weights: later.map(() => 0) }),
  });
  const whole = from === 0 && to === times.length;
  const node = glb.addNode({ name: whole ? name : `${name}-frame-${from}`, mesh, translation: cloths[0].origin });
  if (later.length) {
    const weights = cloths.flatMap((_, frame) => later.map((__, target) => (frame === target + 1 ? 1 : 0)));
    glb.animate(node, 'weights', 'LINEAR', times.slice(from, from + cloths.length), weights, 'SCALAR');
  }
  // Scaled to nothing before and after.
  const keys = [...(from > 0 ? [[0, 0]] : []), [from, 1], ...(to < times.length ? [[to, 0]] : [])];
  if (keys.length > 1) {
    glb.animate(node, 'scale', 'STEP', keys.map(([frame]) => times[frame]), keys.flatMap(([, scale]) => [scale, scale, scale]), 'VEC3');
  }
}

/** Where on the picture each node is; its upper left corner is (0, 0). @param {Cloth} cloth @param {[number, number]} [repeat] */
const coordinates = ({ rows, cols }, [across, up] = [1, 1]) => Float32Array.from({ length: 2 * rows * cols }, (_, i) => {
  const node = i >> 1, u = (node % cols) / (cols - 1), v = Math.floor(node / cols) / (rows - 1);
  return i % 2 === 0 ? u * across : 1 - (1 - v) * up;
});
