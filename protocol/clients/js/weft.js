/**
 * Weft client: the protocol of PROTOCOL.md (weft.v1) for pages, workers and Node.
 *
 *   import { connect } from './weft.js';
 *   const weft = await connect('ws://127.0.0.1:8080/v1/scenes/flag', { onframe: (frame) => draw(frame) });
 *   await weft.camera({ distance: 5 });
 *   const ball = await weft.addBall({ position: [0, 1, 2], radius: 0.2 });
 *   await weft.throwBall(ball, [0, 0, -6]);
 *   weft.close();
 */

export const SUBPROTOCOL = 'weft.v1';

/**
 * @typedef {[number, number, number]} Vector
 * @typedef {object} Stamp
 * @property {number} f steps since the epoch began
 * @property {number} epoch +1 at each reset: never interpolate between epochs
 * @property {number} time simulated, s
 * @property {number} serverMs the server's monotonic clock, ms, modulo 2^32
 * @property {boolean} paused
 * @property {boolean} slow the scene's clock runs behind real time
 * @typedef {object} Cloth
 * @property {number} cloth index in the scene
 * @property {number} level of this mesh
 * @property {number} simulatedLevel level at which the cloth is simulated
 * @property {number} rows nodes along v
 * @property {number} cols nodes along u
 * @property {number} quantum m: positions are exact to half of it
 * @property {Vector} origin in the world, m: positions are from there; [0, 0, 0] unless decoded with `local`
 * @property {Float32Array} positions x, y, z interleaved, row by row, m
 * @property {number[]} torn faces not to be drawn, ascending: r * (cols - 1) + c is the cell right of and below node (r, c)
 * @typedef {{ball: number, position: Vector, radius: number, motion: 'kinematic'|'dynamic', friction?: number}} Ball friction: in `scene` and events
 * @typedef {{shape: 'plane', position: Vector, normal: Vector}} Plane
 * @typedef {{shape: 'box', position: Vector, size: Vector, quaternion: [number, number, number, number]}} Box w, x, y, z
 * @typedef {{shape: 'capsule', position: Vector, radius: number, length: number, quaternion: [number, number, number, number]}} Capsule w, x, y, z
 * @typedef {{shape: 'box'|'sphere', position: Vector, size?: Vector, radius?: number, quaternion?: [number, number, number, number], velocity: Vector, edge: number}} WindZone
 * @typedef {{shape: 'mesh'|'convex', position: Vector, vertices: number, triangles: number, quaternion: [number, number, number, number]}} Mesh
 *   how many there are: `surface` has them; w, x, y, z
 * @typedef {{vertices: number[], triangles: number[]}} Surface x, y, z of each vertex in the mesh's own axes, m; three vertices a triangle,
 *   counterclockwise as seen from outside
 * @typedef {(Plane|Box|Capsule|Mesh) & {friction?: number}} Obstacle in `scene`; skip shapes that you do not know
 * @typedef {{obstacle: number, position: Vector, quaternion: [number, number, number, number]}} MovedObstacle its place in `scene`; w, x, y, z
 * @typedef {{stamp: Stamp, cloths: Cloth[], balls: Ball[], obstacles: MovedObstacle[]}} Frame obstacles: those that are not where `scene` says
 */

/** A request refused by the server, or a connection that failed: `code` is one of PROTOCOL.md's, or `closed`, `timeout`, `connect`. */
export class WeftError extends Error {
  /** @param {string} code @param {string} message @param {string} [path] JSON pointer into the request */
  constructor(code, message, path = '') {
    super(message);
    this.name = 'WeftError';
    this.code = code;
    this.path = path;
  }
}

// --- Frames (PROTOCOL.md section 4) ---

const HEADER_BYTES = 64;
const FLAG_LAST = 1, FLAG_PAUSED = 2, FLAG_SLOW = 4;
const GROUP = 16;       // values that share a width
const MAX_WIDTH = 18;   // residuals of 16-bit values, zig-zagged, lie below 2^18
const MIN_SIDE = 2, MAX_SIDE = 1025;
const BALL_BYTES = 24;
const OBSTACLE_BYTES = 32;
const MAX_FLOAT = 3.4028234663852886e38;
const LOCAL_GRID = 16;  // m, what origins are multiples of: from frame to frame mostly the same

