import {Vector3} from '../three/three.module.js';
import {OrbitControls} from '../three/OrbitControls.js';

export const kNearest = 0.5;
export const kFarthest = 20;
/** Where the keys 1, 2, 3 go: one distance inside each band of Table 1's thresholds. */
export const kJumps = [0.8, 5, 12];

const kJumpMs = 350;
const kOrbitStep = Math.PI / 36;
const kZoomStep = 1.15;

/** Orbit around the cloth with mouse, touch and keys. Distances are the camera's own, from a centre given each frame. */
export class CameraRig {
  /**
   * @param {import('../view/stage.js').Stage} stage
   * @param {boolean} instant no flights, no gliding
   */
  constructor(stage, instant) {
    this.stage = stage;
    this.instant = instant;
    this.camera = stage.camera;
    this.controls = new OrbitControls(this.camera, stage.renderer.domElement);
    this.controls.enableDamping = !instant;
    this.controls.dampingFactor = 0.12;
    this.controls.minDistance = kNearest;
    this.controls.maxDistance = kFarthest;
    this.controls.addEventListener('change', () => (this.stage.changed = true));
    this.controls.addEventListener('start', () => (this.flight = null));
    this.flight = null;
    this.centre = new Vector3();
  }

  /** Puts the camera somewhere at once. */
  place(eye, target) {
    this.flight = null;
    this.camera.position.fromArray(eye);
    this.controls.target.fromArray(target);
    this.controls.update();
    this.stage.changed = true;
  }

  /** The point distances are measured from: the centre of the nearest cloth. */
  setCentre(centre) {
    this.centre.fromArray(centre);
  }

  get distance() {
    return this.camera.position.distanceTo(this.centre);
  }

  get eye() {
    return this.camera.position.toArray();
  }

  /** What the page has in sight, as the `camera` message says it. */
  get view() {
    return {eye: this.eye, target: this.controls.target.toArray(), halfAngle: this.stage.halfAngle};
  }

  /** Looks at the centre from `distance` away, from the present direction. */
  goTo(distance) {
    const wanted = Math.min(kFarthest, Math.max(kNearest, distance));
    const direction = this.camera.position.clone().sub(this.centre);
    if (direction.lengthSq() < 1e-12) direction.set(0, 0, 1);
    const eye = this.centre.clone().addScaledVector(direction.normalize(), wanted);
    this.#flyTo(eye, this.centre.clone());
  }

  /** Turns around the target, radians to the right and upwards. */
  orbit(right, up) {
    this.flight = null;
    const arm = this.camera.position.clone().sub(this.controls.target);
    const radius = arm.length();
    const azimuth = Math.atan2(arm.x, arm.z) + right;
    const polar = Math.min(Math.PI - 0.02, Math.max(0.02, Math.acos(arm.y / radius) - up));
    arm.setFromSphericalCoords(radius, polar, azimuth);
    this.camera.position.copy(this.controls.target).add(arm);
    this.controls.update();
    this.stage.changed = true;
  }

  /** Nearer (factor below 1) or farther. */
  zoom(factor) {
    this.goTo(this.distance * factor);
  }

  /** Whether `key` was a camera key, and done. */
  handleKey(key) {
    switch (key) {
      case 'ArrowLeft': this.orbit(-kOrbitStep, 0); return true;
      case 'ArrowRight': this.orbit(kOrbitStep, 0); return true;
      case 'ArrowUp': this.orbit(0, kOrbitStep); return true;
      case 'ArrowDown': this.orbit(0, -kOrbitStep); return true;
      case '+': case '=': this.zoom(1 / kZoomStep); return true;
      case '-': case '_': this.zoom(kZoomStep); return true;
      case '1': case '2': case '3': this.goTo(kJumps[Number(key) - 1]); return true;
      default: return false;
    }
  }

  /** Once a drawn frame. */
  update(nowMs) {
    if (this.flight) {
      const progress = Math.min(1, (nowMs - this.flight.startMs) / kJumpMs);
      const eased = progress * progress * (3 - 2 * progress);
      this.camera.position.lerpVectors(this.flight.fromEye, this.flight.toEye, eased);
      this.controls.target.lerpVectors(this.flight.fromTarget, this.flight.toTarget, eased);
      if (progress === 1) this.flight = null;
      this.stage.changed = true;
    }
    this.controls.update();
  }

  #flyTo(eye, target) {
    if (this.instant) return this.place(eye.toArray(), target.toArray());
    this.flight = {
      startMs: performance.now(),
      fromEye: this.camera.position.clone(), toEye: eye,
      fromTarget: this.controls.target.clone(), toTarget: target,
    };
  }
}

/** Sends where the camera is and what it has in sight when that has changed, at most ten times a second, and always the last one. */
export class ViewReporter {
  /** @param {(view: {eye: number[], target: number[], halfAngle: number}) => void} send */
  constructor(send) {
    this.send = send;
    this.sent = null;
    this.nextMs = 0;
  }

  /** A new connection knows nothing. */
  forget() {
    this.sent = null;
    this.nextMs = 0;
  }

  update(view, nowMs) {
    if (nowMs < this.nextMs) return;
    const values = [...view.eye, ...view.target, view.halfAngle];
    if (this.sent && values.every((value, i) => Math.abs(value - this.sent[i]) < 1e-3)) return;
    this.sent = values;
    this.nextMs = nowMs + 100;
    this.send(view);
  }
}
