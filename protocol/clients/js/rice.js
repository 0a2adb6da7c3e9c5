/** The mesh of a cloth in a frame (PROTOCOL.md section 4, codec 4). */
import { malformed } from './errors.js';
import { checkSides } from './grid.js';

const AXES = 3;
const MAX_PARAMETER = 18;
const ESCAPE = 20;         // quotient of a value that is written whole
const ESCAPED_WIDTH = 19;  // residuals, zig-zagged, lie below 2^19
const MAX_DIFFERENCE = 131070;
const FIRST_PARTS = 8;     // parameters of row 0, a byte of zeros, the length of the quotients
const BAD_QUOTIENTS = 'quotients that are not as many as values, or too large';

/**
 * Positions, x, y, z interleaved, row by row, m: Rice codes of zig-zagged residuals, whose parameters follow from the rows before.
 * @param {Uint8Array} payload @param {number} rows @param {number} cols @param {number} bits of each value
 * @param {number[]} origin @param {number} quantum @returns {Float32Array}
 */
export function decodeRiceGrid(payload, rows, cols, bits, origin, quantum) {
  checkSides(rows, cols);
  const nodes = rows * cols;
  // A value is at least the bit that ends its quotient: a payload buys so much memory and no more.
  if (payload.length < FIRST_PARTS + Math.ceil(AXES * nodes / 8)) malformed('grid payload too short');
  for (let axis = 0; axis < AXES; ++axis)
    if (payload[axis] > MAX_PARAMETER) malformed(`first parameter ${payload[axis]}`);
  const length = (payload[4] | payload[5] << 8 | payload[6] << 16 | payload[7] << 24) >>> 0;
  if (length > payload.length - FIRST_PARTS) malformed('grid payload too short');
  const quotientEnd = 8 * (FIRST_PARTS + length), remainderEnd = 8 * payload.length;
  let quotientBit = 8 * FIRST_PARTS, remainderBit = quotientEnd;
  const bytes = new Uint8Array(payload.length + 4);  // room to read whole words at the end
  bytes.set(payload);

  const top = 2 ** bits - 1;
  const positions = new Float32Array(AXES * nodes);
  const residuals = new Int32Array(AXES * nodes);  // zig-zagged, an axis after the other
  const parameters = new Int32Array(cols);
  const axes = Array.from({ length: AXES }, () => ({ values: new Int32Array(cols), before: new Int32Array(cols), now: new Int32Array(cols), down: 0 }));
  for (let r = 0; r < rows; ++r) {
    for (let axis = 0; axis < AXES; ++axis) {
      const row = axis * nodes + r * cols;
      if (r === 0) parameters.fill(payload[axis]);
      else findParameters(residuals, row, r, cols, parameters);
      for (let c = 0; c < cols; ++c) {
        let quotient = 0;
        while (quotientBit < quotientEnd && quotient <= ESCAPE && !(bytes[quotientBit >> 3] >> (quotientBit & 7) & 1)) {
          ++quotient;
          ++quotientBit;
        }
        if (quotient > ESCAPE || quotientBit++ >= quotientEnd) malformed(BAD_QUOTIENTS);
        const width = quotient === ESCAPE ? ESCAPED_WIDTH : parameters[c];
        if (remainderEnd - remainderBit < width) malformed('grid payload too short');
        const byte = remainderBit >> 3;
        const word = bytes[byte] | bytes[byte + 1] << 8 | bytes[byte + 2] << 16 | bytes[byte + 3] << 24;
        let z = (word >>> (remainderBit & 7)) & ((1 << width) - 1);
        if (quotient < ESCAPE) z |= quotient << width;
        if (z >= 2 ** ESCAPED_WIDTH) malformed('residual beyond 19 bits');
        residuals[row + c] = z;
        remainderBit += width;
      }
      const { values } = axes[axis];
      addRow(axes[axis], residuals, row, r, cols, top, bits);
      for (let c = 0, i = AXES * r * cols + axis; c < cols; ++c, i += AXES) positions[i] = origin[axis] + values[c] * quantum;
    }
  }
  const restIsZero = (quotientBit & 7) === 0 || bytes[quotientBit >> 3] >> (quotientBit & 7) === 0;
  if (Math.ceil(quotientBit / 8) !== quotientEnd / 8 || !restIsZero) malformed(BAD_QUOTIENTS);
  const unread = payload.length - Math.ceil(remainderBit / 8);
  if (unread > 0) malformed(`${unread} bytes after the grid payload`);
  return positions;
}

/**
 * Of row r > 0, from the residuals of those above it: the exponent of the power of two at or below the mean.
 * @param {Int32Array} z @param {number} row where row r begins @param {number} r @param {number} cols @param {Int32Array} parameters
 */
function findParameters(z, row, r, cols, parameters) {
  const one = row - cols, two = row - Math.min(r, 2) * cols, three = row - Math.min(r, 3) * cols, last = cols - 1;
  for (let c = 0; c < cols; ++c) {
    const left = Math.max(c - 1, 0), right = Math.min(c + 1, last);
    const sum = z[one + Math.max(c - 2, 0)] + 2 * z[one + left] + 3 * z[one + c] + 2 * z[one + right] + z[one + Math.min(c + 2, last)] +
      z[two + left] + 2 * z[two + c] + z[two + right] + 3 * z[three + c];
    parameters[c] = Math.max(31 - Math.clz32(sum >> 4), 0);
  }
}

/**
 * The values of row r, from its residuals and the rows before.
 * @param {{values: Int32Array, before: Int32Array, now: Int32Array, down: number}} axis values, their differences, and the last
 *   step down column 0
 * @param {Int32Array} z @param {number} row @param {number} r @param {number} cols @param {number} top @param {number} bits
 */
function addRow(axis, z, row, r, cols, top, bits) {
  const { values, before, now } = axis;
  let step = axis.down;
  for (let c = 0; c < cols; ++c) {
    let difference = (z[row + c] >> 1) ^ -(z[row + c] & 1);
    if (r >= 2 && c >= 2 && c <= cols - 2) difference += (6 * before[c - 1] + 5 * before[c] + 5 * before[c + 1] + 8) >> 4;
    if (Math.abs(difference) > MAX_DIFFERENCE) malformed('difference beyond 131070');
    now[c] = difference;
    if (r > 0) {
      step += difference;
      values[c] += step;
      if (c === 0) axis.down = step;
    } else if (c === 0) {
      values[0] = difference;
    } else {
      step += difference;
      values[c] = values[c - 1] + step;
    }
    if (values[c] < 0 || values[c] > top) malformed(`value outside ${bits} bits`);
  }
  axis.before = now;
  axis.now = before;
}
