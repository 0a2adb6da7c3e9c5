import {Plane, Raycaster, Vector2, Vector3} from './three/three.module.js';
import {ThrowSpeed} from './throw_speed.js';

const kMoveMs = 33;       // between two ball.move while dragging
const kSlowest = 0.6;     // m/s; let go slower than this and the ball stays where it is
const kFastest = 25;      // m/s

/** Takes a ball with mouse or finger, moves it on the plane through it that faces the camera, and throws it on release in motion. */
export class BallHand {
  /**
   * @param {import('./stage.js').Stage} stage
   * @param {import('./balls_view.js').BallsView} balls
   * @param {{move: (ball: number, position: number[]) => void, throw: (ball: number, velocity: number[]) => void,
   *          taken: (ball: number) => void, holding: (holds: boolean) => void}} actions
   */
  constructor(stage, balls, actions) {
    this.stage = stage;
    this.balls = balls;
    this.actions = actions;
    this.canvas = stage.renderer.domElement;
    this.raycaster = new Raycaster();
    this.drag = null;
    // Capture: the ball comes before the orbit.
    this.canvas.addEventListener('pointerdown', (event) => this.#take(event), {capture: true});
    this.canvas.addEventListener('pointermove', (event) => this.#move(event));
    this.canvas.addEventListener('pointerup', (event) => this.#release(event, true));
    this.canvas.addEventListener('pointercancel', (event) => this.#release(event, false));
  }

  /** The newest record of the ball drawn at a point of the window, or undefined. */
  ballAt(x, y) {
    return this.#hit(x, y)?.object.userData.ball;
  }

  #aim(x, y) {
    const box = this.canvas.getBoundingClientRect();
    const point = new Vector2(((x - box.left) / box.width) * 2 - 1, 1 - ((y - box.top) / box.height) * 2);
    this.raycaster.setFromCamera(point, this.stage.camera);
  }

  #hit(x, y) {
    this.#aim(x, y);
    return this.raycaster.intersectObjects(this.balls.group.children, false)[0] ?? null;
  }

  #take(event) {
    if (event.button !== 0 || this.drag) return;
    const hit = this.#hit(event.clientX, event.clientY);
    if (!hit) return;
    const {ball} = hit.object.userData;
    const facing = this.stage.camera.getWorldDirection(new Vector3());
    this.drag = {
      pointer: event.pointerId,
      ball: ball.ball,
      plane: new Plane().setFromNormalAndCoplanarPoint(facing, hit.point),
      offset: hit.object.position.clone().sub(hit.point),  // the hand keeps its place on the ball
      speed: new ThrowSpeed(),
      sentMs: 0,
      pending: null,
      moved: false,
    };
    this.canvas.setPointerCapture(event.pointerId);
    this.actions.holding(true);
    this.actions.taken(ball.ball);
    this.canvas.style.cursor = 'grabbing';
  }

  #move(event) {
    if (!this.drag) {
      if (event.pointerType === 'mouse') this.canvas.style.cursor = event.buttons === 0 && this.#hit(event.clientX, event.clientY) ? 'grab' : '';
      return;
    }
    if (event.pointerId !== this.drag.pointer) return;
    this.#aim(event.clientX, event.clientY);
    const point = this.raycaster.ray.intersectPlane(this.drag.plane, new Vector3());
    if (!point) return;  // the plane is behind the camera
    const position = point.add(this.drag.offset).toArray();
    this.drag.moved = true;
    this.drag.speed.add(position, event.timeStamp);
    this.drag.pending = position;
    this.#flush(event.timeStamp);
  }

  #flush(nowMs) {
    if (!this.drag.pending || nowMs - this.drag.sentMs < kMoveMs) return;
    this.actions.move(this.drag.ball, this.drag.pending);
    this.drag.sentMs = nowMs;
    this.drag.pending = null;
  }

  #release(event, mayThrow) {
    const {drag} = this;
    if (!drag || event.pointerId !== drag.pointer) return;
    this.drag = null;
    this.actions.holding(false);
    this.canvas.style.cursor = '';
    if (!drag.moved) return;
    const velocity = drag.speed.velocity(event.timeStamp, kFastest);
    if (mayThrow && Math.hypot(...velocity) > kSlowest) this.actions.throw(drag.ball, velocity);
    else if (drag.pending) this.actions.move(drag.ball, drag.pending);
  }
}
