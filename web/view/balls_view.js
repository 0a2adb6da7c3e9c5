import {Color, Group, Mesh, MeshStandardMaterial, SphereGeometry, Vector3} from '../three/three.module.js';

const kColours = [0xe4572e, 0x2e86ab, 0xf2a541, 0x4c9f70, 0x8e5bb5, 0xd1495b];

const kLeastShare = 0.9;  // of a ball's radius; a ball smaller than the cells shows through them

/** The balls, as the frames tell. */
export class BallsView {
  constructor() {
    this.group = new Group();
    this.geometry = new SphereGeometry(1, 48, 32);
    /** @type {Map<number, Mesh>} */
    this.meshes = new Map();
    this.selected = null;
  }

  /**
   * Shows the balls of `after`, on the way from `before` by `share`. The cloth's nodes lie on the ball, its flat cells cut through it:
   * balls are drawn as much smaller as cells with `halfDiagonal` (m) do, so that cloth hides what is behind it.
   */
  show(before, after, share, halfDiagonal) {
    const earlier = new Map(before.map((ball) => [ball.ball, ball]));
    const gone = new Set(this.meshes.keys());
    const place = new Vector3();
    for (const ball of after) {
      gone.delete(ball.ball);
      const mesh = this.meshes.get(ball.ball) ?? this.#add(ball.ball);
      mesh.position.fromArray(ball.position);
      const from = earlier.get(ball.ball);
      if (from && share < 1) mesh.position.lerpVectors(place.fromArray(from.position), mesh.position, share);
      mesh.scale.setScalar(Math.max(kLeastShare * ball.radius, Math.sqrt(Math.max(0, ball.radius ** 2 - halfDiagonal ** 2))));
      mesh.userData.ball = ball;
    }
    for (const id of gone) this.#remove(id);
  }

  get ids() {
    return [...this.meshes.keys()];
  }

  /** The newest record of a ball, or undefined. */
  ball(id) {
    return this.meshes.get(id)?.userData.ball;
  }

  /** Marks one ball (or none) as the one the buttons act on. */
  select(id) {
    this.selected = id;
    for (const [each, mesh] of this.meshes) this.#mark(mesh, each === id);
  }

  clear() {
    for (const id of this.ids) this.#remove(id);
  }

  #mark(mesh, on) {
    mesh.material.emissiveIntensity = on && this.meshes.size > 1 ? 0.25 : 0;
  }

  #add(id) {
    const colour = new Color(kColours[(id - 1) % kColours.length]);
    const material = new MeshStandardMaterial({color: colour, roughness: 0.35, emissive: colour, emissiveIntensity: 0});
    const mesh = new Mesh(this.geometry, material);
    mesh.castShadow = mesh.receiveShadow = true;
    this.meshes.set(id, mesh);
    this.group.add(mesh);
    this.#mark(mesh, id === this.selected);
    return mesh;
  }

  #remove(id) {
    const mesh = this.meshes.get(id);
    this.group.remove(mesh);
    mesh.material.dispose();
    this.meshes.delete(id);
  }
}
