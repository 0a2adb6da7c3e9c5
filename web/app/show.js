import {BallsView} from '../view/balls_view.js';
import {ClothView} from '../view/cloth_view.js';
import {Loupe} from '../view/loupe.js';
import {MarksView} from '../view/marks_view.js';
import {ObstaclesView} from '../view/obstacles_view.js';
import {Timeline} from '../view/timeline.js';
import {Wardrobe} from '../fabric/wardrobe.js';
import {WindArrow} from '../view/wind_arrow.js';
import {ZonesView} from '../view/zones_view.js';

const kFinePixels = 1024, kPlainPixels = 512;  // side of a fabric's picture
const kWindEffects = ['paper_wind', 'aerodynamics'];

const distanceTo = (eye, centre) => Math.hypot(eye[0] - centre[0], eye[1] - centre[1], eye[2] - centre[2]);

/** One scene on the stage, as the server's messages and frames tell it. */
export class Show {
  /**
   * @param {import('../view/stage.js').Stage} stage
   * @param {{instant: boolean, wireframe: boolean, high: boolean, arrow?: HTMLElement, loupe?: HTMLElement}} options the last two are
   *   where wind and magnifying glass are shown, if at all
   */
  constructor(stage, options) {
    this.stage = stage;
    this.instant = options.instant;
    this.wireframe = options.wireframe;
    this.timeline = new Timeline();
    this.balls = new BallsView();
    this.obstacles = new ObstaclesView();
    this.marks = new MarksView();
    this.zones = new ZonesView();
    this.arrow = options.arrow ? new WindArrow(options.arrow) : null;
    this.loupe = options.loupe ? new Loupe(options.loupe, stage) : null;
    stage.overlays.push(...[this.loupe, this.arrow].filter(Boolean));
    this.wardrobe = new Wardrobe({high: options.high, pixels: options.high ? kFinePixels : kPlainPixels, anisotropy: stage.anisotropy});
    this.wardrobe.setOffset(this.wireframe);
    stage.scene.add(this.balls.group, this.obstacles.group, this.marks.group, this.zones.group);
    /** @type {Map<number, ClothView>} */
    this.cloths = new Map();
    this.description = null;
    this.wind = {direction: [0, 0, -1], speed: 0};
    this.framesShown = 0;
    /** How much older than the newest frame what is shown is, ms; null when it stands still. @type {number|null} */
    this.behindMs = null;
    this.moving = false;
  }

  /** Shows nothing but the ground. */
  clear() {
    this.description = null;
    this.timeline.clear();
    for (const view of this.cloths.values()) view.dispose();
    this.cloths.clear();
    this.balls.clear();
    this.obstacles.clear();
    this.marks.clear();
    this.zones.show([]);
    this.arrow?.set(this.wind.direction, 0);
    this.loupe?.lookAt(null);
    this.moving = false;
    this.stage.changed = true;
  }

  /** Takes a `scene` message: everything of the scene before is gone. */
  begin(message) {
    this.clear();
    this.description = message;
    this.obstacles.show(message.obstacles ?? []);
    for (const description of message.cloths) {
      const view = new ClothView(description, this.wardrobe, this.instant);
      view.wireframe = this.wireframe;
      this.stage.scene.add(view.group);
      this.cloths.set(view.id, view);
      this.setPins(view.id, description.pins ?? []);
    }
    this.setWind(message.wind);
    this.framesShown = 0;
    this.stage.changed = true;
  }

  /** Takes the surface of one of the scene's obstacles. */
  setSurface({scene, obstacle, surface}) {
    if (scene !== this.description?.name) return;  // of the one before
    this.obstacles.setSurface(obstacle, surface);
    this.stage.changed = true;
  }

  get hasWind() {
    return this.description?.effects.some((effect) => kWindEffects.includes(effect)) ?? false;
  }

  setWind(wind) {
    if (!wind) return;
    this.wind = wind;
    this.zones.show(wind.zones ?? []);
    this.arrow?.set(wind.direction, this.hasWind ? wind.speed : 0);
    this.stage.changed = true;
  }

  setZonesShown(on) {
    this.zones.group.visible = on;
    this.stage.changed = true;
  }

