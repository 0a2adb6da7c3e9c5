import {BufferAttribute, BufferGeometry, CanvasTexture, Color, Group, Line, LineBasicMaterial, Points, PointsMaterial, Vector3} from '../three/three.module.js';

const kPinColour = 0xd1495b, kHandColour = 0xf2a541;
const kPinPixels = 9, kHandPixels = 17;
const kApart = 1 / 16;  // of the cloth, between two marks of a pin that holds an edge or a patch

/** Marks on the cloths: where they are pinned, and this viewer's hand with what it holds of a cloth or a body. Of one size on the page, and before all else. */
export class MarksView {
  constructor() {
    const map = disc();
    this.pins = points(kPinColour, kPinPixels, map);
    this.hand = points(kHandColour, kHandPixels, map);
    this.arm = new Line(new BufferGeometry(), new LineBasicMaterial({color: kHandColour, depthTest: false, transparent: true}));
    this.arm.frustumCulled = false;
    this.group = new Group();
    this.group.add(this.pins, this.arm, this.hand);
    this.group.renderOrder = 2;
    /** @type {Map<number, {u: number[], v: number[]}[]>} by cloth */
    this.held = new Map();
    this.all = false;
    this.setHand(null);
  }

  /** What holds one cloth. @param {number} cloth @param {{u: number[], v: number[]}[]} pins from u[0] to u[1], v[0] to v[1] */
  setPins(cloth, pins) {
    this.held.set(cloth, pins);
    this.changed = true;
  }

  clear() {
    this.held.clear();
    this.setHand(null);
  }

  /** Whether to show pins of edges and patches, too; those of points are always shown. */
  setAllPins(all) {
    this.all = all;
    this.changed = true;
  }

  /** @param {{position: number[], cloth: number, u: number, v: number}|{position: number[], mesh: Mesh, point: number[]}|null} hand what it holds of a cloth or a mesh */
  setHand(hand) {
    this.at = hand;
    this.hand.visible = this.arm.visible = hand !== null;
    this.changed = true;
  }

  /** Puts the marks where the cloths are shown. @param {Map<number, import('./cloth_view.js').ClothView>} cloths */
  update(cloths) {
    this.changed = false;
    const places = [];
    for (const [cloth, pins] of this.held) {
      const view = cloths.get(cloth);
      if (!view?.record) continue;
      for (const {u, v} of pins) {
        if (!this.all && (u[0] !== u[1] || v[0] !== v[1])) continue;
        for (const atV of along(v)) for (const atU of along(u)) places.push(...view.placeAt(atU, atV));
      }
    }
    setPlaces(this.pins.geometry, places);
    const held = this.at && placeHeld(this.at, cloths);
    if (!held) return;
    setPlaces(this.hand.geometry, this.at.position);
    setPlaces(this.arm.geometry, [...this.at.position, ...held]);
  }
}

/** Where what a hand holds is shown, or null while it is not. */
function placeHeld({cloth, u, v, mesh, point}, cloths) {
  if (mesh) {
    mesh.updateMatrixWorld();
    return mesh.localToWorld(new Vector3(...point)).toArray();
  }
  const view = cloths.get(cloth);
  return view?.record ? view.placeAt(u, v) : null;
}

function along([from, to]) {
  const parts = Math.ceil((to - from) / kApart);
  return Array.from({length: parts + 1}, (_, i) => (parts === 0 ? from : from + ((to - from) * i) / parts));
}

function setPlaces(geometry, places) {
  const present = geometry.attributes.position;
  if (present?.array.length === places.length) {
    present.array.set(places);
    present.needsUpdate = true;
  } else {
    geometry.dispose();
    geometry.setAttribute('position', new BufferAttribute(new Float32Array(places), 3));
  }
}

function points(colour, size, map) {
  const material = new PointsMaterial({color: new Color(colour), size, sizeAttenuation: false, map, transparent: true, depthTest: false, toneMapped: false});
  const made = new Points(new BufferGeometry().setAttribute('position', new BufferAttribute(new Float32Array(0), 3)), material);
  made.frustumCulled = false;
  return made;
}

/** A disc with a pale rim, so that it is seen on dark and on light. */
function disc() {
  const size = 64;
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = size;
  const pen = canvas.getContext('2d');
  pen.beginPath();
  pen.arc(size / 2, size / 2, 0.38 * size, 0, 2 * Math.PI);
  pen.fillStyle = 'white';
  pen.fill();
  pen.lineWidth = 0.12 * size;
  pen.strokeStyle = 'rgba(255, 255, 255, 0.5)';
  pen.stroke();
  return new CanvasTexture(canvas);
}
