import {CameraRig, ViewReporter} from '../input/camera_rig.js';
import {Show} from '../app/show.js';
import {Stage} from '../view/stage.js';
import {WeftClient} from '../protocol/weft.js';

/**
 * One scene on one canvas, without panels and without hands: connects while it is told to, draws, and says where its camera is.
 */
export class Player {
  #client = null;
  #scene = null;  // the `scene` message at hand
  #wanted = null;  // a distance of the camera to the scene's own target, m; null: the scene's own

  /**
   * @param {HTMLCanvasElement} canvas
   * @param {{high: boolean, pixelRatio: number, fieldOfView: number, instant: boolean, wireframe?: boolean}} settings
   * @param {{state?: (state: string) => void, scene?: (message: object) => void, frame?: (frame: object) => void,
   *   stats?: (message: object) => void}} [on] `state`:
   *   `connecting`, `open`, `waiting` (tries again by itself), `closed`
   */
  constructor(canvas, settings, on = {}) {
    this.on = on;
    this.stage = new Stage(canvas, settings);
    this.rig = new CameraRig(this.stage, settings.instant);
    this.show = new Show(this.stage, {instant: settings.instant, wireframe: settings.wireframe ?? false, high: settings.high});
    this.reporter = new ViewReporter((seen) => this.#client?.camera(seen).catch(() => {}));
    /** Frames received. */
    this.frames = 0;
  }

  /** Shows a scene until `close`. @param {string} server ws: or wss:, without a slash at its end @param {string|null} token */
  open(server, scene, token) {
    this.close();
    const client = new WeftClient(`${server}/v1/scenes/${encodeURIComponent(scene)}`, {
      client: 'weft view',
      token: token ?? undefined,
      reconnect: true,
      coarser: true,
      local: true,
      onmessage: (message) => client === this.#client && this.#hear(message),
      onframe: (frame) => {
        if (client !== this.#client) return;
        this.frames += 1;
        this.on.frame?.(frame);
        this.show.push(frame, performance.timeOrigin + performance.now());
      },
      onstate: (state) => {
        if (client !== this.#client) return;
        if (state === 'open') this.reporter.forget();
        this.on.state?.(state);
      },
    });
    this.#client = client;
    this.on.state?.('connecting');
    client.open().catch(() => {});  // with reconnect it fails by close() alone
  }

  /** Nothing is received any more; the picture stays. */
  close() {
    const client = this.#client;
    this.#client = null;
    if (!client) return;
    client.close();
    this.on.state?.('closed');
  }

  /** The client's commands while connected, else null. @returns {WeftClient|null} */
  get commands() {
    return this.#client?.connected ? this.#client : null;
  }

  /** How far from the scene's own target the camera is, in the scene's own direction; null: where the scene likes it. */
  setDistance(metres) {
    this.#wanted = metres;
    if (this.#scene) this.#placeCamera();
  }

  /** Whether the viewer turns the camera: where not, all input is left to what is around the canvas. */
  setControls(on) {
    const {controls} = this.rig;
    if (on && !controls.domElement) controls.connect(this.stage.renderer.domElement);
    if (!on && controls.domElement) {
      controls.disconnect();
      controls.domElement = null;
    }
  }

  /** Once a picture of the screen. */
  draw(nowMs) {
    this.show.update(nowMs, performance.timeOrigin + nowMs);
    this.rig.update(nowMs);
    const [nearest] = this.show.levels(this.rig.eye);
    if (nearest) {
      this.rig.setCentre(nearest.centre);
      if (this.commands) this.reporter.update(this.rig.view, nowMs);
    }
    if (this.stage.changed) this.stage.draw();
  }

  dispose() {
    this.close();
    this.show.clear();
    this.stage.dispose();
  }

  #hear(message) {
    if (message.op === 'scene') {
      const same = this.#scene?.name === message.name;
      this.#scene = message;
      this.show.begin(message);
      if (!same) this.#placeCamera();
      this.#fetchSurfaces(this.#client, message);
      this.on.scene?.(message);
    }
    if (message.op === 'event' && message.wind) this.show.setWind(message.wind);
    if (message.op === 'event' && /^cloth\.(un)?pin$/.test(message.kind)) this.show.setPins(message.cloth, message.pins);
    if (message.op === 'event' && message.kind === 'reset') message.pins?.forEach((pins, cloth) => this.show.setPins(cloth, pins));
    if (message.op === 'stats') this.on.stats?.(message);
  }

  #placeCamera() {
    const {distance, target = [0, 0, 0], eye = [target[0], target[1], target[2] + distance]} = this.#scene.camera;
    const own = Math.hypot(...eye.map((value, axis) => value - target[axis]));
    const scale = this.#wanted === null || own === 0 ? 1 : this.#wanted / own;
    this.rig.place(eye.map((value, axis) => target[axis] + scale * (value - target[axis])), target);
  }

  async #fetchSurfaces(client, {name, obstacles = []}) {
    for (const [obstacle, {shape}] of obstacles.entries()) {
      if (shape !== 'mesh' && shape !== 'convex') continue;
      const surface = await client.surface(obstacle).catch(() => null);  // one that does not come is not drawn
      if (client !== this.#client) return;
      if (surface) this.show.setSurface({scene: name, obstacle, surface});
    }
  }
}
