import {
  CanvasTexture, Color, DirectionalLight, Fog, HemisphereLight, Mesh, MeshBasicMaterial, NeutralToneMapping, PCFShadowMap,
  PerspectiveCamera, PlaneGeometry, Scene, ShadowMaterial, SRGBColorSpace, WebGLRenderer,
} from './three/three.module.js';

const kThemes = {
  light: {background: 0xe9ebee, line: 'rgba(40, 50, 70, 0.16)', sky: 0xffffff, earth: 0xb8ada0, ambient: 1.5, shadow: 0.28},
  dark: {background: 0x171a20, line: 'rgba(190, 205, 235, 0.13)', sky: 0xcfd8ea, earth: 0x3a3634, ambient: 0.9, shadow: 0.5},
};
const kGroundMetres = 40;

/** Renderer, camera, lights and ground: everything that is there before the first cloth. */
export class Stage {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {import('./settings.js').Settings} settings
   */
  constructor(canvas, settings) {
    this.renderer = new WebGLRenderer({canvas, antialias: settings.antialias});
    this.renderer.setPixelRatio(settings.pixelRatio);
    this.renderer.toneMapping = NeutralToneMapping;
    this.renderer.shadowMap.enabled = settings.shadows;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(42, 1, 0.02, 200);
    this.changed = true;  // something to draw
    this.#addLights();
    this.#addGround();
    this.#followTheme();
    new ResizeObserver(() => this.#resize()).observe(canvas);
    this.#resize();
  }

  /** Puts light and shadow around a cloth, and the ground at `height`. */
  frame(centre, extent, height) {
    const [x, y, z] = centre;
    this.key.position.set(x + 1.6 * extent, y + 2.6 * extent, z + 2.2 * extent);
    this.key.target.position.set(x, y, z);
    const {camera} = this.key.shadow;
    const reach = 1.6 * extent;
    Object.assign(camera, {left: -reach, right: reach, top: reach, bottom: -reach, near: 0.1, far: 9 * extent});
    camera.updateProjectionMatrix();
    this.ground.position.set(x, height, z);
    this.grid.position.set(Math.round(x), height - 0.001, Math.round(z));
    this.changed = true;
  }

  get groundHeight() {
    return this.ground.position.y;
  }

  lowerGroundTo(height) {
    this.ground.position.y = height;
    this.grid.position.y = height - 0.001;
  }

  draw() {
    this.changed = false;
    this.renderer.render(this.scene, this.camera);
  }

  #addLights() {
    this.ambient = new HemisphereLight();
    this.key = new DirectionalLight(0xfff3e0, 2.6);
    this.key.castShadow = true;
    this.key.shadow.mapSize.set(2048, 2048);
    this.key.shadow.normalBias = 0.012;
    this.key.shadow.bias = -0.0006;
    this.key.shadow.radius = 3;
    // A faint light from behind, so that the far side of a fold is not a hole.
    this.rim = new DirectionalLight(0xbcd0ff, 0.7);
    this.rim.position.set(-3, 1.5, -4);
    this.scene.add(this.ambient, this.key, this.key.target, this.rim);
  }

  #addGround() {
    const plane = new PlaneGeometry(kGroundMetres, kGroundMetres).rotateX(-Math.PI / 2);
    this.ground = new Mesh(plane, new ShadowMaterial({transparent: true}));
    this.ground.receiveShadow = true;
    this.grid = new Mesh(plane, new MeshBasicMaterial({transparent: true, depthWrite: false, toneMapped: false}));
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
      this.grid.material.map = groundTexture(theme.line, this.renderer.capabilities.getMaxAnisotropy());
      this.grid.material.needsUpdate = true;
      this.changed = true;
    };
    query.addEventListener('change', apply);
    apply();
  }

  #resize() {
    const {clientWidth, clientHeight} = this.renderer.domElement;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    this.changed = true;
  }
}

/** A line every metre, fading out towards the rim. */
function groundTexture(line, anisotropy) {
  const size = 2048;
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = size;
  const pen = canvas.getContext('2d');
  pen.strokeStyle = line;
  pen.lineWidth = 2;
  for (let metre = 0; metre <= kGroundMetres; ++metre) {
    const at = (metre / kGroundMetres) * size;
    pen.beginPath();
    pen.moveTo(at, 0), pen.lineTo(at, size);
    pen.moveTo(0, at), pen.lineTo(size, at);
    pen.stroke();
  }
  const fade = pen.createRadialGradient(size / 2, size / 2, 0, size / 2, size / 2, size / 2);
  fade.addColorStop(0, 'rgba(0, 0, 0, 1)');
  fade.addColorStop(0.8, 'rgba(0, 0, 0, 0)');
  pen.globalCompositeOperation = 'destination-in';
  pen.fillStyle = fade;
  pen.fillRect(0, 0, size, size);
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = SRGBColorSpace;
  texture.anisotropy = anisotropy;
  return texture;
}