  /** @param {number} cloth @param {{u: number[], v: number[]}[]} pins what holds it now */
  setPins(cloth, pins) {
    this.marks.setPins(cloth, pins);
  }

  /** A pin of `cloth` no farther from (u, v) than a share of the cloth's shorter side, or undefined. */
  pinNear(cloth, u, v, share) {
    const {size} = this.cloths.get(cloth);
    const off = (at, [from, to]) => Math.max(from - at, at - to, 0);
    return this.marks.held.get(cloth)
      .find((pin) => Math.hypot(size[0] * off(u, pin.u), size[1] * off(v, pin.v)) <= share * Math.min(...size));
  }

  clothMeshes() {
    return [...this.cloths.values()].flatMap((view) => view.mesh ?? []);
  }

  /** The cloth that is drawn by a mesh, or undefined. */
  clothOf(mesh) {
    return [...this.cloths.values()].find((view) => view.mesh === mesh);
  }

  setWireframe(on) {
    this.wireframe = on;
    this.wardrobe.setOffset(on);
    for (const view of this.cloths.values()) view.wireframe = on;
    this.stage.changed = true;
  }

  push(frame, arrivedMs) {
    this.timeline.push(frame, arrivedMs);
    this.moving = true;
  }

  /** Shows the moment `nowMs` (drawing time) of the buffer, whose clock reads `bufferMs`. */
  update(nowMs, bufferMs) {
    if (this.marks.changed) {
      this.marks.update(this.cloths);
      this.stage.changed = true;
    }
    if (!this.moving) return;
    const moment = this.timeline.sample(bufferMs);
    if (!moment || !this.description) return;
    const {before, after, share} = moment;
    let morphing = false;
    for (const record of after.cloths) {
      const view = this.cloths.get(record.cloth);
      if (!view) continue;
      const earlier = before.cloths.find((each) => each.cloth === record.cloth) ?? record;
      morphing = view.show(earlier, record, share, nowMs, view.centre ? this.stage.pixelAt(view.centre) : Infinity) || morphing;
    }
    const coarsest = Math.max(0, ...[...this.cloths.values()].map((view) => view.halfDiagonal || 0));
    this.balls.show(before.balls, after.balls, share, coarsest);
    this.obstacles.move(before.obstacles, after.obstacles, share);
    this.marks.update(this.cloths);
    this.stamp = after.stamp;
    this.behindMs = moment.settled ? null : moment.behindMs;
    this.#arrange(this.framesShown++ === 0);
    this.moving = morphing || !moment.settled;
    this.stage.changed = true;
  }

  /** Cloths with their distance from `eye`, the nearest first: what the badge shows. */
  levels(eye) {
    return [...this.cloths.values()]
      .filter((view) => view.record)
      .map((view) => ({
        cloth: view.id, name: view.name, level: view.record.level, simulatedLevel: view.record.simulatedLevel,
        rows: view.record.rows, cols: view.record.cols, quantum: view.record.quantum,
        faces: view.facesDrawn, centre: view.centre, distance: distanceTo(eye, view.centre),
      }))
      .sort((a, b) => a.distance - b.distance);
  }

  /** Levels a cloth can have. */
  levelRange(cloth) {
    const {min_level: minLevel, max_level: maxLevel} = this.description.cloths.find((each) => each.cloth === cloth);
    return {minLevel, maxLevel};
  }

  /** Ground and light: set once a scene; the ground is the scene's floor, or gives way to a cloth that comes lower. */
  #arrange(first) {
    let low = Infinity, extent = 0;
    const views = [...this.cloths.values()].filter((view) => view.record);
    if (views.length === 0) return;
    for (const view of views) {
      low = Math.min(low, view.lowest());
      extent = Math.max(extent, ...view.size);
    }
    const {centre} = views[0];
    this.loupe?.lookAt(centre, extent);
    const {surroundings} = this.stage;
    if (!first) return surroundings.keepGroundBelow(low);
    const floor = this.obstacles.floorHeight();
    if (floor !== null) return surroundings.frame(centre, extent, floor, true);
    // Balls count only at the start: a thrown one falls for ever.
    for (const id of this.balls.ids) {
      const {position, radius} = this.balls.ball(id);
      low = Math.min(low, position[1] - radius);
    }
    surroundings.frame(centre, extent, low - 0.25 * extent);
  }
}
