import {cells, clouds, noise} from './noise.js';

const step = (from, to, x) => {
  const t = Math.min(1, Math.max(0, (x - from) / (to - from)));
  return t * t * (3 - 2 * t);
};

/** A woven cloth whose threads have been felted: fibres lie over what is left of them, none takes the dye like the next. */
export const felted = (under) => (u, v, threads, spot) => {
  under(u, v, threads, spot);
  const fibres = clouds(u, v, threads, 1, 4, 11), curls = noise(u + fibres, v - fibres, threads, 0.4, 0.4, 17);
  spot.height = 0.25 * spot.height + 0.45 * fibres + 0.3 * curls;
  spot.shade = 0.72 + 0.3 * fibres + 0.26 * (curls - 0.5) + 0.16 * (clouds(u, v, threads, 8, 2, 23) - 0.5);
  spot.fade = 0;
};

/** Stitches in columns: two legs each, that lean towards each other like a V. */
export function knitted(u, v, threads, spot) {
  const x = 2 * (u - Math.floor(u)) - 1;  // -1..1 across a stitch
  const leg = Math.abs(x);
  const y = (Math.round(1.25 * threads) / threads) * v - 0.75 * leg;  // along the legs, in stitches
  const place = y - Math.floor(y);
  const across = Math.sqrt(Math.max(0, 1 - (2 * leg - 1) ** 2));
  const along = Math.sqrt(Math.max(0, 1 - (2 * place - 1) ** 2));
  const twist = 0.5 + 0.5 * Math.sin(2 * Math.PI * (3 * place + 2 * leg * Math.sign(x)));
  spot.warp = true;
  spot.thread = Math.floor(u);
  spot.height = Math.min(across ** 0.7, along ** 0.6) * (0.9 + 0.1 * twist);
  spot.shade = (0.45 + 0.55 * spot.height) * (0.94 + 0.12 * noise(u, v, threads, 0.25, 0.25, 5));
  spot.fade = 0;
}

const near = {nearest: 0, second: 0, cell: 0};

/** Pebbles of uneven size between creases. */
export function grained(u, v, threads, spot) {
  const bend = clouds(u, v, threads, 2, 2, 31) - 0.5;
  cells(u + 0.8 * bend, v - 0.8 * bend, threads, 41, near);
  const crease = step(0, 0.32, near.second - near.nearest);
  const pores = noise(u, v, threads, 1 / 6, 1 / 6, 47);
  spot.warp = true;
  spot.thread = Math.floor(u);
  spot.height = crease * (0.75 + 0.25 * near.cell) - 0.06 * pores;
  spot.shade = (0.68 + 0.32 * crease) * (0.88 + 0.1 * near.cell + 0.24 * (clouds(u, v, threads, 12, 3, 53) - 0.35));
  spot.fade = 0;
}

/** The flesh side of leather: short fibres. */
export function suede(u, v, threads, spot) {
  const nap = clouds(u, v, threads, 0.5, 3, 61);
  spot.warp = true;
  spot.thread = Math.floor(u);
  spot.height = nap;
  spot.shade = 0.8 + 0.3 * nap + 0.15 * (clouds(u, v, threads, 6, 2, 67) - 0.5);
  spot.fade = 0.28;
}

/** Fibres in all directions, pressed flat. */
export function pressed(u, v, threads, spot) {
  const pulp = clouds(u, v, threads, 2, 4, 71);
  const fibre = Math.abs(noise(u + 4 * pulp, v, threads, 3, 0.7, 73) - 0.5);
  spot.warp = true;
  spot.thread = Math.floor(u);
  spot.height = 0.7 * pulp + 0.3 * step(0.02, 0.1, fibre);
  spot.shade = 0.965 + 0.035 * pulp + 0.02 * step(0.01, 0.06, fibre);
  spot.fade = 0;
}
