import {Box3, Group, Vector3} from '../three/three.module.js';
import {BallsView} from '../view/balls_view.js';
import {ClothView} from '../view/cloth_view.js';
import {ObstaclesView} from '../view/obstacles_view.js';

const kFill = 1.15;     // of the picture's height, for the ball around the cloths and what they hang on
const kCompany = 2;     // times the cloths' extent: what is larger is where they are, not what they are on
const kNearest = 0.35, kFarthest = 1.5;  // of the scene's own distance: what is around the cloth is part of the picture, too
const kAstray = 0.4;    // of that ball's radius: farther the cloths do not go from the middle, the camera follows

/** One scene in small: what stands in it at the newest frame. */
export class Miniature {
  /** @param {import('../fabric/wardrobe.js').Wardrobe} wardrobe */
  constructor(wardrobe) {
    this.wardrobe = wardrobe;
    this.group = new Group();
    this.balls = new BallsView();
    this.obstacles = new ObstaclesView();
    this.group.add(this.balls.group, this.obstacles.group);
    /** @type {Map<number, ClothView>} */
    this.cloths = new Map();
    this.framed = null;  // what was in the first frame: where the ground and the camera are
  }

  /** Whether there is anything to see. */
  get ready() {
    return this.framed !== null;
  }

  /** Takes a `scene` message. */
  begin(message) {
    this.clear();
    this.camera = message.camera;
    this.obstacles.show(message.obstacles ?? []);
    for (const description of message.cloths) {
      const view = new ClothView(description, this.wardrobe, true);
      view.wireframe = false;
      this.cloths.set(view.id, view);
      this.group.add(view.group);
    }
  }

  /** Takes a frame. */
  show(frame) {
    for (const record of frame.cloths) this.cloths.get(record.cloth)?.show(record, record, 1, 0, Infinity);
    const cells = [...this.cloths.values()].filter((view) => view.record);
    if (cells.length === 0) return;
    this.balls.show(frame.balls, frame.balls, 1, Math.max(...cells.map((view) => view.halfDiagonal)));
    this.obstacles.move(frame.obstacles, frame.obstacles, 1);
    this.framed ??= this.#measure(cells);
    this.low = Math.min(...cells.map((view) => view.lowest()));
    this.#follow(cells);
  }

  /** Where the picture is taken from. @param {number} fieldOfView height of the picture, degrees */
  viewpoint(fieldOfView) {
    const target = new Vector3().fromArray(this.camera.target ?? [0, 0, 0]);
    const eye = this.camera.eye ? new Vector3().fromArray(this.camera.eye) : target.clone().setZ(target.z + this.camera.distance);
    const {centre, radius} = this.framed;
    const away = eye.clone().sub(target);
    const own = away.length();
    const filling = radius / kFill / Math.sin((fieldOfView * Math.PI) / 360);
    away.multiplyScalar(Math.min(kFarthest, Math.max(kNearest, filling / own)));
    return {eye: away.add(centre), target: centre};
  }

  /** Puts light and ground where this scene wants them. @param {import('../view/surroundings.js').Surroundings} surroundings */
  light(surroundings) {
    const {centre, extent, ground} = this.framed;
    const floor = this.obstacles.floorHeight();
    surroundings.frame(centre.toArray(), extent, floor ?? ground, floor !== null);
    if (floor === null) surroundings.keepGroundBelow(this.low);
  }

  clear() {
    for (const view of this.cloths.values()) view.dispose();
    this.cloths.clear();
    this.balls.clear();
    this.obstacles.clear();
    this.framed = null;
  }

  /** The middle of the picture goes with cloths that go away, and stands still for those that flutter. */
  #follow(cloths) {
    const {centre, radius} = this.framed;
    const now = new Vector3();
    for (const view of cloths) now.add(new Vector3().fromArray(view.centre));
    const off = now.divideScalar(cloths.length).sub(this.framed.middle);
    const stray = off.length() - kAstray * radius;
    if (stray <= 0) return;
    off.setLength(stray);
    centre.add(off);
    this.framed.middle.add(off);
  }

  /** What stands with cloths of that extent, m: the figure that wears one, the table under one. */
  #company(cloths) {
    const solids = this.obstacles.meshes.filter((mesh) => mesh && mesh.userData.home.shape !== 'plane').map((mesh) => new Box3().setFromObject(mesh));
    return solids.filter((box) => !box.isEmpty() && box.min.distanceTo(box.max) <= kCompany * cloths);
  }

  /** The ball around all cloths and the solids with them, the longest side of a cloth, and where the ground is below them. */
  #measure(cloths) {
    const box = new Box3(), place = new Vector3();
    for (const {record} of cloths) {
      for (let at = 0; at < record.positions.length; at += 3) {
        box.expandByPoint(place.fromArray(record.positions, at).add({x: record.origin[0], y: record.origin[1], z: record.origin[2]}));
      }
    }
    for (const solid of this.#company(box.min.distanceTo(box.max))) box.union(solid);
    const extent = Math.max(...cloths.flatMap(({size}) => size));
    const lowest = Math.min(box.min.y, ...this.balls.ids.map((id) => this.balls.ball(id)).map(({position, radius}) => position[1] - radius));
    const middle = new Vector3();  // of the cloths' own centres, where these were
    for (const {centre} of cloths) middle.add(new Vector3().fromArray(centre));
    middle.divideScalar(cloths.length);
    return {middle, centre: box.getCenter(new Vector3()), radius: box.min.distanceTo(box.max) / 2, extent, ground: lowest - 0.25 * extent};
  }
}
