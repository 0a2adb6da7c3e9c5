/**
 * Arithmetic on a cloth's grid of nodes. Positions are x, y, z by node, row by row; row 0 is the top edge, column 0 is u = 0
 * (protocol/PROTOCOL.md, section 4).
 */

/** Two triangles a cell that is not torn, counter-clockwise seen from the side the cloth's face normal points to. */
export function triangleIndices(rows, cols, torn = new Set()) {
  const indices = new Uint32Array((rows - 1) * (cols - 1) * 6);
  let at = 0;
  for (let r = 0; r + 1 < rows; ++r) {
    for (let c = 0; c + 1 < cols; ++c) {
      if (torn.has(r * (cols - 1) + c)) continue;
      const a = r * cols + c;
      const below = a + cols;
      indices.set([a, below, a + 1, a + 1, below, below + 1], at);
      at += 6;
    }
  }
  return indices.subarray(0, at);
}

/**
 * The torn faces of a record, as those of the same sheet on a grid of `rows`, its own or a finer one.
 * @param {{torn: number[], rows: number, cols: number}} record
 */
export function tornOn({torn, rows: ownRows, cols: ownCols}, rows) {
  const parts = (rows - 1) / (ownRows - 1), cols = (ownCols - 1) * parts;
  const faces = new Set();
  for (const face of torn) {
    const row = Math.floor(face / (ownCols - 1)) * parts, col = (face % (ownCols - 1)) * parts;
    for (let r = row; r < row + parts; ++r) {
      for (let c = col; c < col + parts; ++c) faces.add(r * cols + c);
    }
  }
  return faces;
}

/** The sides of the cells that are not torn, without the triangles' diagonals: what the wireframe draws. */
export function sideIndices(rows, cols, torn = new Set()) {
  const whole = (r, c) => r >= 0 && c >= 0 && r + 1 < rows && c + 1 < cols && !torn.has(r * (cols - 1) + c);
  const indices = new Uint32Array(2 * (rows * (cols - 1) + cols * (rows - 1)));
  let at = 0;
  for (let r = 0; r < rows; ++r) {
    for (let c = 0; c < cols; ++c) {
      const a = r * cols + c;
      if (whole(r - 1, c) || whole(r, c)) indices.set([a, a + 1], at), (at += 2);
      if (whole(r, c - 1) || whole(r, c)) indices.set([a, a + cols], at), (at += 2);
    }
  }
  return indices.subarray(0, at);
}

/** Texture coordinates in metres of cloth at rest, so that threads keep their width whatever the cloth's size and level. */
export function materialCoordinates(rows, cols, width, height) {
  const uv = new Float32Array(rows * cols * 2);
  for (let r = 0, at = 0; r < rows; ++r) {
    for (let c = 0; c < cols; ++c) {
      uv[at++] = (c / (cols - 1)) * width;
      uv[at++] = (1 - r / (rows - 1)) * height;
    }
  }
  return uv;
}

/**
 * Unit normals by central differences along the grid, one-sided at its edges; of the faces around where the nodes on both sides of
 * one are sewn together, as at the tip of a fold. Writes into `normals`.
 */
export function gridNormals(positions, rows, cols, normals) {
  const stride = cols * 3;
  for (let r = 0; r < rows; ++r) {
    const up = r > 0 ? -stride : 0;
    const down = r + 1 < rows ? stride : 0;
    for (let c = 0; c < cols; ++c) {
      const at = r * stride + c * 3;
      const left = at - (c > 0 ? 3 : 0);
      const right = at + (c + 1 < cols ? 3 : 0);
      const ux = positions[right] - positions[left];
      const uy = positions[right + 1] - positions[left + 1];
      const uz = positions[right + 2] - positions[left + 2];
      const vx = positions[at + up] - positions[at + down];
      const vy = positions[at + up + 1] - positions[at + down + 1];
      const vz = positions[at + up + 2] - positions[at + down + 2];
      normals[at] = uy * vz - uz * vy;
      normals[at + 1] = uz * vx - ux * vz;
      normals[at + 2] = ux * vy - uy * vx;
      if (!unify(normals, at)) addFacesAround(positions, rows, cols, r, c, normals), unify(normals, at);
    }
  }
  return normals;
}

