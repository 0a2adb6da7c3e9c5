/** Received frames as files: Wavefront .obj, animated .glb (glTF 2.0). Cloths alone are drawn; lengths in m, y up. */
import { Glb } from './glb.js';

/**
 * @typedef {import('./types.js').Cloth} Cloth
 * @typedef {import('./types.js').Frame} Frame
 */

/**
 * The text of an .obj file: one object `cloth-INDEX` a cloth, quads, torn faces left out.
 * @param {Frame} frame
 * @returns {string}
 */
export function objText(frame) {
  const lines = [];
  let before = 1;  // vertices count from 1 through the file
  for (const cloth of frame.cloths) {
    lines.push(`o cloth-${cloth.cloth}`);
    const positions = world(cloth);
    for (let i = 0; i < positions.length; i += 3) lines.push(`v ${positions[i]} ${positions[i + 1]} ${positions[i + 2]}`);
    for (const quad of quads(cloth)) lines.push(`f ${quad.map((node) => node + before).join(' ')}`);
    before += cloth.rows * cloth.cols;
  }
  return `${lines.join('\n')}\n`;
}

/**
 * The bytes of a .glb file, an animation that begins at 0 s: each cloth is a mesh with a morph target a frame, and another from where
 * its level or its tears change. Throws a RangeError unless there are frames, of one epoch, each later than the one before.
 * @param {Frame[]} frames
 * @returns {Uint8Array}
 */
export function glbBytes(frames) {
  const times = timesOf(frames), glb = new Glb();
  for (const index of new Set(frames.flatMap(({ cloths }) => cloths.map(({ cloth }) => cloth)))) {
    const shown = frames.map(({ cloths }) => cloths.find(({ cloth }) => cloth === index));
    for (let from = 0, to; from < shown.length; from = to) {
      const mesh = meshOf(shown[from]);
      for (to = from + 1; to < shown.length && meshOf(shown[to]) === mesh;) ++to;
      if (mesh) addSpan(glb, /** @type {Cloth[]} */ (shown.slice(from, to)), from, times);
    }
  }
  return glb.bytes();
}

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

/** Positions in the world, m. @param {Cloth} cloth */
const world = ({ positions, origin }) => positions.map((value, i) => value + origin[i % 3]);

/** Nodes of the faces that are drawn, counterclockwise with u to the right and v downwards. @param {Cloth} cloth */
function quads({ rows, cols, torn }) {
  const gone = new Set(torn), drawn = [];
  for (let face = 0; face < (rows - 1) * (cols - 1); ++face) {
    const node = face + Math.floor(face / (cols - 1));
    if (!gone.has(face)) drawn.push([node, node + cols, node + cols + 1, node + 1]);
  }
  return drawn;
}

/** What frames share that one mesh shows; none without a face. @param {Cloth | undefined} cloth */
const meshOf = (cloth) => (cloth && cloth.torn.length < (cloth.rows - 1) * (cloth.cols - 1)
  ? [cloth.rows, cloth.cols, ...cloth.torn].join() : undefined);

/** @param {Glb} glb @param {Cloth[]} cloths @param {number} from @param {number[]} times */
function addSpan(glb, cloths, from, times) {
  const [first, ...later] = cloths.map(world), to = from + cloths.length;
  const triangles = quads(cloths[0]).flatMap(([a, b, c, d]) => [a, b, c, a, c, d]);
  const node = glb.addNode(`cloth-${cloths[0].cloth}-frame-${from}`, {
    primitives: [{
      attributes: { POSITION: glb.add(first, 'VEC3') },
      indices: glb.add(Uint32Array.from(triangles), 'SCALAR'),
      material: 0,
      ...(later.length && { targets: later.map((positions) => (
        { POSITION: glb.add(positions.map((value, i) => value - first[i]), 'VEC3') })) }),
    }],
    ...(later.length && { weights: later.map(() => 0) }),
  });
  if (later.length) {
    const weights = cloths.flatMap((_, frame) => later.map((__, target) => (frame === target + 1 ? 1 : 0)));
    glb.animate(node, 'weights', 'LINEAR', times.slice(from, to), weights, 'SCALAR');
  }
  // Scaled to nothing before and after.
  const keys = [...(from > 0 ? [[0, 0]] : []), [from, 1], ...(to < times.length ? [[to, 0]] : [])];
  if (keys.length > 1) {
    glb.animate(node, 'scale', 'STEP', keys.map(([frame]) => times[frame]), keys.flatMap(([, scale]) => [scale, scale, scale]), 'VEC3');
  }
}
