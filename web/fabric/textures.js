import {CanvasTexture, RepeatWrapping, SRGBColorSpace} from '../three/three.module.js';
import {inStripe, repeatOf} from './stripes.js';

/** @typedef {import('./wardrobe.js').Look} Look */

const rgb = (text) => [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16));

/**
 * The pictures of one side of a fabric: its colour and, if wanted, the slopes of its threads. Texture coordinates are metres.
 * @param {Look} look
 * @param {import('./weaves.js').Weave} weave
 * @param {{pattern: Function, relief: number, colours: {warp: string, weft: string, stripe?: object}}} side
 * @param {{pixels: number, anisotropy: number, slopes: boolean}} options
 * @returns {{map: CanvasTexture, normalMap: CanvasTexture|null}}
 */
export function drawSide(look, weave, {pattern, relief, colours}, {pixels, anisotropy, slopes}) {
  const {threads, metres} = repeatOf(look, weave);
  const warp = rgb(colours.warp), weft = rgb(colours.weft);
  const stripe = colours.stripe && rgb(colours.stripe.colour);
  const striped = Array.from({length: threads}, (_, i) => Boolean(stripe) && inStripe(i, threads, metres, colours.stripe));
  const image = new ImageData(pixels, pixels);
  const heights = new Float32Array(pixels * pixels);
  const spot = {height: 0, warp: true, thread: 0, shade: 1, fade: 0};
  for (let y = 0, at = 0; y < pixels; ++y) {
    const v = ((y + 0.5) * threads) / pixels;
    for (let x = 0; x < pixels; ++x, at += 4) {
      pattern(((x + 0.5) * threads) / pixels, v, threads, spot);
      heights[y * pixels + x] = spot.height;
      const inBand = striped[spot.thread] && (spot.warp || colours.stripe.across);
      const dye = inBand ? stripe : spot.warp ? warp : weft;
      for (let channel = 0; channel < 3; ++channel) {
        image.data[at + channel] = (dye[channel] + spot.fade * (weft[channel] - dye[channel])) * spot.shade;
      }
      image.data[at + 3] = 255;
    }
  }
  const map = texture(image, metres, anisotropy);
  map.colorSpace = SRGBColorSpace;
  const steepness = (relief * pixels) / threads;
  return {map, normalMap: slopes ? texture(slopesOf(heights, pixels, steepness), metres, anisotropy) : null};
}

/** Normals of a height field, as colours; rows run down the picture, v up. */
function slopesOf(heights, side, steepness) {
  const image = new ImageData(side, side);
  for (let y = 0, at = 0; y < side; ++y) {
    const above = ((y + side - 1) % side) * side, below = ((y + 1) % side) * side;
    for (let x = 0; x < side; ++x, at += 4) {
      const left = (x + side - 1) % side, right = (x + 1) % side;
      const nx = (heights[y * side + left] - heights[y * side + right]) * steepness * 0.5;
      const ny = (heights[below + x] - heights[above + x]) * steepness * 0.5;
      const length = Math.hypot(nx, ny, 1);
      image.data[at] = 127.5 * (1 + nx / length);
      image.data[at + 1] = 127.5 * (1 + ny / length);
      image.data[at + 2] = 127.5 * (1 + 1 / length);
      image.data[at + 3] = 255;
    }
  }
  return image;
}

function texture(image, metres, anisotropy) {
  const canvas = document.createElement('canvas');
  canvas.width = image.width;
  canvas.height = image.height;
  canvas.getContext('2d').putImageData(image, 0, 0);
  const result = new CanvasTexture(canvas);
  result.wrapS = result.wrapT = RepeatWrapping;
  result.repeat.set(1 / metres, 1 / metres);
  result.anisotropy = anisotropy;
  return result;
}
