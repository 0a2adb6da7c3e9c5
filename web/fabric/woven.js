import {hash, noise} from './noise.js';

/** Profile of a round thread across its width, 0 at its edges. */
const round = (x) => Math.sqrt(Math.max(0, 1 - (2 * (x - Math.floor(x)) - 1) ** 2));

/** How far a thread is up, -1..1, at `x` along it, where it is over or under the others in turn: `over` by their number. */
function rise(x, over) {
  const from = Math.floor(x - 0.5);
  const a = over(from) ? 1 : -1, b = over(from + 1) ? 1 : -1;
  return a + (b - a) * (0.5 - 0.5 * Math.cos(Math.PI * (x - 0.5 - from)));
}

/**
 * Threads that cross each other: warp threads run down the cloth, weft threads across it.
 * @param {(i: number, j: number) => boolean} warpOnTop where the i-th warp thread crosses the j-th weft thread
 * @param {{uneven?: number, streak?: number, worn?: number, gaps?: number}} [options] `uneven`: by how much threads differ in shade;
 *   `streak`: for how many threads one keeps its shade; `worn`: how far the tops of the warp have lost their dye to the weft's colour;
 *   `gaps`: how dark it is between threads
 */
export const woven = (warpOnTop, {uneven = 0.12, streak = 8, worn = 0, gaps = 0.34} = {}) => (u, v, threads, spot) => {
  const i = Math.floor(u), j = Math.floor(v);
  const warp = round(u) * (0.6 + 0.4 * rise(v, (row) => warpOnTop(i, row)));
  const weft = round(v) * (0.6 + 0.4 * rise(u, (column) => !warpOnTop(column, j)));
  spot.warp = warp > weft;
  spot.thread = spot.warp ? i : j;
  spot.height = Math.max(warp, weft);
  const slub = 0.5 * hash(spot.thread, 0, spot.warp ? 1 : 2) + 0.5 * noise(spot.thread, spot.warp ? v : u, threads, 1, streak, 3);
  spot.shade = (1 - gaps + gaps * spot.height) * (1 + (spot.warp ? uneven : Math.min(uneven, 0.12)) * (slub - 0.5));
  spot.fade = spot.warp ? worn * spot.height ** 6 * (0.4 + 1.2 * slub) : 0;
};
