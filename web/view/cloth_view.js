import {BufferAttribute, BufferGeometry, DynamicDrawUsage, Group, LineSegments, Mesh} from '../three/three.module.js';
import {centreOf, gridNormals, lowestOf, materialCoordinates, sideIndices, tornNormals, tornOn, triangleIndices} from './grid.js';
import {Morph} from './morph.js';

const same = (a, b) => a.every((value, axis) => value === b[axis]);

/** One cloth on the stage: takes frames, keeps a mesh of the level at hand. */
export class ClothView {
  /**
   * @param {{cloth: number, name?: string, size: number[], look?: object}} description from the `scene` message
   * @param {import('../fabric/wardrobe.js').Wardrobe} wardrobe
   * @param {boolean} instant no morph between levels
   */
  constructor(description, wardrobe, instant) {
    this.id = description.cloth;
    this.name = description.name ?? `cloth ${description.cloth}`;
    this.size = description.size;
    this.wardrobe = wardrobe;
    this.fabric = wardrobe.lend(description.look);
    this.instant = instant;
    this.morph = new Morph(instant);
    this.group = new Group();  // stands at the origin
    this.rows = 0;
    this.cols = 0;
    /** The record of the newest frame shown: level, rows, cols, origin, positions. */
    this.record = null;
    /** Where in the world the mesh's own positions are from, m: its vertices have the same digits wherever the cloth is. */
    this.origin = [0, 0, 0];
    /** The record's torn faces as they are drawn, on the mesh's own grid. */
    this.torn = new Set();
    this.centre = null;
  }

  /**
   * Shows the cloth between two records; `pixel` is what one of the picture spans at the cloth, m.
   * @returns {boolean} whether the mesh still moves by itself (a morph is under way)
   */
  show(before, after, share, nowMs, pixel) {
    if (!same(after.origin, this.origin)) this.#moveOrigin(after.origin);
    if (!same(before.origin, this.origin)) before = after;
    // Between two levels a torn sheet's nodes would glide across its tears.
    this.morph.instant = this.instant || after.torn.length > 0;
    const mesh = this.morph.update(before, after, share, nowMs, pixel);
    const rebuilt = mesh.rows !== this.rows || mesh.cols !== this.cols;
    if (rebuilt) this.#rebuild(mesh.rows, mesh.cols);
    const torn = tornOn(after, mesh.rows);
    if (rebuilt || torn.size !== this.torn.size || [...torn].some((face) => !this.torn.has(face))) this.#cut(torn);
    const {position, normal} = this.geometry.attributes;
    position.array.set(mesh.positions);
    if (torn.size > 0) tornNormals(mesh.positions, mesh.rows, mesh.cols, torn, normal.array);
    else gridNormals(mesh.positions, mesh.rows, mesh.cols, normal.array);
    position.needsUpdate = true;
    this.geometry.boundingSphere = null;  // what a ray is tried against first: computed when one is
    normal.needsUpdate = true;
    this.record = after;
    this.centre = this.#inWorld(centreOf(after.positions));
    return this.morph.active;
  }

  /** Cells that are drawn: those that are not torn. */
  get facesDrawn() {
    return this.geometry.drawRange.count / 6;
  }

  /** Half the diagonal of a cell as drawn, with a sixth for stretch, m. */
  get halfDiagonal() {
    return (Math.hypot(this.size[0] / (this.cols - 1), this.size[1] / (this.rows - 1)) / 2) * (7 / 6);
  }

  /** Where (u, v) is shown, m. */
  placeAt(u, v) {
    const positions = this.geometry.attributes.position.array;
    const column = Math.min(this.cols - 2, Math.floor(u * (this.cols - 1))), row = Math.min(this.rows - 2, Math.floor(v * (this.rows - 1)));
    const right = u * (this.cols - 1) - column, down = v * (this.rows - 1) - row;
    const at = (r, c, axis) => positions[3 * (r * this.cols + c) + axis];
    return this.#inWorld([0, 1, 2].map((axis) =>
      (1 - down) * ((1 - right) * at(row, column, axis) + right * at(row, column + 1, axis)) +
      down * ((1 - right) * at(row + 1, column, axis) + right * at(row + 1, column + 1, axis))));
  }

  /** (u, v) of a point of the mesh by its texture coordinates. */
  uvOf({x, y}) {
    return [x / this.size[0], 1 - y / this.size[1]].map((share) => Math.min(1, Math.max(0, share)));
  }

  /** Lowest y shown, m. */
  lowest() {
    return this.origin[1] + lowestOf(this.geometry.attributes.position.array);
  }

  set wireframe(visible) {
    this.wireframeVisible = visible;
    if (this.lines) this.lines.visible = visible;
  }

  dispose() {
    this.wardrobe.takeBack(this.fabric);
    this.geometry?.dispose();
    this.lines?.geometry.dispose();
    this.group.removeFromParent();
  }

  #inWorld(place) {
    return place.map((value, axis) => this.origin[axis] + value);
  }

  /** Of a cloth that has gone far: what was shown from the old one is not mixed with what is from the new one. */
  #moveOrigin(origin) {
    this.origin = origin;
    this.group.position.fromArray(origin);
    this.morph = new Morph(this.instant);
  }

  /** Draws all faces but these. */
  #cut(torn) {
    this.torn = torn;
    const keep = (geometry, indices) => {
      geometry.index.array.set(indices);
      geometry.index.needsUpdate = true;
      geometry.setDrawRange(0, indices.length);
    };
    keep(this.geometry, triangleIndices(this.rows, this.cols, torn));
    keep(this.lines.geometry, sideIndices(this.rows, this.cols, torn));
  }

  #rebuild(rows, cols) {
    this.geometry?.dispose();
    this.lines?.geometry.dispose();
    this.rows = rows;
    this.cols = cols;
    const dynamic = () => new BufferAttribute(new Float32Array(rows * cols * 3), 3).setUsage(DynamicDrawUsage);
    const position = dynamic();
    this.geometry = new BufferGeometry()
      .setAttribute('position', position)
      .setAttribute('normal', dynamic())
      .setAttribute('uv', new BufferAttribute(materialCoordinates(rows, cols, ...this.size), 2))
      .setIndex(new BufferAttribute(triangleIndices(rows, cols), 1));
    if (this.fabric.materials.length > 1) this.fabric.materials.forEach((_, side) => this.geometry.addGroup(0, Infinity, side));
    const sides = new BufferGeometry()
      .setAttribute('position', position)
      .setIndex(new BufferAttribute(sideIndices(rows, cols), 1));
    if (!this.mesh) {
      const {materials} = this.fabric;
      this.mesh = new Mesh(this.geometry, materials.length > 1 ? materials : materials[0]);
      this.mesh.castShadow = this.mesh.receiveShadow = true;
      this.lines = new LineSegments(sides, this.wardrobe.wire);
      // The mesh moves every frame: bounds would have to be computed anew each time, for a thing nearly always in view.
      this.mesh.frustumCulled = this.lines.frustumCulled = false;
      this.lines.visible = this.wireframeVisible ?? false;
      this.group.add(this.mesh, this.lines);
    }
    this.mesh.geometry = this.geometry;
    this.lines.geometry = sides;
  }
}
