import {
  CircleGeometry, ConeGeometry, CylinderGeometry, DirectionalLight, DoubleSide, Group, HemisphereLight, Mesh, MeshBasicMaterial,
  MeshStandardMaterial, OrthographicCamera, Quaternion, RingGeometry, Scene, Spherical, Vector3,
} from '../three/three.module.js';

/** The arrow is seen from at least this far above the horizon, or one flying straight away would be a dot. */
const kLeastElevation = Math.PI / 6;
const kAxisUp = new Vector3(0, 1, 0);

/**
 * An arrow that flies with the wind, longer in a stronger one. It stands in a corner of the page and turns with the camera, so
 * that it is in sight however near the camera is to the cloth.
 */
export class WindArrow {
  /** @param {HTMLElement} place the arrow is drawn on the canvas behind this element */
  constructor(place) {
    this.place = place;
    this.text = place.querySelector('figcaption');
    this.scene = new Scene();
    this.camera = new OrthographicCamera(-1, 1, 1, -1, 0.1, 10);
    const material = new MeshStandardMaterial({color: 0x2f8fd0, roughness: 0.45});
    this.shaft = new Mesh(new CylinderGeometry(0.07, 0.07, 1, 24), material);
    this.head = new Mesh(new ConeGeometry(0.2, 0.42, 32), material);
    this.arrow = new Group();
    this.arrow.add(this.shaft, this.head);
    // A level ring gives the eye the horizon to read the arrow against.
    const ring = new Mesh(
      new RingGeometry(0.72, 0.76, 64).rotateX(-Math.PI / 2),
      new MeshBasicMaterial({color: 0x8b95a7, transparent: true, opacity: 0.7, side: DoubleSide, depthWrite: false}));
    this.plate = new Mesh(
      new CircleGeometry(1, 96), new MeshBasicMaterial({transparent: true, opacity: 0.92, depthWrite: false, toneMapped: false}));
    this.plate.renderOrder = -1;
    this.dark = matchMedia('(prefers-color-scheme: dark)');
    const key = new DirectionalLight(0xffffff, 2.5);
    key.position.set(1, 2, 1.5);
    this.scene.add(this.plate, this.arrow, ring, key, new HemisphereLight(0xffffff, 0x667788, 1.6));
    this.set([0, 0, -1], 0);
  }

  /** @param {number[]} direction unit @param {number} speed m/s */
  set(direction, speed) {
    const length = 0.2 + 0.75 * Math.min(1, Math.sqrt(speed / 20));
    this.shaft.scale.y = length;
    this.shaft.position.y = -0.21;
    this.head.position.y = length / 2;
    this.arrow.quaternion.copy(new Quaternion().setFromUnitVectors(kAxisUp, new Vector3(...direction)));
    this.place.hidden = speed === 0;
    this.text.textContent = `wind ${speed.toFixed(1)} m/s`;
  }

  /**
   * Draws over what is on the canvas.
   * @param {import('../three/three.module.js').WebGLRenderer} renderer
   * @param {import('../three/three.module.js').Camera} view whose direction is taken over
   */
  draw(renderer, view) {
    if (this.place.hidden) return;
    const box = this.place.getBoundingClientRect();
    const from = new Spherical().setFromVector3(view.getWorldDirection(new Vector3()).negate());
    from.phi = Math.min(from.phi, Math.PI / 2 - kLeastElevation);
    this.camera.position.setFromSpherical(from).multiplyScalar(3);
    this.camera.lookAt(0, 0, 0);
    this.plate.quaternion.copy(this.camera.quaternion);
    this.plate.material.color.set(this.dark.matches ? 0x20252e : 0xffffff);
    renderer.setViewport(box.left, renderer.domElement.clientHeight - box.bottom, box.width, box.height);
    renderer.autoClear = false;
    renderer.clearDepth();
    renderer.render(this.scene, this.camera);
    renderer.autoClear = true;
    renderer.setViewport(0, 0, renderer.domElement.clientWidth, renderer.domElement.clientHeight);
  }
}
