import {CanvasTexture, RepeatWrapping, SRGBColorSpace} from './three/three.module.js';

/** Threads across one repeat of the pattern, and the width of cloth it covers. A thread every 6 mm: coarse linen, so that it shows. */
const kThreads = 32;
const kPixelsPerThread = 16;
const kRepeatMetres = 0.2;

/** Height of the fabric at a point of a plain weave, 0..1: the higher of warp and weft, each a rounded thread going over and under. */
function weaveHeight(u, v) {
  const over = Math.cos(Math.PI * u) * Math.cos(Math.PI * v);  // sign tells which thread lies on top
  const round = (x) => Math.sqrt(Math.max(0, 1 - (2 * (x - Math.floor(x)) - 1) ** 2));
  const warp = round(u) * (0.55 + 0.45 * Math.sin(Math.PI * (v + Math.floor(u))));
  const weft = round(v) * (0.55 + 0.45 * Math.sin(Math.PI * (u + Math.floor(v) + 1)));
  return {height: Math.max(warp, weft), isWarp: warp > weft, over};
}

/** Small numbers that look random and are the same on every machine. */
function noise(i) {
  const x = Math.sin(i * 127.1 + 11.7) * 43758.5453;
  return x - Math.floor(x);
}

/**
 * Draws the fabric: colour, and the bumps of its threads.
 * @param {object} colours
 * @param {number[]} colours.warp sRGB 0..255
 * @param {number[]} colours.weft
 * @param {number[]} colours.stripe of the woven check
 * @param {number} anisotropy the graphics card's best filter for slanted views
 * @returns {{map: CanvasTexture, bumpMap: CanvasTexture}} both repeat every metre-based unit given by `kRepeatMetres`
 */
export function weaveTextures({warp, weft, stripe}, anisotropy) {
  const size = kThreads * kPixelsPerThread;
  const colour = new ImageData(size, size);
  const bump = new ImageData(size, size);
  for (let y = 0; y < size; ++y) {
    for (let x = 0; x < size; ++x) {
      const u = (x + 0.5) / kPixelsPerThread;
      const v = (y + 0.5) / kPixelsPerThread;
      const {height, isWarp} = weaveHeight(u, v);
      const thread = isWarp ? Math.floor(u) : Math.floor(v);
      const base = thread < 2 ? stripe : isWarp ? warp : weft;
      // Gaps between threads are dark, and no two threads took the dye alike.
      const shade = (0.62 + 0.38 * height) * (0.95 + 0.1 * noise(thread + (isWarp ? 0 : 100)));
      const at = (y * size + x) * 4;
      for (let channel = 0; channel < 3; ++channel) {
        colour.data[at + channel] = base[channel] * shade;
        bump.data[at + channel] = 255 * height;
      }
      colour.data[at + 3] = bump.data[at + 3] = 255;
    }
  }
  const map = texture(colour, anisotropy);
  map.colorSpace = SRGBColorSpace;
  return {map, bumpMap: texture(bump, anisotropy)};
}

function texture(image, anisotropy) {
  const canvas = document.createElement('canvas');
  canvas.width = image.width;
  canvas.height = image.height;
  canvas.getContext('2d').putImageData(image, 0, 0);
  const result = new CanvasTexture(canvas);
  result.wrapS = result.wrapT = RepeatWrapping;
  result.repeat.set(1 / kRepeatMetres, 1 / kRepeatMetres);
  result.anisotropy = anisotropy;
  return result;
}
