import {
  CanvasTexture, Color, DirectionalLight, HemisphereLight, Mesh, MeshBasicMaterial, NeutralToneMapping, PCFShadowMap,
  PerspectiveCamera, PlaneGeometry, RepeatWrapping, Scene, ShadowMaterial, SRGBColorSpace, Vector3, WebGLRenderer,
} from '../three/three.module.js';

const kThemes = {
  light: {background: 0xe9ebee, line: 'rgba(40, 50, 70, 0.3)', sky: 0xffffff, earth: 0xd6cdc2, ambient: 1.9, shadow: 0.22},
  dark: {background: 0x171a20, line: 'rgba(190, 205, 235, 0.26)', sky: 0xcfd8ea, earth: 0x3a3634, ambient: 1.2, shadow: 0.5},
};
const kRoomyAspect = 1.25;  // of a window at least so wide the field of view is the one set
const kGroundMetres = 40;
const kGroundGap = 0.02;  // m, to the lowest thing above it

/** Renderer, camera, lights and ground: everything that is there before the first cloth. */
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
    this.#addLights();
    this.#addGround();
    this.#followTheme();
    new ResizeObserver(() => this.#resize()).observe(canvas);
    this.#resize();
  }

  /** Puts light and shadow around a cloth, and the ground at `height`; where that is a `floor` of the scene, which takes the shadow itself, it stays there. */
  frame(centre, extent, height, floor = false) {
    const [x, y, z] = centre;
    this.key.position.set(x + 1.6 * extent, y + 2.6 * extent, z + 2.2 * extent);
    this.key.target.position.set(x, y, z);
    const {camera} = this.key.shadow;
    const reach = 1.6 * extent;
    Object.assign(camera, {left: -reach, right: reach, top: reach, bottom: -reach, near: 0.1, far: 9 * extent});
    camera.updateProjectionMatrix();
    this.ground.position.set(x, height, z);
    this.grid.position.set(Math.round(x), height - 0.001, Math.round(z));
    this.ground.visible = this.renderer.shadowMap.enabled && !floor;  // it is nothing but the shadow on it
    this.lowestGround = floor ? Infinity : height - 3 * extent;
    this.changed = true;
  }

  /** The ground gives way to what comes lower than it, but not without end: a cloth may fall. */
  keepGroundBelow(height) {
    if (height > this.ground.position.y + kGroundGap || height < this.lowestGround) return;
    this.ground.position.y = height - kGroundGap;
    this.grid.position.y = this.ground.position.y - 0.001;
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

  #addLights() {
    this.ambient = new HemisphereLight();
    this.key = new DirectionalLight(0xfff3e0, 2.7);
    this.key.castShadow = true;
    this.key.shadow.mapSize.set(2048, 2048);
    this.key.shadow.normalBias = 0.012;
    this.key.shadow.bias = -0.0006;
    this.key.shadow.radius = 3;
    // A faint light from behind, so that the far side of a fold is not a hole.
    this.rim = new DirectionalLight(0xbcd0ff, 0.7);
    this.rim.position.set(-3, 1.5, -4);
    // And one that goes with the viewer: what is looked at is never black.
    this.head = new DirectionalLight(0xffffff, 0.7);
    this.camera.add(this.head, this.head.target);
    this.head.target.position.set(0, 0, -1);
    this.head.position.set(0, 0, 0);
    this.scene.add(this.ambient, this.key, this.key.target, this.rim, this.camera);
  }

  #addGround() {
    const plane = new PlaneGeometry(kGroundMetres, kGroundMetres).rotateX(-Math.PI / 2);
    this.ground = new Mesh(plane, new ShadowMaterial({transparent: true}));
    this.ground.receiveShadow = true;
    this.grid = new Mesh(plane, new MeshBasicMaterial({transparent: true, depthWrite: false, toneMapped: false, alphaMap: fadeTexture()}));
    this.ground.renderOrder = 1;
    this.scene.add(this.grid, this.ground);
  }

  #followTheme() {
    const query = matchMedia('(prefers-color-scheme: dark)');
    const apply = () => {
      const theme = kThemes[query.matches ? 'dark' : 'light'];
      this.scene.background = new Color(theme.background);
      this.ambient.color.set(theme.sky);
      this.ambient.groundColor.set(theme.earth);
      this.ambient.intensity = theme.ambient;
      this.ground.material.opacity = theme.shadow;
      this.grid.material.map?.dispose();
      this.grid.material.map = tileTexture(theme.line, this.anisotropy);
      this.grid.material.needsUpdate = true;
      this.changed = true;
    };
    query.addEventListener('change', apply);
    apply();
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
    // Enough of the scene is in sight however narrow the window.
    const narrow = Math.max(1, kRoomyAspect / ((clientWidth - right) / (clientHeight - bottom)));
    this.camera.fov = (2 * Math.atan(narrow * Math.tan(this.halfView)) * 180) / Math.PI;
    this.camera.setViewOffset(clientWidth, clientHeight, right / 2, bottom / 2, clientWidth, clientHeight);
    this.changed = true;
  }
}

/** One metre of ground: lines along two of its sides, repeated to cover the rest. */
function tileTexture(line, anisotropy) {
  const size = 512;
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = size;
  const pen = canvas.getContext('2d');
  pen.fillStyle = line;
  pen.fillRect(0, 0, size, 5);
  pen.fillRect(0, 5, 5, size - 5);
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = SRGBColorSpace;
  texture.wrapS = texture.wrapT = RepeatWrapping;
  texture.repeat.set(kGroundMetres, kGroundMetres);
  texture.anisotropy = anisotropy;
  return texture;
}

/** The ground fades out towards its rim. (An alpha map is read from green.) */
function fadeTexture() {
  const size = 256;
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = size;
  const pen = canvas.getContext('2d');
  const fade = pen.createRadialGradient(size / 2, size / 2, 0, size / 2, size / 2, size / 2);
  fade.addColorStop(0, '#fff');
  fade.addColorStop(0.25, '#aaa');
  fade.addColorStop(1, '#000');
  pen.fillStyle = fade;
  pen.fillRect(0, 0, size, size);
  return new CanvasTexture(canvas);
}
