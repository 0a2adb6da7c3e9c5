import {Plane, Vector3} from '../three/three.module.js';
import {BallGrip, BodyGrip, ObstacleGrip} from './grips.js';
import {handOver, isHandedOver, meansCamera} from './two_fingers.js';
import {Pointing} from './pointing.js';
import {ThrowSpeed} from './throw_speed.js';

const kMoveMs = 33;   // between two commands while dragging
const kFastest = 25;  // m/s, of a throw
const kFingerPixels = 14;  // beside a thing, from where a finger still takes it

/**
 * Takes a ball or an obstacle with mouse or finger, drags it on the plane through the point it took that faces the camera, and lets
 * go: what flies is thrown by a hand in motion. What it does to which thing, grips.js says.
 */
export class BodyHand {
  /**
   * @param {import('../view/stage.js').Stage} stage
   * @param {import('../app/show.js').Show} show
   * @param {import('./grips.js').Sender & {taken: (thing: {ball?: number, obstacle?: number}) => void,
   *          holding: (holds: boolean) => void}} actions
   */
  constructor(stage, show, actions) {
    this.stage = stage;
    this.show = show;
    this.actions = actions;
    this.canvas = stage.renderer.domElement;
    this.pointing = new Pointing(stage);
    this.drag = null;
    // Capture: bodies come before the orbit.
    this.canvas.addEventListener('pointerdown', (event) => this.#take(event), {capture: true});
    this.canvas.addEventListener('pointermove', (event) => this.#move(event));
    this.canvas.addEventListener('pointerup', (event) => this.#release(event, true));
    for (const lost of ['pointercancel', 'lostpointercapture']) this.canvas.addEventListener(lost, (event) => this.#release(event, false));
  }

  /** What is drawn at a point of the window and can be dragged: `{ball}` or `{obstacle}`, or null. */
  thingAt(x, y) {
    const hit = this.#hit(x, y);
    if (!hit) return null;
    const {ball, obstacle} = hit.object.userData;
    return ball ? {ball: ball.ball} : {obstacle};
  }

  /** The server holds nothing any more, as after a reset. */
  forget() {
    const grip = this.drag?.grip;
    this.#end();
    if (grip instanceof BodyGrip) grip.letGo(null);  // it may be about to take hold
  }

  /** A ball, were it behind a cloth; or an obstacle, unless a cloth is before it. Planes are the ground that all stands on. */
  #hit(x, y) {
    const at = (objects) => this.pointing.hit(x, y, objects);
    const ball = at(this.show.balls.group.children);
    const obstacle = at(this.show.obstacles.group.children);
    if (ball && !(obstacle?.distance < ball.distance)) return ball;
    if (!obstacle || obstacle.object.userData.home.shape === 'plane') return null;
    return at(this.show.clothMeshes())?.distance < obstacle.distance ? null : obstacle;
  }

  /** A finger covers what it points at: what is just beside it is meant, too. */
  #hitByFinger(x, y) {
    let hit = this.#hit(x, y);
    for (let i = 0; !hit && i < 8; ++i) {
      hit = this.#hit(x + kFingerPixels * Math.cos((i * Math.PI) / 4), y + kFingerPixels * Math.sin((i * Math.PI) / 4));
    }
    return hit;
  }

  #gripOf({object, point}) {
    const {ball, obstacle, home, now} = object.userData;
    if (ball) return new BallGrip(this.actions, ball);
    if (!home.mass) return new ObstacleGrip(this.actions, obstacle, now.position);
    const place = point.toArray();
    return new BodyGrip(this.actions, {obstacle, mass: home.mass, point: object.worldToLocal(point.clone()).toArray(), place});
  }

  #take(event) {
    if (event.button !== 0 || isHandedOver(event)) return;
    if (this.drag) {
      if (meansCamera(event, this.drag)) this.#giveToCamera();
      return;
    }
    if (!event.isPrimary) return;  // the second finger of a camera's two
    const hit = event.pointerType === 'touch' ? this.#hitByFinger(event.clientX, event.clientY) : this.#hit(event.clientX, event.clientY);
    if (!hit) return;
    const grip = this.#gripOf(hit);
    const place = new Vector3(...grip.place);
    this.drag = {
      pointer: event.pointerId,
      pressed: event,
      grip,
      mesh: hit.object,
      plane: new Plane().setFromNormalAndCoplanarPoint(this.stage.camera.getWorldDirection(new Vector3()), place),
      offset: new Vector3(),
      speed: new ThrowSpeed(),
      pending: null,
      timer: null,
      moved: false,
    };
    const hand = new Vector3(...this.#placeAt(event));
    this.drag.offset.subVectors(place, hand);  // it keeps its place on the body
    this.drag.speed.add(grip.place, event.timeStamp);
    this.canvas.setPointerCapture(event.pointerId);
    this.actions.holding(true);
    const {ball, obstacle} = hit.object.userData;
    this.actions.taken(ball ? {ball: ball.ball} : {obstacle});
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
    this.#showHand();
    if (this.drag.timer === null) this.#send();
  }

  #placeAt({clientX, clientY}) {
    return this.pointing.ray(clientX, clientY).intersectPlane(this.drag.plane, new Vector3())?.add(this.drag.offset).toArray();
  }

  /** A body may lag behind the hand that pulls it: both are shown. */
  #showHand() {
    const {grip, mesh, pending} = this.drag;
    if (grip instanceof BodyGrip && pending) this.show.marks.setHand({position: pending, mesh, point: grip.hold.point});
  }

  /** Sends where the thing is wanted, now and then as long as that changes. */
  #send(drag = this.drag) {
    drag.timer = null;
    if (!drag.pending) return;
    drag.grip.move(drag.pending);
    drag.pending = null;
    drag.timer = setTimeout(() => this.#send(drag), kMoveMs);
  }

  #release(event, opened) {
    const {drag} = this;
    if (!drag || event.pointerId !== drag.pointer) return;
    this.#end();
    if (!drag.moved) return;
    if (drag.pending) drag.grip.move(drag.pending);
    drag.grip.letGo(opened ? drag.speed.velocity(event.timeStamp, kFastest) : null);
  }

  /** The first of two fingers lets go: together they move the camera. */
  #giveToCamera() {
    const {drag} = this;
    this.#end();
    if (drag.grip instanceof BodyGrip) drag.grip.letGo(null);
    handOver(this.canvas, drag.pressed);
  }

  #end() {
    if (!this.drag) return;
    clearTimeout(this.drag.timer);
    if (this.drag.grip instanceof BodyGrip) this.show.marks.setHand(null);
    this.drag = null;
    this.actions.holding(false);
    this.canvas.style.cursor = '';
  }
}
