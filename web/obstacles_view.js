import {BoxGeometry, Group, Mesh, MeshStandardMaterial, PlaneGeometry, Quaternion, Vector3} from './three/three.module.js';

const kColour = 0xb9b2a6;
const kPlaneSide = 40;  // m; a plane has no end
const kGap = 0.004;  // m; nodes lie on the surface, and would flicker through it

/** What stands in the scene: planes and boxes. */
export class ObstaclesView {
  constructor() {
    this.group = new Group();
    this.material = new MeshStandardMaterial({color: kColour, roughness: 0.9});
  }

  /** @param {import('./client/weft.js').Obstacle[]} obstacles */
  show(obstacles) {
    this.clear();
    for (const obstacle of obstacles) this.group.add(this.#mesh(obstacle));
  }

  clear() {
    for (const mesh of [...this.group.children]) {
      this.group.remove(mesh);
      mesh.geometry.dispose();
    }
  }

  #mesh(obstacle) {
    const mesh = new Mesh(undefined, this.material);
    mesh.receiveShadow = true;
    mesh.position.fromArray(obstacle.position);
    if (obstacle.shape === 'plane') {
      const normal = new Vector3().fromArray(obstacle.normal);
      mesh.geometry = new PlaneGeometry(kPlaneSide, kPlaneSide);
      mesh.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), normal);
      mesh.position.addScaledVector(normal, -kGap);
    } else {
      const [w, x, y, z] = obstacle.quaternion;
      mesh.geometry = new BoxGeometry(...obstacle.size.map((length) => Math.max(length - 2 * kGap, length / 2)));
      mesh.quaternion.copy(new Quaternion(x, y, z, w));
      mesh.castShadow = true;
    }
    return mesh;
  }
}
