/** Numbers that look random, are the same on every machine, and repeat without a seam. */

/** 0..1 by two integers and a seed. */
export function hash(i, j, seed = 0) {
  let x = Math.imul(i, 0x27d4eb2d) ^ Math.imul(j, 0x165667b1) ^ Math.imul(seed, 0x9e3779b1);
  x = Math.imul(x ^ (x >>> 15), 0x85ebca6b);
  x = Math.imul(x ^ (x >>> 13), 0xc2b2ae35);
  return ((x ^ (x >>> 16)) >>> 0) / 4294967296;
}

const wrap = (i, period) => ((i % period) + period) % period;
const ease = (t) => t * t * (3 - 2 * t);

/** How many features of a size, in threads, a picture of so many threads has side by side. */
const count = (threads, size) => Math.max(1, Math.round(threads / size));

/** Smooth noise, 0..1, at (u, v) of a picture of so many threads, of features `width` by `height` threads large. */
export function noise(u, v, threads, width, height, seed) {
  const columns = count(threads, width), rows = count(threads, height);
  const x = (u * columns) / threads, y = (v * rows) / threads;
  const i = Math.floor(x), j = Math.floor(y);
  const s = ease(x - i), t = ease(y - j);
  const left = wrap(i, columns), right = wrap(i + 1, columns), above = wrap(j, rows), below = wrap(j + 1, rows);
  const top = hash(left, above, seed) * (1 - s) + hash(right, above, seed) * s;
  const bottom = hash(left, below, seed) * (1 - s) + hash(right, below, seed) * s;
  return top * (1 - t) + bottom * t;
}

/** The same of features of several sizes, from `size` threads down by halves. */
export function clouds(u, v, threads, size, octaves, seed) {
  let sum = 0, weight = 0;
  for (let octave = 0, share = 1; octave < octaves; ++octave, share /= 2) {
    const width = size / 2 ** octave;
    sum += share * noise(u, v, threads, width, width, seed + octave);
    weight += share;
  }
  return sum / weight;
}

/**
 * Distances from (x, y) to the nearest two of points strewn one a unit cell, repeating every `period`; written into `result`.
 * @param {{nearest: number, second: number, cell: number}} result `cell`: 0..1, another number for each point
 */
export function cells(x, y, period, seed, result) {
  const i = Math.floor(x), j = Math.floor(y);
  result.nearest = result.second = Infinity;
  for (let dj = -1; dj <= 1; ++dj) {
    for (let di = -1; di <= 1; ++di) {
      const a = wrap(i + di, period), b = wrap(j + dj, period);
      const distance = Math.hypot(i + di + hash(a, b, seed) - x, j + dj + hash(a, b, seed + 1) - y);
      if (distance < result.nearest) {
        result.second = result.nearest;
        result.nearest = distance;
        result.cell = hash(a, b, seed + 2);
      } else if (distance < result.second) {
        result.second = distance;
      }
    }
  }
}
