import {NeutralToneMapping, PCFShadowMap, PerspectiveCamera, Scene, WebGLRenderer} from '../three/three.module.js';
import {studio} from '../view/studio.js';
import {Surroundings} from '../view/surroundings.js';
import {Wardrobe} from '../fabric/wardrobe.js';

const kFieldOfView = 36;  // degrees
const kShadowPixels = 1024;
const kFabricPixels = 512;

/** Draws miniatures, one after the other, with the one WebGL context that all cards share. */
export class Painter {
  /** @param {import('../app/settings.js').Settings} settings @param {() => void} changed called when all pictures are to be drawn anew */
  constructor(settings, changed) {
    this.pixelRatio = settings.pixelRatio;
    this.renderer = new WebGLRenderer({antialias: settings.high});
    this.renderer.toneMapping = NeutralToneMapping;
    this.renderer.shadowMap.enabled = settings.high;
    this.renderer.shadowMap.type = PCFShadowMap;
    const anisotropy = settings.high ? Math.min(8, this.renderer.capabilities.getMaxAnisotropy()) : 1;
    this.wardrobe = new Wardrobe({high: settings.high, pixels: kFabricPixels, anisotropy});
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(kFieldOfView, 1, 0.02, 200);
    this.surroundings = new Surroundings(this.scene, this.camera,
      {shadowPixels: settings.high ? kShadowPixels : 0, anisotropy, room: settings.high ? studio(this.renderer) : null, changed});
  }

  /** @param {import('./miniature.js').Miniature} miniature @param {HTMLCanvasElement} canvas of a card, with a 2D context */
  paint(miniature, canvas) {
    const width = Math.max(1, Math.round(canvas.clientWidth * this.pixelRatio));
    const height = Math.max(1, Math.round(canvas.clientHeight * this.pixelRatio));
    const {domElement} = this.renderer;
    if (domElement.width !== width || domElement.height !== height) this.renderer.setSize(width, height, false);
    const {eye, target} = miniature.viewpoint(kFieldOfView);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.camera.position.copy(eye);
    this.camera.lookAt(target);
    miniature.light(this.surroundings);
    this.scene.add(miniature.group);
    this.renderer.render(this.scene, this.camera);
    miniature.group.removeFromParent();
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height});
    canvas.getContext('2d').drawImage(domElement, 0, 0);  // in the same task: afterwards the drawing is gone
  }
}
