/** Binary messages: a step as records (PROTOCOL.md section 4). */
import { malformed } from './errors.js';
import { decodeGrid } from './grid.js';
import { decodeRiceGrid } from './rice.js';

/**
 * @typedef {import('./types.js').Ball} Ball
 * @typedef {import('./types.js').Cloth} Cloth
 * @typedef {import('./types.js').Frame} Frame
 * @typedef {import('./types.js').MovedObstacle} MovedObstacle
 * @typedef {import('./types.js').Stamp} Stamp
 * @typedef {import('./types.js').Vector} Vector
 */

const HEADER_BYTES = 64;
const FLAG_LAST = 1, FLAG_PAUSED = 2, FLAG_SLOW = 4;
const BALL_BYTES = 24;
const OBSTACLE_BYTES = 32;
const MAX_FLOAT = 3.4028234663852886e38;
const LOCAL_GRID = 16;  // m, what origins are multiples of: from frame to frame mostly the same

/**
 * Decodes one binary message. Throws a WeftError `bad_frame` on anything malformed.
 * @param {ArrayBuffer|ArrayBufferView} message
 * @param {{local?: boolean}} [options] local: positions are from an `origin` of each cloth's near it, for whoever shows cloths far
 *   from the world's: a Float32Array has 1 mm at 10 km
 * @returns {Frame}
 */
export function decodeFrame(message, { local = false } = {}) {
  const view = ArrayBuffer.isView(message)
    ? new DataView(message.buffer, message.byteOffset, message.byteLength)
    : new DataView(message);
  if (view.byteLength === 0) malformed('empty message');
  /** @type {Frame} */
  const frame = { stamp: /** @type {any} */ (null), cloths: [], balls: [], obstacles: [] };
  let last = false;
  for (let at = 0; at < view.byteLength;) {
    if (last) malformed('bytes after the last record');
    if (view.byteLength - at < HEADER_BYTES) malformed('header cut short');
    if (view.getUint32(at) !== 0x57454654) malformed('wrong magic');
    if (view.getUint8(at + 4) !== 1) malformed(`version ${view.getUint8(at + 4)}`);
    const headerBytes = view.getUint16(at + 8, true);
    if (headerBytes < HEADER_BYTES || headerBytes > 256 || headerBytes % 8) malformed(`header_length ${headerBytes}`);
    if (view.byteLength - at < headerBytes) malformed('header cut short');
    const payloadBytes = view.getUint32(at + 60, true);
    if (view.byteLength - at - headerBytes < payloadBytes) malformed('payload cut short');

    last = (view.getUint16(at + 6, true) & FLAG_LAST) !== 0;
    const stamp = readStamp(view, at);
    if (frame.stamp && (frame.stamp.f !== stamp.f || frame.stamp.epoch !== stamp.epoch)) malformed('records of different steps');
    frame.stamp ??= stamp;
    const payload = new Uint8Array(view.buffer, view.byteOffset + at + headerBytes, payloadBytes);
    const type = view.getUint8(at + 5);
    if (type === 1) frame.cloths.push(readCloth(view, at, payload, local));
    if (type === 4) readTears(view, at, payload, frame.cloths);
    if (type === 2) frame.balls.push(...readBalls(view, at, payload));
    if (type === 3) frame.obstacles.push(...readObstacles(view, at, payload));  // other types: of a later minor version
    at += headerBytes + payloadBytes;
  }
  if (!last) malformed('last record is missing');
  return frame;
}

/** @param {DataView} view @param {number} at where the record begins @returns {Stamp} */
function readStamp(view, at) {
  const flags = view.getUint16(at + 6, true);
  const time = view.getFloat64(at + 24, true);
  if (!Number.isFinite(time)) malformed('time is not finite');
  return {
    f: view.getUint32(at + 16, true),
    epoch: view.getUint32(at + 20, true),
    time,
    serverMs: view.getUint32(at + 32, true),
    paused: (flags & FLAG_PAUSED) !== 0,
    slow: (flags & FLAG_SLOW) !== 0,
  };
}

