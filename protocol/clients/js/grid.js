/** The mesh of a cloth in a frame (PROTOCOL.md section 4, codec 1). */
import { malformed } from './errors.js';

const GROUP = 16;       // values that share a width
const MAX_WIDTH = 18;   // residuals of 16-bit values, zig-zagged, lie below 2^18
const MIN_SIDE = 2, MAX_SIDE = 1025;

/**
 * Positions, x, y, z interleaved, row by row, m: three axes of zig-zagged residuals in groups of 16.
 * @param {Uint8Array} payload @param {number} rows @param {number} cols @param {number} bits of each value
 * @param {number[]} origin @param {number} quantum @returns {Float32Array}
 */
export function decodeGrid(payload, rows, cols, bits, origin, quantum) {
  checkSides(rows, cols);
  const nodes = rows * cols;
  // A group is at least its width byte: no payload buys more memory than it is long.
  if (payload.length < 3 * Math.ceil(nodes / GROUP)) malformed('grid payload too short');
  const bytes = new Uint8Array(payload.length + 4);  // room to read whole words at the end
  bytes.set(payload);
  const positions = new Float32Array(3 * nodes);
  const residuals = new Int32Array(nodes);
  const above = new Int32Array(cols);
  const top = 2 ** bits - 1;
  let at = 0;
  for (let axis = 0; axis < 3; ++axis) {
    for (let first = 0; first < nodes; first += GROUP) {
      if (at === payload.length) malformed('grid payload too short');
      const width = bytes[at++];
      if (width > MAX_WIDTH) malformed(`group width ${width}`);
      const end = Math.min(first + GROUP, nodes);
      const groupBytes = ((end - first) * width + 7) >> 3;
      if (payload.length - at < groupBytes) malformed('grid payload too short');
      const mask = (1 << width) - 1;
      for (let i = first, bit = 8 * at; i < end; ++i, bit += width) {
        const byte = bit >> 3;
        const word = bytes[byte] | bytes[byte + 1] << 8 | bytes[byte + 2] << 16 | bytes[byte + 3] << 24;
        const z = (word >>> (bit & 7)) & mask;
        residuals[i] = (z >> 1) ^ -(z & 1);
      }
      at += groupBytes;
    }
    above.fill(0);
    const start = origin[axis];
    for (let r = 0, i = 0; r < rows; ++r) {
      // q - P is d - (d to the left), with d = q - (q above).
      let difference = 0, outside = false;
      for (let c = 0; c < cols; ++c, ++i) {
        difference += residuals[i];
        const q = above[c] + difference;
        above[c] = q;
        outside ||= q < 0 || q > top;
        positions[3 * i + axis] = start + q * quantum;
      }
      if (outside) malformed(`value outside ${bits} bits`);
    }
  }
  if (at !== payload.length) malformed(`${payload.length - at} bytes after the grid payload`);
  return positions;
}

/** @param {number} rows @param {number} cols */
export function checkSides(rows, cols) {
  if (rows < MIN_SIDE || rows > MAX_SIDE || cols < MIN_SIDE || cols > MAX_SIDE) malformed(`grid of ${rows} rows and ${cols} columns`);
}
