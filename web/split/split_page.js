import {addressOfGallery, addressOfScene} from '../app/settings.js';
import {listScenes} from '../connection/scenes.js';
import {Player} from '../embed/player.js';
import {History} from './history.js';
import {distanceBetween, splitsOf} from './levels.js';

const kTellMs = 500;  // between two looks at how far apart they are
const kSmooth = 0.15;  // weight of the newest of the times of a step

const make = (tag, members = {}, ...children) => {
  const element = Object.assign(document.createElement(tag), members);
  element.append(...children);
  return element;
};

/** One scene at several levels side by side, seen from one place, each with what it costs and how far it is from the finest. */
export class SplitPage {
  #panes = [];
  #timer = null;
  #drawing = 0;  // the request for the next picture
  #visit = 0;  // counts calls of enter()
  #following = false;

  /**
   * @param {HTMLElement} place @param {import('../app/settings.js').Settings} settings @param {{token: string|null}} access
   * @param {import('../app/hud.js').Hud} hud @param {{goTo: (address: string) => void}} router
   */
  constructor(place, settings, access, hud, router) {
    Object.assign(this, {place, settings, access, hud, router});
    this.row = place.querySelector('#split-panes');
    this.title = place.querySelector('h1');
    this.back = place.querySelector('#split-back');
    this.reset = place.querySelector('#split-reset');
    this.reset.addEventListener('click', () => this.#all((commands) => commands.reset()));
    this.pause = place.querySelector('#split-pause');
    this.pause.addEventListener('click', () => this.#setPaused(this.pause.getAttribute('aria-pressed') !== 'true'));
    this.back.addEventListener('click', (event) => {
      if (event.ctrlKey || event.metaKey || event.shiftKey) return;  // to another tab or window
      event.preventDefault();
      router.goTo(this.back.href);
    });
    document.addEventListener('visibilitychange', () => this.here && (document.hidden ? this.#rest() : this.#open()));
    this.here = false;
  }

  /** Shows a scene at the levels that the server holds it to. */
  async enter(scene) {
    this.leave();
    this.here = true;
    this.title.textContent = scene;
    document.title = `${scene} at several levels · Weft`;
    this.back.href = addressOfScene(new URL(location.href), scene);
    const visit = ++this.#visit;
    const {scenes, locked} = await listScenes(this.settings.server, this.access.token);
    if (!this.here || this.#visit !== visit) return;
    if (locked) {
      this.hud.askToken('This server asks for a token.', (given) => {
        this.access.token = given;
        this.hud.showBanner(null);
        this.enter(scene);
      });
      return;
    }
    const held = splitsOf(scenes ?? []).get(scene) ?? [];
    if (held.length === 0) {
      this.back.href = addressOfGallery(new URL(location.href));
      this.hud.showBanner(`This server does not hold “${scene}” to several levels: weft serve ${scene} --split 6,5,4.`);
      return;
    }
    this.title.textContent = scenes.find(({name}) => name === scene).title || scene;
    try {
      for (const each of held) this.#panes.push(this.#pane(each));
    } catch (error) {  // no WebGL, or not for so many
      this.leave();
      this.hud.showFailure(error);
      return;
    }
    this.row.replaceChildren(...this.#panes.map(({figure}) => figure));
    this.#open();
  }

  focus() {
    this.back.focus();
  }

  leave() {
    this.here = false;
    this.hud.showBanner(null);
    this.#rest();
    for (const {player} of this.#panes) player.dispose();
    this.#panes = [];
    this.#offer();
    this.row.replaceChildren();
  }

  #open() {
    if (document.hidden || this.#panes.length === 0) return;
    for (const {player, scene} of this.#panes) player.open(this.settings.server, scene, this.access.token);
    this.#timer = setInterval(() => this.#compare(), kTellMs);
    const draw = (nowMs) => {
      for (const {player} of this.#panes) player.draw(nowMs);
      this.#drawing = requestAnimationFrame(draw);
    };
    this.#drawing = requestAnimationFrame(draw);
  }

  #rest() {
    clearInterval(this.#timer);
    cancelAnimationFrame(this.#drawing);
    for (const {player} of this.#panes) player.close();
  }

  #pane({scene, level}) {
    const canvas = make('canvas', {});
    canvas.setAttribute('role', 'img');
    canvas.setAttribute('aria-label', `The scene at level ${level}`);
    const facts = {};
    const rows = [['nodes', 'Nodes'], ['step', 'A step'], ['time', 'Time'], ['apart', 'From the finest']].map(([key, label]) => {
      facts[key] = make('dd', {textContent: '–'});
      return make('div', {}, make('dt', {textContent: label}), facts[key]);
    });
    const figure = make('figure', {}, canvas, make('figcaption', {}, make('h2', {textContent: `Level ${level}`}), make('dl', {}, ...rows)));
    figure.dataset.scene = scene;
    const pane = {scene, level, figure, facts, history: new History(), stepMs: null, dt: 0};
    pane.player = new Player(canvas, {...this.settings, instant: true}, {
      state: () => this.#offer(),
      scene: (message) => (pane.dt = message.dt),
      frame: (frame) => pane.history.add(frame),
      stats: (message) => {
        if (message.rate === 0) return;  // nothing is stepped
        pane.stepMs = pane.stepMs === null ? message.step_ms : pane.stepMs + kSmooth * (message.step_ms - pane.stepMs);
        facts.nodes.textContent = message.cloths.reduce((sum, {nodes}) => sum + nodes, 0).toLocaleString('en');
        facts.step.textContent = `${pane.stepMs.toFixed(2)} ms`;
      },
    });
    pane.player.rig.controls.addEventListener('change', () => this.#follow(pane));
    return pane;
  }

  /** All look from where the viewer has gone with one. */
  #follow(leader) {
    if (this.#following) return;
    this.#following = true;
    const {eye, target} = leader.player.rig.view;
    for (const pane of this.#panes) if (pane !== leader) pane.player.rig.place(eye, target);
    this.#following = false;
  }

  /** Tells their times, and how far each is from the finest at the same time of both. */
  #compare() {
    const [finest] = this.#panes;
    for (const pane of this.#panes) {
      const newest = pane.history.frames.at(-1);
      if (!newest) continue;
      pane.facts.time.textContent = `${newest.stamp.time.toFixed(2)} s`;
      if (pane === finest) continue;
      const both = finest.history.newestWith(pane.history, pane.dt / 2);
      pane.facts.apart.textContent = both ? apartText(...both) : 'after Reset all';
    }
  }

  /** What concerns all is offered when all are connected. */
  #offer() {
    const all = this.#panes.length > 0 && this.#panes.every(({player}) => player.commands);
    for (const button of [this.reset, this.pause]) button.disabled = !all;
  }

  #setPaused(paused) {
    this.pause.setAttribute('aria-pressed', String(paused));
    this.#all((commands) => (paused ? commands.pause() : commands.resume()));
  }

  /** The buttons are there only while all are connected. */
  #all(command) {
    for (const {player} of this.#panes) {
      command(player.commands).catch((error) => error.code !== 'closed' && this.hud.toast(error.message));
    }
  }
}

/** Of the cloth that is farthest apart. */
function apartText(fine, coarse) {
  const apart = coarse.cloths.map((record) => {
    const other = fine.cloths.find(({cloth}) => cloth === record.cloth);
    return other ? distanceBetween(other, record) : null;
  }).filter((each) => each !== null);
  return apart.length > 0 ? `${(1000 * Math.max(...apart)).toFixed(1)} mm at ${coarse.stamp.time.toFixed(1)} s` : '–';
}
