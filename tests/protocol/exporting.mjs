// Frames made by hand, and both clients' files of them.
import { spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { glbBytes, objText } from '../../protocol/clients/js/weft.js';

/** A grid of nodes 1 m apart, from (0, lift, 0). */
export function cloth(index, rows, cols, lift, torn = []) {
  const nodes = Array.from({ length: rows * cols }, (_, i) => [i % cols, lift, Math.floor(i / cols)]);
  return { cloth: index, rows, cols, origin: [0, 0, 0], positions: Float32Array.from(nodes.flat()), torn };
}
export const frame = (time, ...cloths) => ({ stamp: { time, epoch: 0 }, cloths, balls: [], obstacles: [] });

export const UPRIGHT = [1, 0, 0, 0];
export const TETRAHEDRON = { vertices: [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1], triangles: [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3] };

/** What triangles enclose, m3, as seen from outside: the sum of a . (b x c) / 6; `corners`: x, y, z of three a triangle. */
export function volumeWithin(corners) {
  let sum = 0;
  for (let i = 0; i < corners.length; i += 9) {
    const [a, b, c] = [0, 3, 6].map((corner) => corners.slice(i + corner, i + corner + 3));
    sum += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return sum / 6;
}

const EDGES = 32, QUARTER = 8;  // of the clients' balls
/** A regular polygon in a circle. */
export const polygon = (radius) => EDGES / 2 * radius ** 2 * Math.sin(2 * Math.PI / EDGES);
/** The clients' ball: frustums of polygons, each of height (A + B + sqrt(A B)) / 3. */
export const ballVolume = (radius) => Array.from({ length: 2 * QUARTER }, (_, i) => {
  const [from, to] = [i, i + 1].map((ring) => ring * Math.PI / (2 * QUARTER));
  const [a, b] = [from, to].map((polar) => polygon(radius * Math.sin(polar)));
  return radius * (Math.cos(from) - Math.cos(to)) * (a + b + Math.sqrt(a * b)) / 3;
}).reduce((sum, part) => sum + part, 0);

const SCRIPT = fileURLToPath(new URL('export_frames.py', import.meta.url));

/** `surfaces`: of the scene's obstacles, null where one has none. The .obj is of the last frame. */
function byPython(frames, { scene, surfaces = [] } = {}) {
  const told = { scene, surfaces, frames: frames.map(({ stamp, cloths, balls, obstacles }) => (
    { ...stamp, balls, obstacles, cloths: cloths.map((each) => ({ ...each, positions: [...each.positions] })) })) };
  const folder = mkdtempSync(join(tmpdir(), 'weft-export-'));
  try {
    const { status, stderr } = spawnSync('/usr/bin/python3', [SCRIPT, folder], { input: JSON.stringify(told), encoding: 'utf8' });
    if (status !== 0) throw new RangeError(stderr);
    return { glb: new Uint8Array(readFileSync(join(folder, 'frames.glb'))), obj: readFileSync(join(folder, 'frame.obj'), 'utf8') };
  } finally {
    rmSync(folder, { recursive: true });
  }
}
function byJavaScript(frames, { scene, surfaces = [] } = {}) {
  const options = { scene, surfaces: new Map([...surfaces.entries()].filter(([, surface]) => surface)) };
  return { glb: glbBytes(frames, options), obj: objText(frames.at(-1), options) };
}
export const CLIENTS = [['JavaScript', byJavaScript], ['Python', byPython]];
