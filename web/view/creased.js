/**
 * A surface's triangles, each with corners of its own: a corner's normal is the mean of the faces that meet there and turn from its
 * own face by less than `crease`, so that round things look round and edges sharp; and each corner lies `inset` below the surface.
 * @param {number[]} vertices x, y, z of each @param {number[]} triangles three vertices each
 * @param {{crease?: number, inset?: number}} [options] rad; m
 * @returns {{positions: Float32Array, normals: Float32Array}}
 */
export function creased(vertices, triangles, {crease = 0.7, inset = 0} = {}) {
  const count = triangles.length / 3;
  const faces = new Float64Array(3 * count);  // as long as twice the triangle's area
  const around = new Map();                   // vertex: its faces
  for (let face = 0; face < count; ++face) {
    const [a, b, c] = [0, 1, 2].map((k) => 3 * triangles[3 * face + k]);
    const [ux, uy, uz, vx, vy, vz] = [b, c].flatMap((to) => [0, 1, 2].map((axis) => vertices[to + axis] - vertices[a + axis]));
    faces.set([uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx], 3 * face);
    for (let k = 0; k < 3; ++k) {
      const vertex = triangles[3 * face + k];
      if (!around.has(vertex)) around.set(vertex, []);
      around.get(vertex).push(face);
    }
  }
  const dot = (i, j) => faces[3 * i] * faces[3 * j] + faces[3 * i + 1] * faces[3 * j + 1] + faces[3 * i + 2] * faces[3 * j + 2];
  const mean = (which) => {
    const sum = [0, 1, 2].map((axis) => which.reduce((total, face) => total + faces[3 * face + axis], 0));
    const length = Math.hypot(...sum) || 1;
    return sum.map((x) => x / length);
  };
  const inward = new Map([...around].map(([vertex, all]) => [vertex, mean(all)]));
  const positions = new Float32Array(9 * count), normals = new Float32Array(9 * count);
  triangles.forEach((vertex, corner) => {
    const face = Math.floor(corner / 3);
    const smooth = around.get(vertex).filter(
      (other) => dot(face, other) >= Math.cos(crease) * Math.sqrt(dot(face, face) * dot(other, other)));
    normals.set(mean(smooth), 3 * corner);
    positions.set(inward.get(vertex).map((n, axis) => vertices[3 * vertex + axis] - inset * n), 3 * corner);
  });
  return {positions, normals};
}
