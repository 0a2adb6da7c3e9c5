import {ArrowHelper, BoxGeometry, EdgesGeometry, Group, LineBasicMaterial, LineSegments, SphereGeometry, Vector3} from '../three/three.module.js';

const kColour = 0x2e86ab;
const kStill = 0.05;  // m/s: slower air has no arrow

/** The wind's zones: their outline, and an arrow as long as the air goes in a fifth of a second. */
export class ZonesView {
  constructor() {
    this.group = new Group();
    this.material = new LineBasicMaterial({color: kColour, transparent: true, opacity: 0.55});
    this.told = '';
  }

  /** @param {import('../protocol/weft.js').WindZone[]} zones as `wind` has them */
  show(zones) {
    const told = JSON.stringify(zones);
    if (told === this.told) return;
    this.told = told;
    this.clear();
    for (const zone of zones) {
      const outline = this.#outline(zone);
      if (!outline) continue;
      outline.position.fromArray(zone.position);
      this.group.add(outline, ...this.#arrow(zone));
    }
  }

  clear() {
    for (const child of [...this.group.children]) {
      child.removeFromParent();
      if (child.isLineSegments) child.geometry.dispose();
      else child.dispose();
    }
  }

  #outline(zone) {
    if (zone.shape === 'box') {
      const box = this.#lines(new BoxGeometry(...zone.size));
      const [w, x, y, z] = zone.quaternion;
      box.quaternion.set(x, y, z, w);
      return box;
    }
    // Shapes of a later minor version are not drawn.
    return zone.shape === 'sphere' ? this.#lines(new SphereGeometry(zone.radius, 16, 12), 1) : null;
  }

  #lines(solid, degrees = 1) {
    const lines = new LineSegments(new EdgesGeometry(solid, degrees), this.material);
    solid.dispose();
    return lines;
  }

  #arrow({position, velocity}) {
    const way = new Vector3(...velocity);
    const speed = way.length();
    if (speed < kStill) return [];
    const length = speed / 5;
    return [new ArrowHelper(way.normalize(), new Vector3(...position), length, kColour, Math.min(0.15, 0.4 * length), Math.min(0.08, 0.2 * length))];
  }
}
