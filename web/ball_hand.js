import {Plane, Vector3} from './three/three.module.js';
import {Pointing} from './pointing.js';
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
    this.pointing = new Pointing(stage);
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

  #hit(x, y) {
    return this.pointing.hit(x, y, this.balls.group.children);
  }

  #take(event) {
    if (event.button !== 0 || this.drag) return;
    const hit = this.#hit(event.clientX, event.clientY);
    if (!hit) return;
    const {ball} = hit.object.userData;
    const centre = hit.object.position.clone();
    this.drag = {
      pointer: event.pointerId,
      ball: ball.ball,
      plane: new Plane().setFromNormalAndCoplanarPoint(this.stage.camera.getWorldDirection(new Vector3()), centre),
      offset: new Vector3(),
      speed: new ThrowSpeed(),
      pending: null,
      timer: null,
      moved: false,
    };
    const hand = new Vector3(...this.#placeAt(event));
    this.drag.offset.subVectors(centre, hand);  // it keeps its place on the ball
    this.drag.speed.add(centre.toArray(), event.timeStamp);
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
    // A slow picture bundles the hand's movements into one event: all of them count for the speed of a throw.
    const moves = event.getCoalescedEvents?.() ?? [];
    for (const each of moves.length > 0 ? moves : [event]) {
      const position = this.#placeAt(each);
      if (!position) continue;  // the plane is behind the camera
      this.drag.speed.add(position, each.timeStamp);
      this.drag.pending = position;
    }
    this.drag.moved = true;
    if (this.drag.timer === null) this.#send();
  }

  #placeAt({clientX, clientY}) {
    return this.pointing.ray(clientX, clientY).intersectPlane(this.drag.plane, new Vector3())?.add(this.drag.offset).toArray();
  }

  /** Sends where the ball is wanted, now and then as long as that changes. */
  #send(drag = this.drag) {
    drag.timer = null;
    if (!drag.pending) return;
    this.actions.move(drag.ball, drag.pending);
    drag.pending = null;
    drag.timer = setTimeout(() => this.#send(drag), kMoveMs);
  }

  #release(event, mayThrow) {
    const {drag} = this;
    if (!drag || event.pointerId !== drag.pointer) return;
    this.drag = null;
    clearTimeout(drag.timer);
    this.actions.holding(false);
    this.canvas.style.cursor = '';
    if (!drag.moved) return;
    const velocity = drag.speed.velocity(event.timeStamp, kFastest);
    if (mayThrow && Math.hypot(...velocity) > kSlowest) this.actions.throw(drag.ball, velocity);
    else if (drag.pending) this.actions.move(drag.ball, drag.pending);
  }
}
