import {BoxGeometry, CapsuleGeometry, Group, Mesh, MeshStandardMaterial, PlaneGeometry, Quaternion, Vector3} from './three/three.module.js';

const kColour = 0xb9b2a6;
const kPlaneSide = 40;  // m; a plane has no end
const kGap = 0.004;  // m; nodes lie on the surface, and would flicker through it

/** What stands in the scene: planes, boxes and capsules. */
export class ObstaclesView {
  constructor() {
    this.group = new Group();
    this.material = new MeshStandardMaterial({color: kColour, roughness: 0.9});
  }

  /** @param {import('./client/weft.js').Obstacle[]} obstacles */
  show(obstacles) {
    this.clear();
    for (const obstacle of obstacles) {
      const mesh = this.#mesh(obstacle);
      if (mesh) this.group.add(mesh);
    }
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
      return mesh;
    }
    const shrunk = (length) => Math.max(length - kGap, length / 2);
    if (obstacle.shape === 'box') mesh.geometry = new BoxGeometry(...obstacle.size.map((length) => 2 * shrunk(length / 2)));
    else if (obstacle.shape === 'capsule') mesh.geometry = new CapsuleGeometry(shrunk(obstacle.radius), obstacle.length, 8, 24);
    else return null;  // of a newer server
    const [w, x, y, z] = obstacle.quaternion;
    mesh.quaternion.copy(new Quaternion(x, y, z, w));
    mesh.castShadow = true;
    return mesh;
  }
}
