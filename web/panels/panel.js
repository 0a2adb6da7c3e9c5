import {FrictionRow} from './friction_row.js';
import {PlaceFields} from './place_fields.js';
import {anglesOf, directionOf} from './wind_angles.js';

const byId = (id) => document.getElementById(id);
const kWindMs = 60;  // between two wind.set while a slider moves
const kHoldMs = 600;  // what the viewer has set is not overwritten by what the server still says
/** Sliders of how long gusts last and how large eddies are. */
const kScales = {'wind-gust-time': {member: 'time_scale', unit: 's'}, 'wind-eddy-size': {member: 'length_scale', unit: 'm'}};

/**
 * The controls. They show what the server says, and tell `actions` what the viewer wants; they change nothing by themselves.
 *
 * @typedef {object} Actions
 * @property {(scene: string) => void} joinScene
 * @property {(paused: boolean) => void} setPaused
 * @property {() => void} step
 * @property {() => void} reset
 * @property {(distance: number) => void} goTo
 * @property {(on: boolean) => void} setWireframe
 * @property {(wind: {direction: number[], speed: number, gusts: number, turbulence: number, time_scale?: number, length_scale?: number}) => void} setWind
 * @property {() => void} addBall
 * @property {(ball: number) => void} removeBall
 * @property {(ball: number) => void} throwBall
 * @property {(ball: number) => void} chooseBall
 * @property {(ball: number, position: number[]) => void} moveBall
 * @property {(ball: number, friction: number) => void} setBallFriction
 * @property {(on: boolean) => void} setHandTool
 */
export class Panel {
  /** @param {Actions} actions */
  constructor(actions) {
    this.actions = actions;
    this.paused = false;
    this.ballIds = [];
    this.windHeldUntilMs = 0;
    this.#wireButtons();
    this.#wireWind();
    this.#wireBalls();
    this.#wireFold();
    this.setLive(false, true);
  }

  /** Controls work only while connected, and for those who may do more than look. */
  setLive(connected, mayControl) {
    const live = connected && mayControl;
    this.live = live;
    byId('scene').disabled = !connected;
    for (const id of ['pause', 'reset', 'ball-add']) byId(id).disabled = !live;
    byId('step').disabled = !live || !this.paused;
    this.#enableWind();
    this.#enableBalls();
  }

  setScenes(scenes, current) {
    const select = byId('scene');
    const options = scenes.map(({name}) => name);
    if (current && !options.includes(current)) options.unshift(current);
    if ([...select.options].map((option) => option.value).join() !== options.join()) {
      select.replaceChildren(...scenes.map(({name, title}) => Object.assign(new Option(name, name), {title: title ?? ''})));
      if (select.options.length < options.length) select.prepend(new Option(current, current));
    }
    if (current) select.value = current;
  }

  setTitle(title) {
    byId('scene-title').textContent = title ?? '';
  }

  setPaused(paused) {
    this.paused = paused;
    const button = byId('pause');
    button.textContent = paused ? 'Resume' : 'Pause';
    button.setAttribute('aria-pressed', String(paused));
    byId('step').disabled = !this.live || !paused;
  }

  setWireframe(on) {
    byId('wireframe').checked = on;
  }

  setHandTool(on) {
    byId('hand').setAttribute('aria-pressed', String(on));
  }

  /** @param {{direction: number[], speed: number, gusts?: number, turbulence?: number, time_scale?: number, length_scale?: number}} wind @param {boolean} available whether the scene has an effect of wind */
  setWind(wind, available) {
    this.windAvailable = available;
    byId('wind-absent').hidden = available;
    this.#enableWind();
    // A slider under the viewer's hand is not pulled away.
    if (performance.now() > this.windHeldUntilMs) {
      const {heading, tilt} = anglesOf(wind.direction);
      byId('wind-speed').max = String(Math.max(20, Math.ceil(wind.speed)));
      byId('wind-speed').value = String(wind.speed);
      // Straight up or down has no heading: the slider stays where it was.
      if (Math.abs(tilt) < 90) byId('wind-heading').value = String(heading);
      byId('wind-tilt').value = String(tilt);
      byId('wind-gusts').value = String(wind.gusts ?? 0);
      byId('wind-eddies').value = String(wind.turbulence ?? 0);
      // Told only where there are gusts, or eddies.
      for (const [id, {member}] of Object.entries(kScales)) if (member in wind) byId(id).value = String(wind[member]);
      this.#showWind();
    }
  }

  /** @param {number[]} ids the scene's balls @param {number|null} chosen */
  setBalls(ids, chosen) {
    const select = byId('ball');
    if (ids.join() !== this.ballIds.join()) {
      this.ballIds = ids;
      select.replaceChildren(...ids.map((id) => new Option(`ball ${id}`, String(id))));
    }
    if (chosen !== null && select.value !== String(chosen)) select.value = String(chosen);
    this.ballFriction.choose(chosen);
    this.#enableBalls();
  }

