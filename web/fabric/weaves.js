import {felted, grained, knitted, pressed, suede} from './grains.js';
import {woven} from './woven.js';

/**
 * @typedef {object} Spot what a pattern writes at a point
 * @property {number} height 0..1
 * @property {boolean} warp whose colour it has: the warp's or the weft's
 * @property {number} thread number of the thread, among those of its kind
 * @property {number} shade times the colour
 * @property {number} fade share of the weft's colour in it
 *
 * @typedef {object} Side
 * @property {(u: number, v: number, threads: number, spot: Spot) => void} pattern at (u, v), counted in threads, of a picture that
 *   repeats every so many
 * @property {number} relief height of the pattern in widths of a thread
 * @property {object} surface of a MeshPhysicalMaterial; `fuzz`: how white the sheen's colour is, between the cloth's own and white
 *
 * @typedef {object} Weave
 * @property {number} threads that a picture has side by side
 * @property {number} period threads after which the weave itself repeats
 * @property {number} [detail] share of a picture's side that is enough for it (default 1)
 * @property {Side} front
 * @property {Side} [back] where the other side is another one
 */

const mod = (i, n) => ((i % n) + n) % n;
const inverse = (over) => (i, j) => !over(i, j);

const plain = (i, j) => mod(i + j, 2) === 0;
const twill = (i, j) => mod(i - j, 4) !== 0;            // three over, one under, a thread further in each row
const satin = (i, j) => mod(i - 3 * j, 8) !== 0;        // seven over, one under, nowhere side by side
const basket = (i, j) => mod(Math.floor(i / 2) + Math.floor(j / 2), 2) === 0;

const kCotton = {roughness: 0.9, sheen: 0.25, sheenRoughness: 0.7, fuzz: 0.5};
const kDenim = {roughness: 0.88, sheen: 0.2, sheenRoughness: 0.6, fuzz: 0.6};
const kSilk = {roughness: 0.34, anisotropy: 0.75, sheen: 0.7, sheenRoughness: 0.35, fuzz: 0.35};

/** @type {Record<string, Weave>} */
export const kWeaves = {
  plain: {threads: 64, period: 2, front: {pattern: woven(plain), relief: 0.35, surface: kCotton}},
  twill: {
    threads: 128, period: 4,
    front: {pattern: woven(twill, {uneven: 0.35, streak: 40, worn: 0.18}), relief: 0.4, surface: kDenim},
    back: {pattern: woven(inverse(twill), {uneven: 0.2}), relief: 0.4, surface: kDenim},
  },
  satin: {
    threads: 128, period: 8,
    front: {pattern: woven(satin, {uneven: 0.03, gaps: 0.08}), relief: 0.06, surface: kSilk},
    back: {pattern: woven(inverse(satin), {uneven: 0.05, gaps: 0.15}), relief: 0.15, surface: {...kSilk, roughness: 0.6, anisotropy: 0.3}},
  },
  canvas: {threads: 64, period: 4, front: {pattern: woven(basket, {uneven: 0.22, streak: 16}), relief: 0.4, surface: {...kCotton, roughness: 0.95}}},
  wool: {
    threads: 64, period: 2, detail: 0.5,
    front: {pattern: felted(woven(plain)), relief: 0.5, surface: {roughness: 1, sheen: 1, sheenRoughness: 0.55, fuzz: 0.45, specularIntensity: 0.2}},
  },
  knit: {
    threads: 32, period: 1, detail: 0.5,
    front: {pattern: knitted, relief: 0.45, surface: {roughness: 1, sheen: 0.8, sheenRoughness: 0.6, fuzz: 0.4, specularIntensity: 0.3}},
  },
  leather: {
    threads: 48, period: 1, detail: 0.5,
    front: {pattern: grained, relief: 0.14, surface: {roughness: 0.46, specularIntensity: 0.9}},
    back: {pattern: suede, relief: 0.2, surface: {roughness: 1, sheen: 0.8, sheenRoughness: 0.5, fuzz: 0.5, specularIntensity: 0.2}},
  },
  paper: {threads: 64, period: 1, detail: 0.5, front: {pattern: pressed, relief: 0.12, surface: {roughness: 0.82, specularIntensity: 0.5}}},
};
