import {CanvasTexture, RepeatWrapping, SRGBColorSpace} from '../three/three.module.js';

/** One repeat of the pattern: threads across it, and the width of cloth it covers. Threads of 6 mm: coarse, so that they show. */
const kThreads = 64;
const kRepeatMetres = 0.4;
const kPixelsPerThread = 16;

const kDyes = {warp: [44, 88, 148], weft: [70, 116, 176], stripe: [246, 236, 214]};  // sRGB

/** Warp threads (they run down the cloth) of another colour: a group of three stripes in each repeat. */
const isStripe = (thread) => thread < 2 || (thread >= 4 && thread < 10) || (thread >= 12 && thread < 14);

/** Profile of a round thread across its width, 0 at its edges. */
const round = (x) => Math.sqrt(Math.max(0, 1 - (2 * (x - Math.floor(x)) - 1) ** 2));

/** Small numbers that look random and are the same on every machine. */
function noise(i) {
  const x = Math.sin(i * 127.1 + 11.7) * 43758.5453;
  return x - Math.floor(x);
}

/** A plain weave at (u, v), counted in threads: how high the fabric is, 0..1, and whether the warp lies on top. */
function weave(u, v) {
  const warp = round(u) * (0.6 + 0.4 * Math.sin(Math.PI * (v + Math.floor(u))));
  const weft = round(v) * (0.6 + 0.4 * Math.sin(Math.PI * (u + Math.floor(v) + 1)));
  return {height: Math.max(warp, weft), isWarp: warp > weft};
}

let drawn = null;

/**
 * The fabric of all cloths of a page: its colour, and the bumps of its threads. Texture coordinates are metres.
 * @param {number} anisotropy the graphics card's best filter for slanted views
 * @returns {{map: CanvasTexture, bumpMap: CanvasTexture}}
 */
export function weaveTextures(anisotropy) {
  drawn ??= drawTextures(kDyes, anisotropy);
  return drawn;
}

function drawTextures(colours, anisotropy) {
  const size = kThreads * kPixelsPerThread;
  const colour = new ImageData(size, size);
  const bump = new ImageData(size, size);
  for (let y = 0; y < size; ++y) {
    for (let x = 0; x < size; ++x) {
      const u = (x + 0.5) / kPixelsPerThread;
      const v = (y + 0.5) / kPixelsPerThread;
      const {height, isWarp} = weave(u, v);
      const thread = Math.floor(isWarp ? u : v);
      const dye = isWarp ? (isStripe(thread) ? colours.stripe : colours.warp) : colours.weft;
      // Gaps between threads are dark, and no two threads took the dye alike.
      const shade = (0.66 + 0.34 * height) * (0.94 + 0.12 * noise(thread + (isWarp ? 0 : 100)));
      const at = (y * size + x) * 4;
      for (let channel = 0; channel < 3; ++channel) {
        colour.data[at + channel] = Math.min(255, dye[channel] * shade);
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
