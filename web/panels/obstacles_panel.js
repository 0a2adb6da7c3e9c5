import {FrictionRow} from './friction_row.js';
import {PlaceFields} from './place_fields.js';

const byId = (id) => document.getElementById(id);

/** The obstacles' part of the controls: where one stands, how it holds cloth, and a throw for one that has a mass. Shows what the server says. */
export class ObstaclesPanel {
  /**
   * @param {{choose: (obstacle: number) => void, move: (obstacle: number, position: number[]) => void, throw: (obstacle: number) => void,
   *          setFriction: (obstacle: number, friction: number) => void}} actions
   */
  constructor(actions) {
    this.live = false;
    /** @type {import('../protocol/weft.js').Obstacle[]} the scene's, in its order */
    this.obstacles = [];
    this.place = new PlaceFields(byId('obstacle-place'), (position) => actions.move(this.chosen, position));
    this.friction = new FrictionRow(byId('obstacle-friction'), actions.setFriction);
    byId('obstacle').addEventListener('change', () => {
      this.#chose();
      actions.choose(this.chosen);
    });
    byId('obstacle-throw').addEventListener('click', () => actions.throw(this.chosen));
  }

  /** By its place in the scene. */
  get chosen() {
    return Number(byId('obstacle').value);
  }

  setLive(live) {
    this.live = live;
    this.#enable();
  }

  /** @param {import('../protocol/weft.js').Obstacle[]} obstacles the scene's */
  begin(obstacles) {
    this.obstacles = obstacles;
    byId('obstacles').hidden = obstacles.length === 0;
    byId('obstacle').replaceChildren(...obstacles.map(({shape, mass}, index) =>
      new Option(`${shape} ${index}${mass ? `, ${Number(mass.toPrecision(3))} kg` : ''}`, String(index))));
    this.setFrictions(obstacles.map(({friction}) => friction));
    this.choose(Math.max(0, obstacles.findIndex(({shape}) => shape !== 'plane')));  // hardly the floor
  }

  choose(obstacle) {
    byId('obstacle').value = String(obstacle);
    this.#chose();
  }

  /** @param {(number|undefined)[]} frictions of all, in their order */
  setFrictions(frictions) {
    this.friction.set([...frictions.entries()]);
  }

  /** @param {number[]|undefined} position of the chosen one, m */
  setPlace(position) {
    this.place.show(position);
  }

  #chose() {
    this.place.release();
    this.friction.choose(this.chosen);
    this.#enable();
  }

  #enable() {
    const any = this.live && this.obstacles.length > 0;
    byId('obstacle').disabled = !any;
    byId('obstacle-throw').disabled = !any || !this.obstacles[this.chosen].mass;
    this.place.enable(any);
    this.friction.enable(any);
  }
}
