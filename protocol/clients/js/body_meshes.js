/** Balls and obstacles of a frame, as files show them: their names, where they are, and their triangles there. */
import { trianglesOf, unitBall } from './surfaces.js';

/**
 * @typedef {import('./types.js').Frame} Frame
 * @typedef {import('./types.js').Obstacle} Obstacle
 * @typedef {import('./types.js').Vector} Vector
 * @typedef {import('./surfaces.js').Triangles} Triangles
 * @typedef {[number, number, number, number]} Turn w, x, y, z
 * @typedef {Exclude<Obstacle, import('./types.js').Plane>} Solid
 * @typedef {Map<number, import('./types.js').Surface>} Surfaces of those obstacles that are meshes, by their place in the scene
 */

/** @param {number} ball */
export const ballName = (ball) => `ball-${ball}`;

/**
 * Each obstacle that can be drawn, with its place in the scene, its name and its triangles in its own axes: no plane, no mesh without a
 * surface.
 * @param {Obstacle[]} obstacles @param {Surfaces} surfaces
 * @returns {{index: number, name: string, home: Solid, shape: Triangles}[]}
 */
export const shapesOf = (obstacles, surfaces) => obstacles.flatMap((home, index) => {
  const shape = trianglesOf(home, surfaces.get(index));
  return shape && 'quaternion' in home ? [{ index, name: `obstacle-${index}`, home, shape }] : [];
});

/**
 * Where an obstacle is in a frame, which tells of those that are not where the scene has them.
 * @param {number} index @param {Solid} home @param {Frame} frame
 * @returns {{position: Vector, turn: Turn}}
 */
export function poseOf(index, home, frame) {
  const { position, quaternion } = frame.obstacles.find(({ obstacle }) => obstacle === index) ?? home;
  const length = Math.hypot(...quaternion);  // sent as floats, it is one to seven digits
  return { position, turn: /** @type {Turn} */ (quaternion.map((part) => part / length)) };
}

/**
 * Each ball and each obstacle that can be drawn: its name and its triangles in the world.
 * @param {Frame} frame @param {Obstacle[]} obstacles @param {Surfaces} surfaces
 * @returns {{name: string, shape: Triangles}[]}
 */
export const bodiesOf = (frame, obstacles, surfaces) => [
  ...frame.balls.map(({ ball, position, radius }) => (
    { name: ballName(ball), shape: placed(unitBall(), { position, turn: [1, 0, 0, 0] }, radius) })),
  ...shapesOf(obstacles, surfaces).map(({ index, name, home, shape }) => ({ name, shape: placed(shape, poseOf(index, home, frame)) })),
];

/** @param {Triangles} shape @param {{position: Vector, turn: Turn}} pose @returns {Triangles} */
function placed({ positions, normals, triangles }, { position, turn }, scale = 1) {
  return { positions: moved(positions, turn, scale, position), normals: moved(normals, turn, 1, [0, 0, 0]), triangles };
}

/**
 * v + 2 (w u + q x u) of each, where u = q x v and q is the quaternion's vector; scaled and shifted.
 * @param {Float32Array} vectors @param {Turn} turn @param {number} scale @param {Vector} shift
 */
function moved(vectors, [w, ...q], scale, shift) {
  const result = new Float32Array(vectors.length);
  for (let at = 0; at < vectors.length; at += 3) {
    /** @type {Vector} */ const v = [vectors[at], vectors[at + 1], vectors[at + 2]];
    const u = cross(q, v), qu = cross(q, u);
    for (let axis = 0; axis < 3; ++axis) result[at + axis] = shift[axis] + scale * (v[axis] + 2 * (w * u[axis] + qu[axis]));
  }
  return result;
}

/** @param {Vector} a @param {Vector} b @returns {Vector} */
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
