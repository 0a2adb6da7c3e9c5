import {ConeGeometry, CylinderGeometry, Group, Mesh, MeshStandardMaterial, Quaternion, Vector3} from './three/three.module.js';

/** An arrow that flies with the wind; longer in a stronger one, gone in a calm. */
export class WindArrow {
  constructor() {
    const material = new MeshStandardMaterial({color: 0x2f9bd8, roughness: 0.5, emissive: 0x0e3a55});
    this.shaft = new Mesh(new CylinderGeometry(0.022, 0.022, 1, 20), material);
    this.head = new Mesh(new ConeGeometry(0.07, 0.2, 28), material);
    this.group = new Group();
    this.group.add(this.shaft, this.head);
    this.group.visible = false;
  }

  /** @param {number[]} direction unit @param {number} speed m/s */
  set(direction, speed) {
    const length = 0.35 + 0.6 * Math.min(1, Math.sqrt(speed / 20));
    this.shaft.scale.y = length;
    this.head.position.y = length / 2 + 0.1;
    this.group.quaternion.copy(new Quaternion().setFromUnitVectors(new Vector3(0, 1, 0), new Vector3(...direction)));
    this.group.visible = speed > 0;
  }

  place(x, y, z) {
    this.group.position.set(x, y, z);
  }
}
