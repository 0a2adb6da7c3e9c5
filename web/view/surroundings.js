import {
  CanvasTexture, Color, DirectionalLight, HemisphereLight, Mesh, MeshBasicMaterial, PlaneGeometry, RepeatWrapping, ShadowMaterial,
  SRGBColorSpace,
} from '../three/three.module.js';

const kThemes = {
  light: {background: 0xe9ebee, line: 'rgba(40, 50, 70, 0.3)', sky: 0xffffff, earth: 0xd6cdc2, ambient: 1.9, room: 0.42, shadow: 0.22},
  dark: {background: 0x171a20, line: 'rgba(190, 205, 235, 0.26)', sky: 0xcfd8ea, earth: 0x3a3634, ambient: 1.2, room: 0.4, shadow: 0.5},
};
const kBesideRoom = 0.25;  // share of the plain ambient light that is left beside a room's
const kGroundMetres = 40;
const kGroundGap = 0.02;  // m, to the lowest thing above it

/** Light, ground and background, in the colours that the viewer prefers: what is there before the first cloth. */
export class Surroundings {
  /**
   * @param {import('../three/three.module.js').Scene} scene
   * @param {import('../three/three.module.js').Camera} camera part of the scene from here on: a light goes with it
   * @param {{shadowPixels: number, anisotropy: number, room: Texture|null, changed: () => void}} options side of the shadow's picture,
   *   0 for none; how many samples slanted textures may cost; what all around shines (studio.js); what is called when the colours have changed
   */
  constructor(scene, camera, {shadowPixels, anisotropy, room, changed}) {
    this.scene = scene;
    this.scene.environment = room;
    this.shadows = shadowPixels > 0;
    this.anisotropy = anisotropy;
    this.#addLights(camera, shadowPixels);
    this.#addGround();
    this.#followTheme(changed);
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
    this.ground.visible = this.shadows && !floor;  // it is nothing but the shadow on it
    this.lowestGround = floor ? Infinity : height - 3 * extent;
  }

  /** The ground gives way to what comes lower than it, but not without end: a cloth may fall. */
  keepGroundBelow(height) {
    if (height > this.ground.position.y + kGroundGap || height < this.lowestGround) return;
    this.ground.position.y = height - kGroundGap;
    this.grid.position.y = this.ground.position.y - 0.001;
  }

  /** Follows what the viewer prefers no more. */
  dispose() {
    this.dark.removeEventListener('change', this.apply);
  }

  #addLights(camera, shadowPixels) {
    this.ambient = new HemisphereLight();
    this.key = new DirectionalLight(0xfff3e0, 2.7);
    this.key.castShadow = this.shadows;
    if (this.shadows) this.key.shadow.mapSize.set(shadowPixels, shadowPixels);
    this.key.shadow.normalBias = 0.012;
    this.key.shadow.bias = -0.0006;
    this.key.shadow.radius = 3;
    // A faint light from behind, so that the far side of a fold is not a hole.
    const rim = new DirectionalLight(0xbcd0ff, 0.7);
    rim.position.set(-3, 1.5, -4);
    // And one that goes with the viewer: what is looked at is never black.
    const head = new DirectionalLight(0xffffff, this.scene.environment ? 0.45 : 0.7);
    camera.add(head, head.target);
    head.target.position.set(0, 0, -1);
    head.position.set(0, 0, 0);
    this.scene.add(this.ambient, this.key, this.key.target, rim, camera);
  }

  #addGround() {
    const plane = new PlaneGeometry(kGroundMetres, kGroundMetres).rotateX(-Math.PI / 2);
    this.ground = new Mesh(plane, new ShadowMaterial({transparent: true}));
    this.ground.receiveShadow = true;
    this.grid = new Mesh(plane, new MeshBasicMaterial({transparent: true, depthWrite: false, toneMapped: false, alphaMap: fadeTexture()}));
    this.ground.renderOrder = 1;
    this.scene.add(this.grid, this.ground);
  }

  #followTheme(changed) {
    this.dark = matchMedia('(prefers-color-scheme: dark)');
    this.apply = () => {
      const theme = kThemes[this.dark.matches ? 'dark' : 'light'];
      this.scene.background = new Color(theme.background);
      this.ambient.color.set(theme.sky);
      this.ambient.groundColor.set(theme.earth);
      // The room's light comes from all around as well.
      this.ambient.intensity = this.scene.environment ? theme.ambient * kBesideRoom : theme.ambient;
      this.scene.environmentIntensity = theme.room;
      this.ground.material.opacity = theme.shadow;
      this.grid.material.map?.dispose();
      this.grid.material.map = tileTexture(theme.line, this.anisotropy);
      this.grid.material.needsUpdate = true;
      changed();
    };
    this.dark.addEventListener('change', this.apply);
    this.apply();
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
