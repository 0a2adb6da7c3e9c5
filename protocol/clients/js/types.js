/** What frames and messages hold (PROTOCOL.md sections 3 and 4), and what a connection is told. */

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

/**
 * @typedef {{code?: number, reason?: string, error?: Error, delay?: number}} Why
 * @typedef {object} Options
 * @property {any} [WebSocket] the class to connect with; default: the platform's, else package `ws`
 * @property {(frame: Frame) => void | Promise<void>} [onframe] the newest frame; acknowledged when this has returned (or its
 *   promise is settled), frames that arrive meanwhile replace each other
 * @property {(message: any) => void} [onmessage] every message that answers no request: `welcome`, `scene`, `event`,
 *   `stats`, `curve`, `notice`, and `error` without `re`
 * @property {(state: 'open'|'waiting'|'closed', why: Why) => void} [onstate]
 *   `open` after each (re)connection, `waiting` before each attempt to reconnect (after `delay` ms), `closed` at the end
 * @property {(error: Error) => void} [onerror] malformed frames, and what onframe throws; default: console.error
 * @property {string} [client] name told to the server
 * @property {string} [token] the server's, where it asks for one: 16 to 128 letters, digits or any of "-._~"
 * @property {number} [window] unacknowledged frames, 1..8 (default 2), beside those that the way has room for; 0: no flow
 *   control, the server sends as fast as it can
 * @property {boolean} [coarser] cloths may be sent at coarser levels than the camera asks for, where the link carries too few
 *   frames (default false)
 * @property {boolean} [compact] frames a fifth smaller and more, which take three times as long to decode: 65 x 65 nodes 0.9 ms
 *   (default false)
 * @property {boolean} [local] as decodeFrame's (default false)
 * @property {number} [timeout] ms to wait for a connection or a reply (default 5000)
 * @property {boolean} [reconnect] come back after a lost connection, and keep trying at first: 0.25 s, doubled up to 10 s,
 *   jittered (default false)
 */

export {};
