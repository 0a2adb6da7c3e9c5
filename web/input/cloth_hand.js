import {Plane, Vector3} from '../three/three.module.js';
import {Pointing} from './pointing.js';
import {handOver, isHandedOver, meansCamera} from './two_fingers.js';

const kMoveMs = 33;      // between two grab.move while dragging
const kTapPixels = 6;    // a press that moves less is a tap
const kTapsMs = 450;     // two taps within that, and within twice that way, are a double one
const kPinReach = 0.04;  // of the cloth's shorter side: a pin so near to a double tap is meant by it

/**
 * Takes hold of the cloth with mouse or finger, moves the hand on the plane through the point it took that faces the camera,
 * and lets go; a double tap pins the cloth there, or takes the pin away that is there. It does so while Shift is held or
 * the hand tool is on; anything else, and what is not cloth, is left to the ball's hand and the camera.
 */
export class ClothHand {
  /**
   * @param {import('../view/stage.js').Stage} stage
   * @param {import('../app/show.js').Show} show
   * @param {{grab: (cloth: number, u: number, v: number, position: number[]) => Promise<number|null>, move: (grab: number, position: number[]) => void,
   *          release: (grab: number) => void, pin: (cloth: number, u: number, v: number) => void, unpin: (cloth: number, u: number, v: number) => void}} actions
   */
  constructor(stage, show, actions) {
    this.show = show;
    this.actions = actions;
    this.canvas = stage.renderer.domElement;
    this.camera = stage.camera;
    this.pointing = new Pointing(stage);
    this.tool = false;
    this.hold = null;
    this.lastTap = null;
    // Capture, and no other listener after it: the cloth's hand comes before the ball's and the orbit.
    this.canvas.addEventListener('pointerdown', (event) => this.#take(event), {capture: true});
    this.canvas.addEventListener('pointermove', (event) => this.#move(event), {capture: true});
    this.canvas.addEventListener('pointerup', (event) => this.#release(event), {capture: true});
    for (const lost of ['pointercancel', 'lostpointercapture']) this.canvas.addEventListener(lost, (event) => this.#drop(event));
    addEventListener('blur', () => {
      this.letGo();
      this.#showPins(false);  // Shift may be let go elsewhere
    });
    document.addEventListener('visibilitychange', () => document.hidden && this.letGo());
    for (const key of ['keydown', 'keyup']) addEventListener(key, (event) => event.key === 'Shift' && this.#showPins(event.shiftKey));
  }

  /** Without Shift, too. */
  setTool(on) {
    this.tool = on;
    this.#showPins(false);
  }

  /** What is held, or null: `grab` is null until the server has answered. */
  get held() {
    if (!this.hold) return null;
    const {cloth, u, v, grab, position} = this.hold;
    return {cloth, u, v, grab, position};
  }

  /** Lets go of what is held. */
  letGo() {
    const {hold} = this;
    if (!hold) return;
    this.forget();
    if (hold.grab !== null) this.actions.release(hold.grab);
  }

  /** The server holds nothing any more, as after a reset. */
  forget() {
    if (!this.hold) return;
    clearTimeout(this.hold.timer);
    this.hold = null;
    this.canvas.style.cursor = '';
    this.show.marks.setHand(null);
  }

  #showPins(shift) {
    this.show.marks.setAllPins(this.tool || shift);
  }

  /** The cloth at a point of the window, unless something is before it: `{cloth, u, v, point}`. */
  #clothAt(x, y) {
    const hit = this.pointing.hit(x, y, [...this.show.clothMeshes(), ...this.show.balls.group.children]);
    const view = hit && this.show.clothOf(hit.object);
    if (!view) return null;
    const [u, v] = view.uvOf(hit.uv);
    return {cloth: view.id, u, v, point: hit.point};
  }

  #take(event) {
    if (event.button !== 0 || isHandedOver(event)) return;
    if (this.hold) {
      if (meansCamera(event, this.hold)) this.#giveToCamera();
      return;
    }
    if (!event.isPrimary || !(this.tool || event.shiftKey)) return;
    const at = this.#clothAt(event.clientX, event.clientY);
    if (!at) return;
    event.stopImmediatePropagation();
    const hold = {
      ...at,
      pointer: event.pointerId,
      pressed: event,
      plane: new Plane().setFromNormalAndCoplanarPoint(this.camera.getWorldDirection(new Vector3()), at.point),
      position: at.point.toArray(),
      grab: null,
      pending: null,
      timer: null,
      moved: false,
    };
    this.hold = hold;
    this.canvas.setPointerCapture(event.pointerId);
    this.canvas.style.cursor = 'grabbing';
    this.show.marks.setHand(this.held);
    this.actions.grab(at.cloth, at.u, at.v, hold.position).then((grab) => this.#taken(hold, grab));
  }

  #taken(hold, grab) {
    if (this.hold === hold) {
      hold.grab = grab;
      if (grab === null) this.forget();
      else this.#send(hold);
    } else if (grab !== null) {
      this.actions.release(grab);  // let go before it was known
    }
  }

  #move(event) {
    const {hold} = this;
    if (!hold) {
      if (event.pointerType !== 'mouse' || event.buttons !== 0 || !(this.tool || event.shiftKey)) return;
      if (!this.#clothAt(event.clientX, event.clientY)) return;
      event.stopImmediatePropagation();
      this.canvas.style.cursor = 'grab';
      return;
    }
    if (event.pointerId !== hold.pointer) return;
    event.stopImmediatePropagation();
    const way = Math.hypot(event.clientX - hold.pressed.clientX, event.clientY - hold.pressed.clientY);
    hold.moved ||= way > kTapPixels;
    const place = hold.moved && this.pointing.ray(event.clientX, event.clientY).intersectPlane(hold.plane, new Vector3());
    if (!place) return;  // a tap so far; or the plane is behind the camera
    hold.position = hold.pending = place.toArray();
    this.show.marks.setHand(this.held);
    if (hold.timer === null && hold.grab !== null) this.#send(hold);
  }

  /** Sends where the hand is, now and then as long as that changes. */
  #send(hold) {
    hold.timer = null;
    if (!hold.pending || this.hold !== hold) return;
    this.actions.move(hold.grab, hold.pending);
    hold.pending = null;
    hold.timer = setTimeout(() => this.#send(hold), kMoveMs);
  }

  #release(event) {
    const {hold} = this;
    if (!hold || event.pointerId !== hold.pointer) return;
    event.stopImmediatePropagation();
    if (!hold.moved) this.#tap(event, hold);
    this.letGo();
  }

  #drop(event) {
    if (event.pointerId === this.hold?.pointer) this.letGo();
  }

  /** The first of two fingers lets go: together they move the camera. */
  #giveToCamera() {
    const {pressed} = this.hold;
    this.letGo();
    handOver(this.canvas, pressed);
  }

  #tap({timeStamp, clientX, clientY}, {cloth, u, v}) {
    const last = this.lastTap;
    this.lastTap = {timeStamp, clientX, clientY};
    if (!last || timeStamp - last.timeStamp > kTapsMs) return;
    if (Math.hypot(clientX - last.clientX, clientY - last.clientY) > 2 * kTapPixels) return;
    this.lastTap = null;
    const held = this.show.pinNear(cloth, u, v, kPinReach);
    if (held) this.actions.unpin(cloth, u, v);
    else this.actions.pin(cloth, u, v);
  }
}
