const kSlowest = 0.6;  // m/s; let go slower than this and nothing is thrown

/**
 * @typedef {object} Sender
 * @property {import('../protocol/weft.js').Commands} commands
 * @property {<T>(reply: Promise<T>, expected?: string) => Promise<T|null>} ask the reply, or null; `expected`: a code that is no news
 *
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
  /** @param {Sender} sender @param {{ball: number, position: number[], motion: string}} record */
  constructor(sender, {ball, position, motion}) {
    this.commands = sender.commands;
    this.ask = sender.ask;
    this.ball = ball;
    this.place = position;
    this.flew = motion === 'dynamic';
  }

  move(position) {
    this.ask(this.commands.moveBall(this.ball, position));
  }

  letGo(velocity) {
    if (fast(velocity) || this.flew) this.ask(this.commands.throwBall(this.ball, velocity ?? [0, 0, 0]));
  }
}

/** @implements {Grip} Puts an obstacle without a mass where the hand is; it stays there. */
export class ObstacleGrip {
  /** @param {Sender} sender @param {number} obstacle @param {number[]} position its place now, m */
  constructor(sender, obstacle, position) {
    this.commands = sender.commands;
    this.ask = sender.ask;
    this.obstacle = obstacle;
    this.place = position;
  }

  move(position) {
    this.ask(this.commands.moveObstacle(this.obstacle, position));
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
   * @param {Sender} sender
   * @param {{obstacle: number, mass: number, point: number[], place: number[]}} taken `point` of its own axes, which is at `place`, m
   */
  constructor(sender, {obstacle, mass, point, place}) {
    this.commands = sender.commands;
    this.ask = sender.ask;
    this.obstacle = obstacle;
    this.hold = {point, maxForce: Math.min(kMaxForce, kWeights * kGravity * mass)};
    this.place = place;
    this.grab = undefined;  // null until the server has answered
    this.wanted = null;     // where, as soon as it has
    this.open = false;
  }

  move(position) {
    if (this.grab === undefined) this.#take(position);
    else if (this.grab === null) this.wanted = position;
    else this.ask(this.commands.moveGrab(this.grab, position), 'not_found');  // a reset by somebody else may have ended it
  }

  letGo(velocity) {
    this.open = true;
    this.thrown = fast(velocity) ? velocity : null;
    if (this.grab) this.#release();
  }

  async #take(position) {
    this.grab = null;
    const grab = await this.ask(this.commands.grabObstacle(this.obstacle, {...this.hold, position}));
    if (grab === null) return;  // refused, and told
    this.grab = grab;
    if (this.wanted) this.move(this.wanted);
    if (this.open) this.#release();
  }

  #release() {
    this.ask(this.commands.release(this.grab), 'not_found');
    if (this.thrown) this.ask(this.commands.throwObstacle(this.obstacle, this.thrown));
  }
}
