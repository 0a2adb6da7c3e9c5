import {Raycaster, Vector2} from '../three/three.module.js';

/** What lies under a point of the window. */
export class Pointing {
  /** @param {import('../view/stage.js').Stage} stage */
  constructor(stage) {
    this.stage = stage;
    this.canvas = stage.renderer.domElement;
    this.raycaster = new Raycaster();
  }

  /** The ray from the eye through a point of the window, CSS pixels; valid until the next call. */
  ray(x, y) {
    const box = this.canvas.getBoundingClientRect();
    const point = new Vector2(((x - box.left) / box.width) * 2 - 1, 1 - ((y - box.top) / box.height) * 2);
    this.raycaster.setFromCamera(point, this.stage.camera);
    return this.raycaster.ray;
  }

  /** The nearest hit of `objects` there, or null. */
  hit(x, y, objects) {
    this.ray(x, y);
    return this.raycaster.intersectObjects(objects, false)[0] ?? null;
  }
}
