/** Balls and obstacles of frames as nodes of a .glb that move. */
import { ballName, poseOf, shapesOf } from './body_meshes.js';
import { unitBall } from './surfaces.js';

/**
 * @typedef {import('./glb.js').Glb} Glb
 * @typedef {import('./types.js').Frame} Frame
 * @typedef {import('./types.js').Obstacle} Obstacle
 */

const BALL = [0.75, 0.11, 0.1, 1], SOLID = [0.48, 0.44, 0.38, 1];  // linear red, green, blue, opacity

/** @param {Glb} glb @param {string} name @param {import('./surfaces.js').Triangles} shape @param {number[]} colour */
function addShape(glb, name, { positions, normals, triangles }, colour) {
  return glb.addMesh({ name, primitives: [{
    attributes: { POSITION: glb.add(positions, 'VEC3'), NORMAL: glb.add(normals, 'VEC3') },
    indices: glb.add(triangles, 'SCALAR'),
    material: glb.addMaterial({ name, pbrMetallicRoughness: { baseColorFactor: colour, metallicFactor: 0 } }),
  }] });
}

/** @param {number[][]} values */
const differ = (values) => values.some((value) => value.some((each, i) => each !== values[0][i]));

/**
 * Each as `ball-ID`: of no size in frames that do not have it.
 * @param {Glb} glb @param {Frame[]} frames @param {number[]} times
 */
export function addBalls(glb, frames, times) {
  const ids = new Set(frames.flatMap(({ balls }) => balls.map(({ ball }) => ball)));
  if (ids.size === 0) return;
  const mesh = addShape(glb, 'ball', unitBall(), BALL);
  for (const id of ids) {
    const shown = frames.map(({ balls }) => balls.find(({ ball }) => ball === id));
    let last = /** @type {import('./types.js').Ball} */ (shown.find(Boolean));  // where it is before it comes, and stays when it is gone
    const places = shown.map((ball) => [...(last = ball ?? last).position]);
    const sizes = shown.map((ball) => Array(3).fill(ball?.radius ?? 0));
    const node = glb.addNode({ name: ballName(id), mesh, translation: places[0], scale: sizes[0] });
    if (differ(places)) glb.animate(node, 'translation', 'LINEAR', times, places.flat(), 'VEC3');
    if (differ(sizes)) glb.animate(node, 'scale', 'STEP', times, sizes.flat(), 'VEC3');
  }
}

/**
 * Each as `obstacle-INDEX`, by its place in the scene.
 * @param {Glb} glb @param {Frame[]} frames @param {number[]} times
 * @param {Obstacle[]} obstacles @param {import('./body_meshes.js').Surfaces} surfaces
 */
export function addObstacles(glb, frames, times, obstacles, surfaces) {
  for (const { index, name, home, shape } of shapesOf(obstacles, surfaces)) {
    const poses = frames.map((frame) => poseOf(index, home, frame));
    const places = poses.map(({ position }) => [...position]);
    const turns = poses.map(({ turn: [w, x, y, z] }) => [x, y, z, w]);
    const node = glb.addNode({ name, mesh: addShape(glb, name, shape, SOLID), translation: places[0], rotation: turns[0] });
    if (differ(places)) glb.animate(node, 'translation', 'LINEAR', times, places.flat(), 'VEC3');
    if (differ(turns)) glb.animate(node, 'rotation', 'LINEAR', times, turns.flat(), 'VEC4');
  }
}