/** @returns {never} */
function malformed(reason) {
  throw new WeftError('bad_frame', reason);
}

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

/** @returns {Stamp} */
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

/** @returns {Cloth} */
function readCloth(view, at, payload, local) {
  if (view.getUint8(at + 10) !== 1) malformed(`codec ${view.getUint8(at + 10)}`);
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
    positions: decodeGrid(payload, rows, cols, bits, origin.map((value, axis) => value - from[axis]), quantum),
    torn: [],
  };
}

/** Codec 3: gaps between the torn faces of a cloth whose record came before. @param {Cloth[]} cloths */
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

/** Codec 1: three axes of zig-zagged residuals in groups of 16. */
function decodeGrid(payload, rows, cols, bits, origin, quantum) {
  if (rows < MIN_SIDE || rows > MAX_SIDE || cols < MIN_SIDE || cols > MAX_SIDE) malformed(`grid of ${rows} rows and ${cols} columns`);
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

/** The payload of a list of `things`, `size` bytes each. @returns {DataView} */
function readList(view, at, payload, things, size) {
  if (view.getUint8(at + 10) !== 2) malformed(`codec ${view.getUint8(at + 10)}`);
  const count = view.getUint16(at + 40, true);
  if (view.getUint16(at + 42, true) !== 1) malformed(`${things} in more than one row`);
  if (payload.length !== count * size) malformed(`${things} of another length than their number`);
  return new DataView(payload.buffer, payload.byteOffset, payload.length);
}

/** @returns {MovedObstacle[]} */
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

/** @returns {Ball[]} */
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

// --- Control messages (PROTOCOL.md sections 2 and 3) ---

/**
 * A client message as JSON text: op, id, then the members that are not undefined.
 * @param {string} op @param {object} [members] @param {number} [id]
 */
export function messageText(op, members = {}, id = undefined) {
  return JSON.stringify({ op, id, ...members }, (name, value) => {
    // JSON would turn these into null, and the server's answer would puzzle.
    if (typeof value === 'number' && !Number.isFinite(value)) throw new WeftError('range', `${name} is ${value}; allowed: finite numbers`);
    return value;
  });
}

/** A method for each operation, whatever carries them: who extends it sends. */
export class Commands {
  /** Sends a request and gives its `ok` or `pong`. @param {string} op @param {object} [members] @returns {Promise<any>} */
  send(op, members) {
    throw new WeftError('closed', `nothing carries ${op}, ${JSON.stringify(members)}`);
  }

  // operations: generated by protocol/spec/generate.py from operations.json
  /**
   * Asks which scenes there are.
   * @returns {Promise<{name: string, title: string, viewers: number, cloths: number}[]>}
   */
  async listScenes() {
    return (await this.send('scene.list')).scenes;
  }

  /**
   * Leaves the scene and joins another. `ok`, then `scene`, then its frames. Capabilities stay.
   * @param {string} scene its name
   */
  joinScene(scene) {
    return this.send('scene.join', { scene });
  }

  /**
   * Takes over what this client held before its connection broke. `seat` is that of the `scene` message before.
   * Whoever left without closing the WebSocket is waited for 5 s, as well when the server itself was restarted (with
   * `--data`); until then its hands hold on. `ok` has the ids of `grabs` that are this viewer's now.
   * @param {string} seat from `scene`
   */
  resumeSeat(seat) {
    return this.send('seat.resume', { seat });
  }

  /**
   * Tells where this viewer's camera is. Decides the level of each cloth (Eq. 7) for this viewer and, with `target`
   * and `half_angle`, what it has in sight: all within that angle of the line from the eye to the target. Without
   * them it sees in every direction.
   * @param {{distance?: number, eye?: Vector, target?: Vector, halfAngle?: number}} [options] distance: from the cloths, 0..1e6 m; eye: where the camera is, m; target: what it looks at, another point than the eye, m; halfAngle: how far from the line to the target it sees, 0.001..3.14 rad
   */
  camera({ distance, eye, target, halfAngle } = {}) {
    return this.send('camera', { distance, eye, target, half_angle: halfAngle });
  }

  /**
   * A ball comes in.
   * @param {Vector} position m
   * @param {number} radius at most the diagonal of the scene's largest cloth, 0.01..10 m
   * @param {{velocity?: Vector, motion?: 'kinematic'|'dynamic', mass?: number, friction?: number}} [options] velocity: m/s; motion: it stands or is moved, or it flies; mass: of a dynamic ball, 0.001..10000 kg; friction: Coulomb's coefficient, 0..10
   * @returns {Promise<number>} its id
   */
  async addBall(position, radius, { velocity, motion, mass, friction } = {}) {
    return (await this.send('ball.add', { position, radius, velocity, motion, mass, friction })).ball;
  }

  /**
   * The ball becomes kinematic and goes there within one step.
   * @param {number} ball a ball's id, as `ball.add` gave it
   * @param {Vector} position m
   */
  moveBall(ball, position) {
    return this.send('ball.move', { ball, position });
  }

  /**
   * The ball becomes dynamic and flies off.
   * @param {number} ball a ball's id, as `ball.add` gave it
   * @param {Vector} velocity m/s
   */
  throwBall(ball, velocity) {
    return this.send('ball.throw', { ball, velocity });
  }

  /**
   * The ball is gone.
   * @param {number} ball a ball's id, as `ball.add` gave it
   */
  removeBall(ball) {
    return this.send('ball.remove', { ball });
  }

  /**
   * The obstacle leaves its path, goes there within one step and stays.
   * @param {number} obstacle its place in `scene`'s `obstacles`, from 0
   * @param {Vector} position m
   * @param {{quaternion?: [number, number, number, number]}} [options] quaternion: w, x, y, z: its own axes to the world's, any but zero, normalised; without one it keeps its turn; planes keep their normal
   */
  moveObstacle(obstacle, position, { quaternion } = {}) {
    return this.send('obstacle.move', { obstacle, position, quaternion });
  }

  /**
   * An obstacle that has a `mass` becomes dynamic, leaves its path and flies off.
   * @param {number} obstacle its place in `scene`'s `obstacles`, from 0
   * @param {Vector} velocity m/s
   * @param {{spin?: Vector}} [options] spin: about the world's axes, rad/s
   */
  throwObstacle(obstacle, velocity, { spin } = {}) {
    return this.send('obstacle.throw', { obstacle, velocity, spin });
  }

  /**
   * A hand takes hold of a cloth. The cloth is pulled towards the hand by at most `max_force`. Only the viewer that
   * took hold can move the hand; it lets go when that viewer leaves, and at a reset.
   * @param {number} cloth the cloth's number in `scene`
   * @param {number} u across the cloth, from its left edge, 0..1
   * @param {number} v down the cloth, from its top edge, 0..1
   * @param {{position?: Vector, maxForce?: number}} [options] position: the hand's; without one where the cloth is, m; maxForce: 0.001..10000 N
   * @returns {Promise<number>} its id
   */
  async grab(cloth, u, v, { position, maxForce } = {}) {
    return (await this.send('cloth.grab', { cloth, u, v, position, max_force: maxForce })).grab;
  }

  /**
   * A hand takes hold of an obstacle that has a `mass`. It leaves its path and falls but for the hand: the point is
   * pulled towards the hand by at most `max_force`, and turning is damped. Who may move the hand is as with
   * `cloth.grab`. After an `obstacle.move` nothing is pulled until an `obstacle.throw`.
   * @param {number} obstacle its place in `scene`'s `obstacles`, from 0
   * @param {{point?: Vector, position?: Vector, maxForce?: number}} [options] point: what is held, from the obstacle's place along its own axes, m; position: the hand's; without one where the point is, m; maxForce: 0.001..10000 N
   * @returns {Promise<number>} its id
   */
  async grabObstacle(obstacle, { point, position, maxForce } = {}) {
    return (await this.send('obstacle.grab', { obstacle, point, position, max_force: maxForce })).grab;
  }

  /**
   * The hand goes there; what it holds follows.
   * @param {number} grab an id that `cloth.grab` or `obstacle.grab` gave
   * @param {Vector} position m
   */
  moveGrab(grab, position) {
    return this.send('grab.move', { grab, position });
  }

  /**
   * The hand lets go.
   * @param {number} grab an id that `cloth.grab` or `obstacle.grab` gave
   */
  release(grab) {
    return this.send('grab.release', { grab });
  }

  /**
   * The node nearest to (u, v) is held where it is, until it is unpinned or the scene is reset.
   * @param {number} cloth the cloth's number in `scene`
   * @param {number} u across the cloth, from its left edge, 0..1
   * @param {number} v down the cloth, from its top edge, 0..1
   */
  pin(cloth, u, v) {
    return this.send('cloth.pin', { cloth, u, v });
  }

  /**
   * The pin that holds (u, v), or the nearest one, is removed.
   * @param {number} cloth the cloth's number in `scene`
   * @param {number} u across the cloth, from its left edge, 0..1
   * @param {number} v down the cloth, from its top edge, 0..1
   */
  unpin(cloth, u, v) {
    return this.send('cloth.unpin', { cloth, u, v });
  }

  /**
   * Changes numbers of a cloth's material from the next step on. The others stay. `rigidity` may be one number for
   * all three. A value that it has already changes nothing and is not told.
   * @param {number} cloth the cloth's number in `scene`
   * @param {Object<string, number|number[]>} parameters each within the range that `scene`'s `material_tunable` has for it
   */
  tuneCloth(cloth, parameters) {
    return this.send('cloth.tune', { cloth, parameters });
  }

  /**
   * Sets Coulomb's coefficient of what cloth slides on: of that ball or obstacle, or with neither of all. Between
   * two bodies the geometric mean of theirs counts.
   * @param {number} friction Coulomb's coefficient, 0..10
   * @param {{ball?: number, obstacle?: number}} [options] ball: a ball's id, as `ball.add` gave it; obstacle: its place in `scene`'s `obstacles`, from 0
   */
  setFriction(friction, { ball, obstacle } = {}) {
    return this.send('friction.set', { friction, ball, obstacle });
  }

  /**
   * Switches an effect of the scene off or on. Off, the scene is stepped as if it did not list it. A reset switches
   * all on.
   * @param {string} effect one of `scene`'s `effects`
   * @param {boolean} on
   */
  setEffect(effect, on) {
    return this.send('effect.set', { effect, on });
  }

  /**
   * Changes parameters of an effect from the next step on, also while it is off. The others stay. A `lift` that the
   * scene does not give follows `drag`. `strength` may be one number for both directions.
   * @param {string} effect one of `scene`'s `effects`
   * @param {Object<string, number|number[]>} parameters each within the range that `scene`'s `tunable` has for it
   */
  tuneEffect(effect, parameters) {
    return this.send('effect.tune', { effect, parameters });
  }

  /**
   * Sets the wind; what is left out stays as it is.
   * @param {Vector} direction any length but zero; normalised
   * @param {number} speed mean, 0..100 m/s
   * @param {{gusts?: number, turbulence?: number, timeScale?: number, lengthScale?: number}} [options] gusts: how strong gusts are: root mean square of the change over the speed, 0..1; turbulence: how strong eddies are: the same of each component, 0..1; timeScale: how long gusts last, 0.05..1000 s; lengthScale: how large eddies are, 0.01..1000 m
   */
  setWind(direction, speed, { gusts, turbulence, timeScale, lengthScale } = {}) {
    return this.send('wind.set', { direction, speed, gusts, turbulence, time_scale: timeScale, length_scale: lengthScale });
  }

  /**
   * Sets how the air moves in one of the wind's zones.
   * @param {number} zone its place in the wind's `zones`, from 0
   * @param {Vector} velocity m/s
   */
  setWindZone(zone, velocity) {
    return this.send('wind.zone.set', { zone, velocity });
  }

  /**
   * Holds the scene to an error or to a time, for all viewers; with neither it is stepped in its own way. It is
   * stepped in the cheapest way expected to stay within that error, or in the most accurate way within that wall
   * time a step. `ok` carries `quality`, as in `stats`.
   * @param {{maxError?: number, maxMs?: number}} [options] maxError: share of the cloth's size, 1e-6..1; maxMs: wall time of a step, 0.01..1000 ms
   */
  setQuality({ maxError, maxMs } = {}) {
    return this.send('quality', { max_error: maxError, max_ms: maxMs });
  }

  /** Asks what accuracy costs: `curve` follows, as soon as it is measured. */
  askCost() {
    return this.send('cost');
  }

  /** Stops the scene's clock, for all viewers. */
  pause() {
    return this.send('pause');
  }

  /** Lets the scene's clock go on, for all viewers. */
  resume() {
    return this.send('resume');
  }

  /** Puts the scene back to its start, for all viewers. `ok` carries `epoch`, the new one. */
  reset() {
    return this.send('reset');
  }

  /**
   * Steps a paused scene. `ok.f` is the step at which the scene stands still again. The steps are made as fast as
   * they go, not in real time; of their frames at most 60 a second are sent, and the last.
   * @param {number} [count] 1..600
   */
  step(count = 1) {
    return this.send('step', { count });
  }

  // operations: end
}

// --- The client ---

/**
 * @typedef {object} Options
 * @property {typeof WebSocket} [WebSocket] the class to connect with; default: the platform's, else package `ws`
 * @property {(frame: Frame) => void | Promise<void>} [onframe] the newest frame; acknowledged when this has returned (or its
 *   promise is settled), frames that arrive meanwhile replace each other
 * @property {(message: any) => void} [onmessage] every message that answers no request: `welcome`, `scene`, `event`,
 *   `stats`, `curve`, `notice`, and `error` without `re`
 * @property {(state: 'open'|'waiting'|'closed', why: {code?: number, reason?: string, error?: Error, delay?: number}) => void} [onstate]
 *   `open` after each (re)connection, `waiting` before each attempt to reconnect (after `delay` ms), `closed` at the end
 * @property {(error: Error) => void} [onerror] malformed frames, and what onframe throws; default: console.error
 * @property {string} [client] name told to the server
 * @property {string} [token] the server's, where it asks for one: 16 to 128 letters, digits or any of "-._~"
 * @property {number} [window] unacknowledged frames, 1..8 (default 2), beside those that the way has room for; 0: no flow control, the server sends as fast as it can
 * @property {boolean} [local] as decodeFrame's (default false)
 * @property {number} [timeout] ms to wait for a connection or a reply (default 5000)
 * @property {boolean} [reconnect] come back after a lost connection, and keep trying at first: 0.25 s, doubled up to 10 s,
 *   jittered (default false)
 */

const BACKOFF_FIRST_MS = 250, BACKOFF_MOST_MS = 10000;

/** Milliseconds to wait before attempt 0, 1, ...: doubled up to 10 s, and jittered down to half, so that viewers do not return in step. */
export function backoff(attempt, random = Math.random) {
  return Math.min(BACKOFF_MOST_MS, BACKOFF_FIRST_MS * 2 ** Math.min(attempt, 20)) * (0.5 + 0.5 * random());
}

/** The headers by which a request shows a token, if there is one. @param {string|null} [token] @returns {Record<string, string>} */
export const bearer = (token) => (token ? { Authorization: `Bearer ${token}` } : {});

/** One connection to one scene. Use `connect`, or construct and `open()` to have the object before the connection. */
export class WeftClient extends Commands {
  /** The server's `welcome`. @type {any} */
  welcome = null;
  /** The scene's newest `scene` message. @type {any} */
  scene = null;
  /** The newest frame. @type {Frame|null} */
  frame = null;

  #url;
  #options;
  /** @type {any} */
  #socket = null;
  #open = false;    // greeted, and not lost since
  #closed = false;  // for good
  #acks = false;
  #nextId = 1;
  /** @type {Map<number, {resolve: Function, reject: Function, timer: any}>} */
  #requests = new Map();
  #waiters = new Set();
  #newest = null;
  #delivering = false;
  #camera = null;
  /** The `scene` before the connection broke. @type {any} */
  #before = null;
  #held = new Set();   // ids of grabs that this client has not let go of
  #quickestPing = Infinity;
  #clockOffset = NaN;  // of the server's clock to this one's, ms
  /** Ends a wait between attempts early. @type {(() => void)|null} */
  #wake = null;

  /** @param {string|URL} url ws://HOST:PORT/v1/scenes/NAME @param {Options} [options] */
  constructor(url, options = {}) {
    super();
    this.#url = String(url);
    this.#options = { window: 2, timeout: 5000, onerror: (error) => console.error(error), ...options };
  }

  /** Connects; with `reconnect`, tries until it succeeds or `close()` is called. @returns {Promise<this>} */
  async open() {
    for (let attempt = 0; ; ++attempt) {
      try {
        await this.#attempt();
        return this;
      } catch (error) {
        if (this.#closed || !this.#options.reconnect) throw error;
        await this.#wait(backoff(attempt), { error });
      }
    }
  }

  /** Ends the connection for good; open requests are rejected with code `closed`. */
  close() {
    if (this.#closed) return;
    this.#end(new WeftError('closed', 'closed by this client'), { code: 1000 });
    this.#wake?.();
    this.#socket?.close(1000);
  }

  /** True while connected and greeted. */
  get connected() {
    return this.#open;
  }

  /**
   * Sends a request and gives its `ok` or `pong`; rejects with the server's `error` as a WeftError.
   * @param {string} op @param {object} [members] @returns {Promise<any>}
   */
  send(op, members = {}) {
    const id = this.#nextId;
    this.#nextId = id === 2147483647 ? 1 : id + 1;
    return new Promise((resolve, reject) => {
      const text = messageText(op, members, id);
      if (this.#socket?.readyState !== 1) throw new WeftError('closed', 'not connected');
      const timer = setTimeout(() => {
        this.#requests.delete(id);
        reject(new WeftError('timeout', `no answer to ${op} within ${this.#options.timeout} ms`));
      }, this.#options.timeout);
      this.#requests.set(id, { resolve: (ok) => resolve(this.#noted(ok)), reject, timer });
      this.#socket.send(text);
    }).finally(() => op === 'grab.release' && this.#held.delete(members.grab));
  }

  /** Sends a message that only an error would answer (to `onmessage`): for streams such as a dragged ball. Dropped while not connected. */
  post(op, members = {}) {
    const text = messageText(op, members);
    if (this.#socket?.readyState === 1) this.#socket.send(text);
  }

  /** Remembered, and told again after a reconnection. @param {{distance?: number, eye?: Vector, target?: Vector, halfAngle?: number}} [where] */
  camera(where) {
    this.#camera = where;
    return super.camera(where);
  }

  /** Leaves the scene and joins another, also for reconnections. Its `scene` message and frames follow. @param {string} scene */
  async joinScene(scene) {
    const ok = await super.joinScene(scene);
    this.#held.clear();
    this.#url = new URL(encodeURIComponent(scene), this.#url).href;
    return ok;
  }

  /** What a mesh of the scene looks like. @param {number} obstacle its place in `scene` @returns {Promise<Surface>} */
  async surface(obstacle) {
    const place = new URL(`${encodeURIComponent(this.scene.name)}/meshes/${obstacle}`, this.#url.replace(/^ws/, 'http'));
    const answer = await fetch(place, { signal: AbortSignal.timeout(this.#options.timeout), headers: bearer(this.#options.token) });
    if (!answer.ok) throw new WeftError('not_found', await answer.text());
    return answer.json();
  }

  /**
   * Round-trip time, ms. The answer comes after the replies to all commands sent before, so that it is a barrier. Each ping that is
   * quicker than those before tells better how the server's clock goes (`age`).
   */
  async ping() {
    const t = performance.now();
    const pong = await this.send('ping', { t });
    const end = performance.now();
    if (end - t < this.#quickestPing && pong.server_ms !== undefined) {
      this.#quickestPing = end - t;
      this.#clockOffset = pong.server_ms - (t + end) / 2;
    }
    return end - t;
  }

  /**
   * How long ago, ms, the server sent the frame off, to about half of the quickest ping's round trip; NaN before the first ping.
   * @param {Frame} frame
   */
  age(frame) {
    const wrap = 2 ** 32;  // of the server's clock
    const age = (performance.now() + this.#clockOffset - frame.stamp.serverMs) % wrap;
    return age - wrap * Math.round(age / wrap);
  }

  /**
   * The next frame for which `accept` is true.
   * @param {(frame: Frame) => boolean} [accept] @param {number} [timeout] ms @returns {Promise<Frame>}
   */
  nextFrame(accept = () => true, timeout = this.#options.timeout) {
    return new Promise((resolve, reject) => {
      const waiter = { accept, resolve, reject, timer: setTimeout(() => {
        this.#waiters.delete(waiter);
        reject(new WeftError('timeout', `no such frame within ${timeout} ms`));
      }, timeout) };
      this.#waiters.add(waiter);
    });
  }

  /** One attempt to connect: done when the server has greeted, sent the scene, and answered `hello`. */
  async #attempt() {
    if (this.#closed) throw new WeftError('closed', 'closed by this client');
    const { timeout, window: frames, client, token } = this.#options;
    const Socket = this.#options.WebSocket ?? globalThis.WebSocket ?? (await import('ws')).default;
    const socket = new Socket(this.#url, token ? [SUBPROTOCOL, `weft.token.${token}`] : SUBPROTOCOL);
    socket.binaryType = 'arraybuffer';
    this.#socket = socket;
    this.#before = this.scene ?? this.#before;
    this.welcome = this.scene = this.#newest = null;
    this.#acks = false;
    this.#quickestPing = Infinity;
    this.#clockOffset = NaN;
    try {
      await new Promise((resolve, reject) => {
        const timer = setTimeout(() => reject(new WeftError('timeout', `no connection to ${this.#url} within ${timeout} ms`)), timeout);
        const fail = (why) => {
          clearTimeout(timer);
          reject(new WeftError('connect', `no connection to ${this.#url}: ${why}`));
        };
        socket.addEventListener('error', (event) => fail(event.message || 'refused'));
        socket.addEventListener('close', (event) => {
          fail(event.reason || `closed with ${event.code}`);
          if (this.#socket === socket) this.#lost(event);
        });
        socket.addEventListener('message', ({ data }) => {
          if (this.#socket !== socket) return;
          this.#receive(data);
          if (this.welcome && this.scene) {
            clearTimeout(timer);
            resolve(undefined);
          }
        });
      });
      if (frames || client) await this.send('hello', { client, caps: frames ? ['flow.ack'] : [], window: frames || undefined });
      // A camera refused then is refused now; the connection is good all the same.
      if (this.#camera) await super.camera(this.#camera).catch(() => {});
      const before = this.#before;
      this.#before = null;
      if (before?.seat && before.name === this.scene.name) await this.#resume(before.seat);
      if (socket.readyState !== 1) throw new WeftError('closed', 'closed by the server');
    } catch (error) {
      socket.close();
      throw error;
    }
    this.#open = true;
    this.#options.onstate?.('open', {});
    this.#deliver();
  }

  /** The socket is closed: the end of an attempt, or of an open connection. */
  async #lost({ code, reason }) {
    const wasOpen = this.#open;
    this.#open = false;
    const error = new WeftError('closed', `connection closed with ${code}${reason ? `: ${reason}` : ''}`);
    this.#failRequests(error);
    if (this.#closed || !wasOpen) return;
    if (!this.#options.reconnect) {
      this.#end(error, { code, reason });
      return;
    }
    await this.#wait(backoff(0), { code, reason });
    // With reconnect only close() ends open() by an error, and it has told onstate.
    await this.open().catch(() => {});
  }

  /** No further connection will be made. */
  #end(error, why) {
    this.#closed = true;
    this.#open = false;
    this.#failRequests(error);
    for (const waiter of this.#waiters) {
      clearTimeout(waiter.timer);
      waiter.reject(error);
    }
    this.#waiters.clear();
    this.#options.onstate?.('closed', why);
  }

  #wait(delay, why) {
    this.#options.onstate?.('waiting', { ...why, delay });
    return new Promise((resolve) => {
      const timer = setTimeout(resolve, delay);
      this.#wake = () => {
        clearTimeout(timer);
        resolve(undefined);
      };
    });
  }

  /** An answer, after what it gave hold of is noted. */
  #noted(ok) {
    if (ok.grab !== undefined) this.#held.add(ok.grab);
    return ok;
  }

  /** Takes over what this client held before its connection broke, and lets go of what it let go of meanwhile. */
  async #resume(seat) {
    if (this.#held.size === 0) return;
    const { grabs } = await this.resumeSeat(seat).catch(() => ({ grabs: [] }));  // too late: all is released
    for (const grab of grabs) if (!this.#held.has(grab)) this.post('grab.release', { grab });
    for (const grab of this.#held) if (!grabs.includes(grab)) this.#held.delete(grab);
  }

  #failRequests(error) {
    for (const request of this.#requests.values()) {
      clearTimeout(request.timer);
      request.reject(error);
    }
    this.#requests.clear();
  }

  #receive(data) {
    if (typeof data !== 'string') {
      this.#newest = data;
      this.#deliver();
      return;
    }
    const message = JSON.parse(data);
    // Noted here and not where `hello` is awaited: a frame may follow before that code runs.
    if (message.op === 'ok' && message.caps) this.#acks = message.caps.includes('flow.ack');
    const request = this.#requests.get(message.re);
    if (request) {
      this.#requests.delete(message.re);
      clearTimeout(request.timer);
      if (message.op === 'error') request.reject(new WeftError(message.code, message.message, message.path));
      else request.resolve(message);
      return;
    }
    if (message.op === 'welcome') this.welcome = message;
    if (message.op === 'scene') this.scene = message;
    if (message.op === 'event' && message.kind === 'reset') this.#held.clear();
    this.#options.onmessage?.(message);
  }

  /** Gives the newest frame to the listeners, then acknowledges it; what comes meanwhile waits as the newest. */
  async #deliver() {
    if (this.#delivering) return;
    this.#delivering = true;
    while (this.#open && this.#newest) {
      const socket = this.#socket, data = this.#newest;
      this.#newest = null;
      try {
        const frame = decodeFrame(data, { local: this.#options.local });
        this.frame = frame;
        for (const waiter of [...this.#waiters]) {
          if (!waiter.accept(frame)) continue;
          this.#waiters.delete(waiter);
          clearTimeout(waiter.timer);
          waiter.resolve(frame);
        }
        try {
          await this.#options.onframe?.(frame);
        } finally {
          if (this.#acks && this.#socket === socket) this.post('ack', { f: frame.stamp.f });
        }
      } catch (error) {
        this.#options.onerror?.(/** @type {Error} */ (error));
      }
    }
    this.#delivering = false;
  }
}

/**
 * Connects to a scene: resolved when the server has greeted, described the scene, and agreed on the flow of frames.
 * @param {string|URL} url ws://HOST:PORT/v1/scenes/NAME @param {Options} [options] @returns {Promise<WeftClient>}
 */
export function connect(url, options = {}) {
  return new WeftClient(url, options).open();
}
