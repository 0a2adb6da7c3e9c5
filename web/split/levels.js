/** Scenes that the server holds to one level each, so that one sees what a level costs (`weft serve --split`). */

const kHeld = /^(.+)-level-([3-8])$/;

/**
 * @param {{name: string}[]} scenes as the server lists them
 * @returns {Map<string, {scene: string, level: number}[]>} by the name of the scene that is held, the finest level first
 */
export function splitsOf(scenes) {
  const names = new Set(scenes.map(({name}) => name));
  const splits = new Map();
  for (const {name} of scenes) {
    const [, whole, level] = kHeld.exec(name) ?? [];
    if (!names.has(whole)) continue;
    splits.set(whole, [...(splits.get(whole) ?? []), {scene: name, level: Number(level)}]);
  }
  for (const held of splits.values()) held.sort((a, b) => b.level - a.level);
  return splits;
}

/** The scenes without those that are there for a split. @template {{name: string}} T @param {T[]} scenes @returns {T[]} */
export function withoutHeld(scenes) {
  const held = new Set([...splitsOf(scenes).values()].flat().map(({scene}) => scene));
  return scenes.filter(({name}) => !held.has(name));
}

/**
 * How far apart the same cloth of two levels is: root mean square over the nodes that both have (node (r, c) of a level is (2r, 2c) of
 * the next), m; null where they share none.
 * @param {{rows: number, cols: number, origin: number[], positions: Float32Array}} fine @param {typeof fine} coarse
 */
export function distanceBetween(fine, coarse) {
  const step = (fine.rows - 1) / (coarse.rows - 1);
  if (!Number.isInteger(step) || (fine.cols - 1) / (coarse.cols - 1) !== step) return null;
  let sum = 0;
  for (let r = 0; r < coarse.rows; ++r) {
    for (let c = 0; c < coarse.cols; ++c) {
      const a = 3 * (r * step * fine.cols + c * step), b = 3 * (r * coarse.cols + c);
      for (let axis = 0; axis < 3; ++axis) {
        sum += (fine.origin[axis] + fine.positions[a + axis] - coarse.origin[axis] - coarse.positions[b + axis]) ** 2;
      }
    }
  }
  return Math.sqrt(sum / (coarse.rows * coarse.cols));
}
