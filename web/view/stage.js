import {NeutralToneMapping, PCFShadowMap, PerspectiveCamera, Scene, Vector3, WebGLRenderer} from '../three/three.module.js';
import {studio} from './studio.js';
import {Surroundings} from './surroundings.js';

const kRoomyAspect = 1.25;  // of a window at least so wide the field of view is the one set
const kShadowPixels = 2048;

/** Renderer, camera and surroundings: everything that is there before the first cloth. */
export class Stage {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {import('../app/settings.js').Settings} settings
   */
  constructor(canvas, settings) {
    this.renderer = new WebGLRenderer({canvas, antialias: settings.high});
    this.renderer.setPixelRatio(settings.pixelRatio);
    this.renderer.toneMapping = NeutralToneMapping;
    this.renderer.shadowMap.enabled = settings.high;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.renderer.shadowMap.autoUpdate = false;
    /** How many samples slanted textures may cost. */
    this.anisotropy = settings.high ? Math.min(8, this.renderer.capabilities.getMaxAnisotropy()) : 1;
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(settings.fieldOfView, 1, 0.02, 200);  // its field of view follows the window: #resize
    this.halfView = (settings.fieldOfView / 2) * (Math.PI / 180);  // upwards
    this.changed = true;  // something to draw
    this.insets = {right: 0, bottom: 0};
    /** Drawn over the scene, in their own corner. @type {{draw: (renderer: WebGLRenderer, view: PerspectiveCamera) => void}[]} */
    this.overlays = [];
    this.surroundings = new Surroundings(this.scene, this.camera, {
      shadowPixels: settings.high ? kShadowPixels : 0,
      anisotropy: this.anisotropy,
      room: settings.high ? studio(this.renderer) : null,
      changed: () => (this.changed = true),
    });
    this.sizes = new ResizeObserver(() => this.#resize());
    this.sizes.observe(canvas);
    this.#resize();
  }

  /** Gives the graphics card back what this holds of it; nothing can be drawn any more. */
  dispose() {
    this.sizes.disconnect();
    this.surroundings.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }

  /** Parts of the canvas that lie under panels, CSS pixels: what is looked at stands in the middle of the rest. */
  setInsets(right, bottom) {
    this.insets = {right, bottom};
    this.#resize();
  }

  draw() {
    this.changed = false;
    this.renderer.shadowMap.needsUpdate = true;  // once, for the overlays too
    this.renderer.render(this.scene, this.camera);
    for (const overlay of this.overlays) overlay.draw(this.renderer, this.camera);
  }

  /** What a pixel of the picture spans at a point, m. */
  pixelAt([x, y, z]) {
    const distance = this.camera.position.distanceTo({x, y, z});
    return (2 * distance * Math.tan((this.camera.fov * Math.PI) / 360)) / this.renderer.domElement.clientHeight;
  }

  /** The round cone around the line of sight that holds the whole picture: its half angle, radians. */
  get halfAngle() {
    const corners = [[-1, -1], [-1, 1], [1, -1], [1, 1]].map(([x, y]) =>
      new Vector3(x, y, 0).applyMatrix4(this.camera.projectionMatrixInverse).normalize());
    return Math.acos(Math.min(...corners.map((corner) => -corner.z)));  // it looks along -z
  }

  #resize() {
    const {clientWidth, clientHeight} = this.renderer.domElement;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    const {right, bottom} = this.insets;
    // Enough of the scene is in sight however narrow what the panels leave of the window.
    const free = clientHeight - bottom;
    const narrow = Math.max(1, kRoomyAspect / ((clientWidth - right) / free));
    this.camera.fov = (2 * Math.atan(narrow * (clientHeight / free) * Math.tan(this.halfView)) * 180) / Math.PI;
    this.camera.setViewOffset(clientWidth, clientHeight, right / 2, bottom / 2, clientWidth, clientHeight);
    this.changed = true;
  }
}
