const kSlowest = 0.6;  // m/s; let go slower than this and nothing is thrown

/**
 * What a hand does to a thing that it drags, as commands: one class for each kind of thing.
 *
 * @typedef {object} Grip
 * @property {number[]} place of what it drags when it was taken, m
 * @property {(place: number[]) => void} move it is wanted there; the first call takes it
 * @property {(velocity: number[]|null) => void} letGo at the hand's speed, m/s; null where the hand was lost, not opened
 */

const fast = (velocity) => velocity !== null && Math.hypot(...velocity) > kSlowest;

/** @implements {Grip} Puts a ball where the hand is. Thrown it flies off; let go at rest it stays, unless it flew when it was taken. */
export class BallGrip {
  /** @param {(message: object) => Promise<object|null>} command @param {{ball: number, position: number[], motion: string}} record */
  constructor(command, {ball, position, motion}) {
    this.command = command;
    this.ball = ball;
    this.place = position;
    this.flew = motion === 'dynamic';
  }

  move(position) {
    this.command({op: 'ball.move', ball: this.ball, position});
  }

  letGo(velocity) {
    if (fast(velocity) || this.flew) this.command({op: 'ball.throw', ball: this.ball, velocity: velocity ?? [0, 0, 0]});
  }
}

/** @implements {Grip} Puts an obstacle without a mass where the hand is; it stays there. */
export class ObstacleGrip {
  /** @param {(message: object) => Promise<object|null>} command @param {number} obstacle @param {number[]} position its place now, m */
  constructor(command, obstacle, position) {
    this.command = command;
    this.obstacle = obstacle;
    this.place = position;
  }

  move(position) {
    this.command({op: 'obstacle.move', obstacle: this.obstacle, position});
  }

  letGo() {}
}

const kWeights = 10;       // the force of the hand, in weights of the body
const kMaxForce = 1e4;     // N, the protocol's bound
const kGravity = 9.81;

/**
 * @implements {Grip} Pulls a body at the point it took by a bounded force: it gives way to what is in its way, and falls or flies on
 * when it is let go.
 */
export class BodyGrip {
  /**
   * @param {(message: object, expected?: string) => Promise<object|null>} command `expected`: a code that is no news
   * @param {{obstacle: number, mass: number, point: number[], place: number[]}} taken `point` of its own axes, which is at `place`, m
   */
  constructor(command, {obstacle, mass, point, place}) {
    this.command = command;
    this.taken = {obstacle, point, max_force: Math.min(kMaxForce, kWeights * kGravity * mass)};
    this.place = place;
    this.grab = undefined;  // null until the server has answered
    this.wanted = null;     // where, as soon as it has
    this.open = false;
  }

  move(position) {
    if (this.grab === undefined) this.#take(position);
    else if (this.grab === null) this.wanted = position;
    else this.command({op: 'grab.move', grab: this.grab, position}, 'not_found');  // a reset by somebody else may have ended it
  }

  letGo(velocity) {
    this.open = true;
    this.thrown = fast(velocity) ? velocity : null;
    if (this.grab) this.#release();
  }

  async #take(position) {
    this.grab = null;
    const {grab} = (await this.command({op: 'obstacle.grab', ...this.taken, position})) ?? {};
    if (grab === undefined) return;  // refused, and told
    this.grab = grab;
    if (this.wanted) this.move(this.wanted);
    if (this.open) this.#release();
  }

  #release() {
    this.command({op: 'grab.release', grab: this.grab}, 'not_found');
    if (this.thrown) this.command({op: 'obstacle.throw', obstacle: this.taken.obstacle, velocity: this.thrown});
  }
}
