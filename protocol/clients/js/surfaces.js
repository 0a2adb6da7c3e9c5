/** What is drawn as triangles: a cloth's faces, balls and the shapes of obstacles. Lengths in m. */

/**
 * @typedef {{positions: Float32Array, normals: Float32Array, triangles: Uint32Array}} Triangles x, y, z of each vertex and of its normal;
 *   three vertices a triangle, counterclockwise as seen from outside
 * @typedef {import('./types.js').Obstacle} Obstacle
 * @typedef {import('./types.js').Surface} Surface
 */

const AROUND = 32, QUARTER = 8;  // edges around a ball, and from its pole to its equator

/**
 * Nodes of a cloth's faces that are drawn, counterclockwise with u to the right and v downwards.
 * @param {{rows: number, cols: number, torn: number[]}} cloth
 */
export function quads({ rows, cols, torn }) {
  const gone = new Set(torn), drawn = [];
  for (let face = 0; face < (rows - 1) * (cols - 1); ++face) {
    const node = face + Math.floor(face / (cols - 1));
    if (!gone.has(face)) drawn.push([node, node + cols, node + cols + 1, node + 1]);
  }
  return drawn;
}

/**
 * Unit normals of vertices: the mean of their triangles', by area; upwards where no triangle has one.
 * @param {Float32Array} positions @param {Uint32Array} triangles
 */
export function normalsOf(positions, triangles) {
  const normals = new Float32Array(positions.length);
  for (let at = 0; at < triangles.length; at += 3) {
    const [a, b, c] = [3 * triangles[at], 3 * triangles[at + 1], 3 * triangles[at + 2]];
    const ux = positions[b] - positions[a], uy = positions[b + 1] - positions[a + 1], uz = positions[b + 2] - positions[a + 2];
    const vx = positions[c] - positions[a], vy = positions[c + 1] - positions[a + 1], vz = positions[c + 2] - positions[a + 2];
    const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
    for (const node of [a, b, c]) {
      normals[node] += x;
      normals[node + 1] += y;
      normals[node + 2] += z;
    }
  }
  for (let at = 0; at < normals.length; at += 3) {
    const length = Math.hypot(normals[at], normals[at + 1], normals[at + 2]);
    if (length > 0) for (let axis = 0; axis < 3; ++axis) normals[at + axis] /= length;
    else normals[at + 1] = 1;
  }
  return normals;
}

/** A ball of radius 1, m, around the origin. @returns {Triangles} */
export const unitBall = () => rounded(1, 0);

/**
 * An obstacle in its own axes; null for a plane, which has no end, for shapes that are not known, and meshes without a surface.
 * @param {Obstacle} obstacle @param {Surface} [surface] @returns {Triangles | null}
 */
export function trianglesOf(obstacle, surface) {
  switch (obstacle.shape) {
    case 'box': return box(obstacle.size);
    case 'capsule': return rounded(obstacle.radius, obstacle.length);
    case 'convex': return surface ? flat(surface) : null;
    case 'mesh': return surface ? smooth(Float32Array.from(surface.vertices), Uint32Array.from(surface.triangles)) : null;
    default: return null;
  }
}

/** @param {Float32Array} positions @param {Uint32Array} triangles @returns {Triangles} */
const smooth = (positions, triangles) => ({ positions, triangles, normals: normalsOf(positions, triangles) });

/** Each triangle with vertices of its own: edges stay sharp. @param {Surface} surface */
const flat = ({ vertices, triangles }) =>
  smooth(Float32Array.from(triangles.flatMap((node) => vertices.slice(3 * node, 3 * node + 3))), Uint32Array.from(triangles.keys()));

/** @param {import('./types.js').Vector} size */
function box(size) {
  const corners = [0, 1, 2, 3, 4, 5, 6, 7].flatMap((corner) => size.map((length, axis) => (corner >> axis & 1 ? length : -length) / 2));
  const sides = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
  return flat({ vertices: corners, triangles: sides.flatMap(([a, b, c, d]) => [a, b, c, a, c, d]) });
}

/** A ball, or one whose halves are `length` apart along y: a capsule. @param {number} radius @param {number} length @returns {Triangles} */
function rounded(radius, length) {
  /** @type {[number, number][]} angle from the pole, height of the centre */
  const rings = [];
  for (let i = 0; i <= QUARTER; ++i) rings.push([i * Math.PI / (2 * QUARTER), length / 2]);
  for (let i = length > 0 ? 0 : 1; i <= QUARTER; ++i) rings.push([(QUARTER + i) * Math.PI / (2 * QUARTER), -length / 2]);
  /** @type {number[]} */ const positions = [];
  /** @type {number[]} */ const normals = [];
  /** @type {number[]} */ const triangles = [];
  rings.forEach(([polar, centre], ring) => {
    for (let i = 0; i <= AROUND; ++i) {
      const turn = i * 2 * Math.PI / AROUND, out = Math.sin(polar);
      const normal = [out * Math.sin(turn), Math.cos(polar), out * Math.cos(turn)];
      normals.push(...normal);
      positions.push(radius * normal[0], centre + radius * normal[1], radius * normal[2]);
      if (ring === 0 || i === AROUND) continue;
      const below = ring * (AROUND + 1) + i, above = below - AROUND - 1;
      if (ring > 1) triangles.push(above, below, above + 1);
      if (ring < rings.length - 1) triangles.push(below, below + 1, above + 1);
    }
  });
  return { positions: Float32Array.from(positions), normals: Float32Array.from(normals), triangles: Uint32Array.from(triangles) };
}
