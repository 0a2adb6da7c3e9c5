import {
  BackSide, Color, DoubleSide, FrontSide, LineBasicMaterial, MeshLambertMaterial, MeshPhysicalMaterial,
} from '../three/three.module.js';
import {drawSide} from './textures.js';
import {kWeaves} from './weaves.js';

/**
 * @typedef {object} Look what a cloth looks like, as the `scene` message has it
 * @property {string} weave @property {string} colour @property {string} weft @property {number} thread
 * @property {string} [back] @property {{colour: string, width: number, spacing: number, bands: number, across: boolean}} [stripe]
 *
 * @typedef {object} Fabric what a cloth is drawn with
 * @property {import('../three/three.module.js').Material[]} materials one of both sides, or front and back
 */

/** Of a server that does not tell. @type {Look} */
const kUntold = {weave: 'plain', colour: '#2c5894', weft: '#4674b0', thread: 0.006};
const kIdle = 16;  // fabrics that nobody wears any more and that are kept all the same

/** The fabrics of a page, each drawn once: cloths that look alike share theirs. */
export class Wardrobe {
  /** @param {{high: boolean, pixels: number, anisotropy: number}} options `high`: with slopes and the full model of light; side of a picture */
  constructor(options) {
    this.options = options;
    this.wire = new LineBasicMaterial({color: 0xfff4d6, transparent: true, opacity: 0.85});
    this.offset = false;
    /** By the look; the one that was lent last is the last. @type {Map<string, {fabric: Fabric, worn: number}>} */
    this.entries = new Map();
  }

  /** @param {Look} [look] @returns {Fabric} until it is given back as often as it was lent */
  lend(look = kUntold) {
    const key = JSON.stringify(look);
    const entry = this.entries.get(key) ?? {fabric: {key, materials: this.#materials(look)}, worn: 0};
    this.entries.delete(key);
    this.entries.set(key, entry);
    entry.worn += 1;
    return entry.fabric;
  }

  /** @param {Fabric} fabric */
  takeBack({key}) {
    this.entries.get(key).worn -= 1;
    const idle = [...this.entries].filter(([, {worn}]) => worn === 0);
    for (const [old, {fabric}] of idle.slice(0, Math.max(0, idle.length - kIdle))) {
      this.entries.delete(old);
      for (const material of fabric.materials) {
        material.map.dispose();
        material.normalMap?.dispose();
        material.dispose();
      }
    }
  }

  /** With the wireframe: fabric is pushed back a little, so that lines on the same surface win. */
  setOffset(on) {
    this.offset = on;
    for (const {fabric} of this.entries.values()) for (const material of fabric.materials) material.polygonOffset = on;
  }

  #materials(told) {
    const look = {...kUntold, ...told};  // a later server may leave out what this page needs
    const weave = kWeaves[look.weave] ?? kWeaves.plain;
    const front = {warp: look.colour, weft: look.weft, stripe: look.stripe};
    if (!weave.back && !look.back) return [this.#material(look, weave, weave.front, front, DoubleSide)];
    const back = look.back ? {warp: look.back, weft: look.back} : front;
    return [
      this.#material(look, weave, weave.front, front, FrontSide),
      this.#material(look, weave, weave.back ?? weave.front, back, BackSide),
    ];
  }

  #material(look, weave, side, colours, faces) {
    const {high, pixels, anisotropy} = this.options;
    const {map, normalMap} = drawSide(look, weave, {...side, colours}, {pixels: pixels * (weave.detail ?? 1), anisotropy, slopes: high});
    const common = {map, side: faces, polygonOffset: this.offset, polygonOffsetFactor: 1, polygonOffsetUnits: 1};
    if (!high) return new MeshLambertMaterial(common);
    const {fuzz = 0, ...surface} = side.surface;
    const material = new MeshPhysicalMaterial({...common, ...surface, normalMap});
    material.sheenColor = new Color(colours.warp).lerp(new Color(0xffffff), fuzz);
    return material;
  }
}