  /** @param {number[]|undefined} position of the chosen ball, m */
  setBallPlace(position) {
    this.ballPlace.show(position);
  }

  /** @param {{ball: number, friction?: number}[]} balls the scene's, as messages tell them */
  setBallFrictions(balls) {
    this.ballFriction.set(balls.map(({ball, friction}) => [ball, friction]));
  }

  /** @returns {[number, number]} what the panel covers of the window's right and bottom, CSS pixels */
  covers() {
    const box = byId('controls').getBoundingClientRect();
    if (box.width > innerWidth / 2) return [0, innerHeight - box.top];  // a phone: it lies along the bottom
    return [box.height > innerHeight / 2 ? innerWidth - box.left : 0, 0];
  }

  #chosenBall() {
    return Number(byId('ball').value);
  }

  #enableWind() {
    for (const input of byId('wind').querySelectorAll('input')) input.disabled = !this.live || !this.windAvailable;
  }

  #enableBalls() {
    const none = !this.live || this.ballIds.length === 0;
    for (const id of ['ball-remove', 'ball-throw', 'ball']) byId(id).disabled = none;
    this.ballPlace.enable(!none);
    this.ballFriction.enable(!none);
  }

  #wireButtons() {
    const {actions} = this;
    byId('scene').addEventListener('change', (event) => actions.joinScene(event.target.value));
    byId('pause').addEventListener('click', () => actions.setPaused(!this.paused));
    byId('step').addEventListener('click', () => actions.step());
    byId('reset').addEventListener('click', () => actions.reset());
    byId('hand').addEventListener('click', () => actions.setHandTool(byId('hand').getAttribute('aria-pressed') !== 'true'));
    byId('wireframe').addEventListener('change', (event) => actions.setWireframe(event.target.checked));
    byId('jumps').addEventListener('click', (event) => {
      const {distance} = event.target.dataset;
      if (distance) actions.goTo(Number(distance));
    });
  }

  #wireWind() {
    let timer = null;
    let scales = {};  // only what was moved: the scene's own may be beyond a slider, and is not told before there are any
    const send = () => {
      timer = null;
      const [speed, heading, tilt, gusts, turbulence] = this.#sliders();
      this.actions.setWind({direction: directionOf(heading, tilt), speed, gusts, turbulence, ...scales});
      scales = {};
    };
    byId('wind').addEventListener('input', ({target}) => {
      if (target.id in kScales) scales[kScales[target.id].member] = Number(target.value);
      this.windHeldUntilMs = performance.now() + kHoldMs;
      this.#showWind();
      timer ??= setTimeout(send, kWindMs);
    });
  }

  /** Speed, heading, tilt, gusts, eddies. */
  #sliders() {
    return ['speed', 'heading', 'tilt', 'gusts', 'eddies'].map((name) => Number(byId(`wind-${name}`).value));
  }

  #showWind() {
    const [speed, heading, tilt, gusts, eddies] = this.#sliders();
    byId('wind-speed-value').textContent = `${speed.toFixed(1)} m/s`;
    byId('wind-heading-value').textContent = `${heading}°`;
    byId('wind-tilt-value').textContent = `${tilt}°`;
    byId('wind-gusts-value').textContent = `${Math.round(100 * gusts)} %`;
    byId('wind-eddies-value').textContent = `${Math.round(100 * eddies)} %`;
    for (const [id, {unit}] of Object.entries(kScales)) byId(`${id}-value`).textContent = `${byId(id).value} ${unit}`;
  }

  #wireBalls() {
    const {actions} = this;
    byId('ball-add').addEventListener('click', () => actions.addBall());
    byId('ball-remove').addEventListener('click', () => actions.removeBall(this.#chosenBall()));
    byId('ball-throw').addEventListener('click', () => actions.throwBall(this.#chosenBall()));
    byId('ball').addEventListener('change', () => {
      this.ballPlace.release();
      this.ballFriction.choose(this.#chosenBall());
      actions.chooseBall(this.#chosenBall());
    });
    this.ballFriction = new FrictionRow(byId('ball-friction'), actions.setBallFriction);
    this.ballPlace = new PlaceFields(byId('ball-place'), (position) => actions.moveBall(this.#chosenBall(), position));
  }

  #wireFold() {
    const button = byId('fold');
    const fold = (hidden) => {
      byId('controls-body').hidden = hidden;
      button.setAttribute('aria-expanded', String(!hidden));
      button.textContent = hidden ? 'Show' : 'Hide';
    };
    button.addEventListener('click', () => fold(!byId('controls-body').hidden));
    fold(matchMedia('(max-width: 640px)').matches);
  }
}