/** Makes the vector at `at` as long as 1; false if it is 0. */
function unify(vectors, at) {
  const length = Math.hypot(vectors[at], vectors[at + 1], vectors[at + 2]);
  if (length > 0) for (let axis = 0; axis < 3; ++axis) vectors[at + axis] /= length;
  return length > 0;
}

/** Adds to each node in `corners` the normal, as long as twice its area, of the face that begins at row r, column c. */
function addFace(positions, cols, r, c, corners, normals) {
  const a = 3 * (r * cols + c), right = a + 3, below = a + 3 * cols, across = below + 3;
  const [ux, uy, uz] = [0, 1, 2].map((axis) => positions[right + axis] - positions[below + axis]);
  const [vx, vy, vz] = [0, 1, 2].map((axis) => positions[a + axis] - positions[across + axis]);
  for (const corner of corners) {
    normals[corner] += uy * vz - uz * vy;
    normals[corner + 1] += uz * vx - ux * vz;
    normals[corner + 2] += ux * vy - uy * vx;
  }
}

function addFacesAround(positions, rows, cols, r, c, normals) {
  for (let row = Math.max(r - 1, 0); row <= Math.min(r, rows - 2); ++row) {
    for (let col = Math.max(c - 1, 0); col <= Math.min(c, cols - 2); ++col) {
      addFace(positions, cols, row, col, [3 * (r * cols + c)], normals);
    }
  }
}

/** Unit normals of a torn sheet: of the faces around each node that are not torn, by their areas. Writes into `normals`. */
export function tornNormals(positions, rows, cols, torn, normals) {
  normals.fill(0);
  for (let r = 0; r + 1 < rows; ++r) {
    for (let c = 0; c + 1 < cols; ++c) {
      if (torn.has(r * (cols - 1) + c)) continue;
      const a = 3 * (r * cols + c), below = a + 3 * cols;
      addFace(positions, cols, r, c, [a, a + 3, below, below + 3], normals);
    }
  }
  for (let at = 0; at < normals.length; at += 3) unify(normals, at);
  return normals;
}

/** The same sheet one level finer: shared nodes keep their place, new ones are the mean of their neighbours (Eq. 8). */
export function split(positions, rows, cols) {
  const fineRows = 2 * rows - 1;
  const fineCols = 2 * cols - 1;
  const fine = new Float32Array(fineRows * fineCols * 3);
  for (let r = 0; r < fineRows; ++r) {
    const above = (r >> 1) * cols;
    const below = ((r + 1) >> 1) * cols;
    for (let c = 0; c < fineCols; ++c) {
      const left = c >> 1;
      const right = (c + 1) >> 1;
      for (let axis = 0; axis < 3; ++axis) {
        fine[(r * fineCols + c) * 3 + axis] =
          (positions[(above + left) * 3 + axis] + positions[(above + right) * 3 + axis] +
            positions[(below + left) * 3 + axis] + positions[(below + right) * 3 + axis]) / 4;
      }
    }
  }
  return {positions: fine, rows: fineRows, cols: fineCols};
}

/** `grid` split until it has `rows` rows; the same object when it already has. */
export function splitTo(grid, rows) {
  let finer = grid;
  while (finer.rows < rows) finer = split(finer.positions, finer.rows, finer.cols);
  return finer;
}

/** (1 - share) * a + share * b, element by element, into `out`. */
export function mix(a, b, share, out) {
  for (let i = 0; i < out.length; ++i) out[i] = a[i] + (b[i] - a[i]) * share;
  return out;
}

/** Mean of the nodes: the centre from which Eq. 7 measures the camera's distance. */
export function centreOf(positions) {
  const nodes = positions.length / 3;
  let x = 0, y = 0, z = 0;
  for (let at = 0; at < positions.length; at += 3) {
    x += positions[at];
    y += positions[at + 1];
    z += positions[at + 2];
  }
  return [x / nodes, y / nodes, z / nodes];
}

/** Lowest y of the nodes. */
export function lowestOf(positions) {
  let low = Infinity;
  for (let at = 1; at < positions.length; at += 3) low = Math.min(low, positions[at]);
  return low;
}
