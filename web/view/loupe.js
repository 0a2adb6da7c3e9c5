import {PerspectiveCamera, Vector2, Vector3} from '../three/three.module.js';

/** Below this it would show no more than the picture does. */
const kLeastMagnification = 1.25;
/** Height of what the glass shows, in sides of the cloth. */
const kMargin = 1.3;

/**
 * A magnifying glass for a distant cloth: the same mesh, seen from the same place through a longer lens, so that one can see
 * what is sent at that distance.
 */
export class Loupe {
  /**
   * @param {HTMLElement} place the glass is drawn on the canvas behind this element
   * @param {import('./stage.js').Stage} stage
   */
  constructor(place, stage) {
    this.place = place;
    this.text = place.querySelector('figcaption');
    this.stage = stage;
    this.lens = new PerspectiveCamera(10, 1, 0.02, 200);
    this.centre = null;
  }

  /** @param {number[]|null} centre of the cloth, null for none @param {number} extent its larger side, m */
  lookAt(centre, extent = 0) {
    this.centre = centre;
    this.extent = extent;
  }

  draw(renderer, view) {
    if (!this.centre) {
      this.place.hidden = true;
      return;
    }
    const distance = view.position.distanceTo(new Vector3(...this.centre));
    const seen = 2 * distance * Math.tan((view.fov * Math.PI) / 360);  // height of the picture at the cloth, m
    const shown = kMargin * this.extent;
    this.place.hidden = false;
    const box = this.place.getBoundingClientRect();
    const magnification = (seen / shown) * (box.height / renderer.domElement.clientHeight);
    this.place.hidden = magnification < kLeastMagnification;
    if (this.place.hidden) return;
    this.lens.position.copy(view.position);
    this.lens.lookAt(...this.centre);
    this.lens.fov = (2 * Math.atan(shown / 2 / distance) * 180) / Math.PI;
    this.lens.updateProjectionMatrix();
    const text = `× ${magnification.toFixed(1)}`;
    if (this.text.textContent !== text) this.text.textContent = text;

    const {width, height} = renderer.getSize(new Vector2());  // CSS pixels, as viewport and scissor count
    const area = [box.left, height - box.bottom, box.width, box.height];
    renderer.setViewport(...area);
    renderer.setScissor(...area);
    renderer.setScissorTest(true);
    renderer.render(this.stage.scene, this.lens);
    renderer.setScissorTest(false);
    renderer.setViewport(0, 0, width, height);
  }
}