/** @param {DataView} view @param {number} at where the record begins @param {Uint8Array} payload @param {boolean} local @returns {Cloth} */
function readCloth(view, at, payload, local) {
  const codec = view.getUint8(at + 10);
  if (codec !== 1 && codec !== 4) malformed(`codec ${codec}`);
  const decode = codec === 4 ? decodeRiceGrid : decodeGrid;
  const bits = view.getUint8(at + 11);
  if (bits < 8 || bits > 16) malformed(`${bits} bits`);
  const cols = view.getUint16(at + 40, true), rows = view.getUint16(at + 42, true);
  const origin = [0, 1, 2].map((axis) => view.getFloat32(at + 44 + 4 * axis, true));
  const quantum = view.getFloat32(at + 56, true);
  // A positive, normal power of two has neither sign nor fraction bits, and an exponent of neither zeros nor ones.
  const quantumBits = view.getUint32(at + 56, true), exponent = quantumBits >>> 23;
  const reach = quantum * (2 ** bits - 1);
  if ((quantumBits & 0x807fffff) !== 0 || exponent === 0 || exponent === 255 ||
      !origin.every((value) => Math.abs(value) + reach <= MAX_FLOAT)) malformed('unusable origin or quantum');
  const from = /** @type {Vector} */ (origin.map((value) => (local ? LOCAL_GRID * Math.round(value / LOCAL_GRID) || 0 : 0)));
  return {
    cloth: view.getUint32(at + 12, true),
    level: view.getUint8(at + 36),
    simulatedLevel: view.getUint8(at + 37),
    rows,
    cols,
    quantum,
    origin: from,
    positions: decode(payload, rows, cols, bits, origin.map((value, axis) => value - from[axis]), quantum),
    torn: [],
  };
}

/**
 * Codec 3: gaps between the torn faces of a cloth whose record came before.
 * @param {DataView} view @param {number} at where the record begins @param {Uint8Array} payload @param {Cloth[]} cloths
 */
function readTears(view, at, payload, cloths) {
  if (view.getUint8(at + 10) !== 3) malformed(`codec ${view.getUint8(at + 10)}`);
  const index = view.getUint32(at + 12, true), cols = view.getUint16(at + 40, true), rows = view.getUint16(at + 42, true);
  const cloth = cloths.find((each) => each.cloth === index);
  if (!cloth || cloth.cols !== cols || cloth.rows !== rows) malformed('tears of no mesh before them');
  const faces = (rows - 1) * (cols - 1);
  for (let i = 0, next = 0; i < payload.length;) {
    let gap = 0;
    for (let shift = 0, more = true; more; shift += 7) {
      if (i === payload.length || shift > 14) malformed('unreadable gap between tears');
      more = (payload[i] & 0x80) !== 0;
      gap |= (payload[i++] & 0x7f) << shift;
    }
    if (gap >= faces - next) malformed('tear beyond the mesh');
    cloth.torn.push(next + gap);
    next += gap + 1;
  }
}

/**
 * The payload of a list of `things`, `size` bytes each.
 * @param {DataView} view @param {number} at where the record begins @param {Uint8Array} payload @param {string} things @param {number} size @returns {DataView}
 */
function readList(view, at, payload, things, size) {
  if (view.getUint8(at + 10) !== 2) malformed(`codec ${view.getUint8(at + 10)}`);
  const count = view.getUint16(at + 40, true);
  if (view.getUint16(at + 42, true) !== 1) malformed(`${things} in more than one row`);
  if (payload.length !== count * size) malformed(`${things} of another length than their number`);
  return new DataView(payload.buffer, payload.byteOffset, payload.length);
}

/** @param {DataView} view @param {number} at where the record begins @param {Uint8Array} payload @returns {MovedObstacle[]} */
function readObstacles(view, at, payload) {
  const data = readList(view, at, payload, 'obstacles', OBSTACLE_BYTES);
  const obstacles = [];
  for (let from = 0; from < payload.length; from += OBSTACLE_BYTES) {
    const numbers = Array.from({ length: 7 }, (_, i) => data.getFloat32(from + 4 + 4 * i, true));
    if (!numbers.every(Number.isFinite)) malformed('obstacle is not finite');
    obstacles.push({ obstacle: data.getUint32(from, true), position: /** @type {Vector} */ (numbers.slice(0, 3)),
      quaternion: /** @type {MovedObstacle['quaternion']} */ (numbers.slice(3)) });
  }
  return obstacles;
}

/** @param {DataView} view @param {number} at where the record begins @param {Uint8Array} payload @returns {Ball[]} */
function readBalls(view, at, payload) {
  const data = readList(view, at, payload, 'balls', BALL_BYTES);
  const balls = [];
  for (let from = 0; from < payload.length; from += BALL_BYTES) {
    const [x, y, z, radius] = [4, 8, 12, 16].map((offset) => data.getFloat32(from + offset, true));
    const motion = data.getUint32(from + 20, true);
    if (![x, y, z, radius].every(Number.isFinite)) malformed('ball is not finite');
    if (motion > 1) malformed(`ball with motion ${motion}`);
    balls.push({ ball: data.getUint32(from, true), position: /** @type {Vector} */ ([x, y, z]), radius,
      motion: /** @type {Ball['motion']} */ (motion ? 'dynamic' : 'kinematic') });
  }
  return balls;
}
