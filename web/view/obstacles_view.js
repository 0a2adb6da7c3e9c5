import {
  BoxGeometry, BufferAttribute, BufferGeometry, CapsuleGeometry, Group, Mesh, MeshStandardMaterial, PlaneGeometry, Vector3,
} from '../three/three.module.js';
import {creased} from './creased.js';

const kColour = 0xb9b2a6;
const kBodyColour = 0xb98052;  // of what has a mass
const kChosenGlow = 0.18;
const kPlaneSide = 400;  // m, to where the camera sees no more; a plane has no end
const kGap = 0.004;  // m; nodes lie on the surface, and would flicker through it

/** What stands in the scene, or moves as the frames tell: planes, boxes, capsules, and meshes as soon as they have come. */
export class ObstaclesView {
  constructor() {
    this.group = new Group();
    const material = (color, glow) => new MeshStandardMaterial({color, roughness: 0.9, emissive: color, emissiveIntensity: glow});
    this.fixed = {plain: material(kColour, 0), chosen: material(kColour, kChosenGlow)};
    this.bodies = {plain: material(kBodyColour, 0), chosen: material(kBodyColour, kChosenGlow)};
    /** @type {(Mesh|null)[]} in the scene's order */
    this.meshes = [];
    /** Those that have come, by obstacle. @type {Map<number, import('../protocol/weft.js').Surface>} */
    this.surfaces = new Map();
  }

  /** @param {import('../protocol/weft.js').Obstacle[]} obstacles */
  show(obstacles) {
    this.clear();
    this.meshes = obstacles.map((obstacle, index) => this.#mesh(obstacle, index));
    for (const mesh of this.meshes) if (mesh) this.group.add(mesh);
    this.select(null);
  }

  /** Gives an obstacle, by its place in the scene, its surface. */
  setSurface(index, surface) {
    const {vertices, triangles} = surface;
    this.surfaces.set(index, surface);
    const {geometry} = this.meshes[index];
    const {positions, normals} = creased(vertices, triangles, {inset: kGap});
    geometry.setAttribute('position', new BufferAttribute(positions, 3));
    geometry.setAttribute('normal', new BufferAttribute(normals, 3));
    geometry.computeBoundingSphere();
  }

  /** Where an obstacle is in the newest frame, m, or undefined. */
  place(index) {
    return this.meshes[index]?.userData.now.position;
  }

  /** Marks one obstacle (or none) as the one that the controls act on; planes have no need of it. */
  select(index) {
    this.meshes.forEach((mesh, each) => {
      if (!mesh) return;
      const {shape, mass} = mesh.userData.home;
      mesh.material = (mass ? this.bodies : this.fixed)[each === index && shape !== 'plane' ? 'chosen' : 'plain'];
    });
  }

  /** Puts those that moved on their way from `before` to `after` by `share`, the others where `scene` has them. */
  move(before, after, share) {
    const pose = (moved, index) => moved.find(({obstacle}) => obstacle === index);
    this.meshes.forEach((mesh, index) => {
      if (!mesh) return;
      const home = mesh.userData.home;
      mesh.userData.now = pose(after, index) ?? home;
      this.#place(mesh, mesh.userData.now);
      if (share === 1 || before === after) return;
      const to = {position: mesh.position.clone(), quaternion: mesh.quaternion.clone()};
      this.#place(mesh, pose(before, index) ?? home);
      mesh.position.lerp(to.position, share);
      mesh.quaternion.slerp(to.quaternion, share);
    });
  }

  /** Height of the highest level plane that faces up, m, or null where there is none. */
  floorHeight() {
    const floors = this.meshes.filter((mesh) => mesh?.userData.home.shape === 'plane' && mesh.userData.home.normal[1] > 0.999);
    return floors.length > 0 ? Math.max(...floors.map((mesh) => mesh.userData.home.position[1])) : null;
  }

  clear() {
    for (const mesh of [...this.group.children]) {
      this.group.remove(mesh);
      mesh.geometry.dispose();
    }
    this.meshes = [];
    this.surfaces.clear();
  }

  #mesh(obstacle, index) {
    const mesh = new Mesh();
    mesh.receiveShadow = true;
    mesh.userData = {obstacle: index, home: obstacle, now: obstacle};
    if (obstacle.shape === 'plane') {
      mesh.geometry = new PlaneGeometry(kPlaneSide, kPlaneSide);
      mesh.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), new Vector3().fromArray(obstacle.normal));
      this.#place(mesh, obstacle);
      return mesh;
    }
    const shrunk = (length) => Math.max(length - kGap, length / 2);
    if (obstacle.shape === 'box') mesh.geometry = new BoxGeometry(...obstacle.size.map((length) => 2 * shrunk(length / 2)));
    else if (obstacle.shape === 'capsule') mesh.geometry = new CapsuleGeometry(shrunk(obstacle.radius), obstacle.length, 8, 24);
    else if (obstacle.shape === 'mesh' || obstacle.shape === 'convex') mesh.geometry = new BufferGeometry();
    else return null;  // of a newer server
    this.#place(mesh, obstacle);
    mesh.castShadow = true;
    return mesh;
  }

  #place(mesh, {position, quaternion}) {
    mesh.position.fromArray(position);
    const {normal} = mesh.userData.home;
    if (normal) mesh.position.addScaledVector(new Vector3().fromArray(normal), -kGap);  // a plane keeps its normal
    else mesh.quaternion.set(quaternion[1], quaternion[2], quaternion[3], quaternion[0]);
  }
}
