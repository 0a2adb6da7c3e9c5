import {Miniature} from './miniature.js';
import {Preview} from './preview.js';
import {addressOfScene} from '../app/settings.js';

const kStillMs = 1500;   // how long a picture that is to stand still is waited for: some scenes begin with a flat sheet
const kAgainMs = 5000;   // after a stream that failed

const count = (number, one, many) => (number === 0 ? `no ${many}` : number === 1 ? `one ${one}` : `${number} ${many}`);

/** A link to a scene, with a picture that moves while it has a turn. */
export class Card {
  /**
   * @param {{name: string, title: string, cloths: number}} scene as the list has it
   * @param {{painter: import('./painter.js').Painter, open: (card: Card) => void, painted: () => void, still: boolean}} gallery
   *   `painted`: this card has something new to draw; `still`: its picture does not move
   */
  constructor(scene, gallery) {
    this.name = scene.name;
    this.gallery = gallery;
    this.miniature = new Miniature(gallery.painter.wardrobe);
    this.preview = null;
    this.inSight = false;
    this.wanted = false;    // the viewer points at it
    this.sinceMs = null;    // streams since then
    this.lastMs = -Infinity;
    this.againMs = -Infinity;
    this.done = false;      // has the picture it keeps
    this.dirty = false;
    this.frames = 0;
    this.#build(scene);
  }

  /** Whether this card would stream if it had a turn. */
  mayStream(nowMs) {
    return this.inSight && !this.done && nowMs >= this.againMs;
  }

  /** What the list says now. Viewers of the scene that are this page's own pictures do not count. */
  tell({title, cloths, viewers}) {
    const others = Math.max(0, viewers - (this.preview ? 1 : 0));
    const facts = `${count(cloths, 'cloth', 'cloths')} · ${count(others, 'viewer', 'viewers')}`;
    if (this.title.textContent !== (title || this.name)) this.title.textContent = title || this.name;
    if (this.facts.textContent !== facts) this.facts.textContent = facts;
  }

  /** Begins or ends to stream. */
  setLive(on, nowMs, server, token) {
    if (on === (this.preview !== null)) {
      if (on && this.gallery.still && this.frames > 0 && nowMs - this.sinceMs > kStillMs) this.#keep(nowMs);
      return;
    }
    if (!on) return this.#stop(nowMs);
    this.sinceMs = nowMs;
    this.frames = 0;
    this.link.dataset.state = 'live';
    this.preview = new Preview(server, this.name, token, {
      begin: (message) => this.miniature.begin(message),
      surface: (obstacle, surface) => this.miniature.obstacles.setSurface(obstacle, surface),
      frame: (frame) => {
        this.miniature.show(frame);
        this.frames += 1;
        this.link.dataset.frames = String(Number(this.link.dataset.frames ?? 0) + 1);
        if (!this.gallery.still || this.frames === 1) this.soil();
      },
      ended: () => {
        this.againMs = performance.now() + kAgainMs;
        this.#stop(performance.now());
      },
    });
  }

  /** Its picture is to be drawn. */
  soil() {
    this.dirty = true;
    this.gallery.painted();
  }

  paint() {
    this.dirty = false;
    if (this.miniature.ready) this.gallery.painter.paint(this.miniature, this.canvas);
  }

  remove() {
    this.#stop(performance.now());
    this.miniature.clear();
    this.item.remove();
  }

  #stop(nowMs) {
    this.preview?.close();
    this.preview = null;
    this.sinceMs = null;
    this.lastMs = nowMs;
    this.link.dataset.state = 'still';
  }

  /** The newest picture stays. */
  #keep(nowMs) {
    this.done = true;
    this.#stop(nowMs);
    this.soil();
  }

  #build(scene) {
    const make = (tag, members, ...children) => {
      const element = Object.assign(document.createElement(tag), members);
      element.append(...children);
      return element;
    };
    this.canvas = make('canvas', {width: 1, height: 1});
    this.canvas.setAttribute('aria-hidden', 'true');
    this.title = make('h2', {});
    this.facts = make('span', {className: 'facts'});
    this.link = make('a', {className: 'card', href: addressOfScene(new URL(location.href), scene.name).href},
      this.canvas, this.title, make('span', {className: 'name', textContent: scene.name}), ' ', this.facts);
    this.link.dataset.scene = scene.name;
    this.link.dataset.state = 'still';
    this.item = make('li', {}, this.link);
    for (const [event, wanted] of [['pointerenter', true], ['focus', true], ['pointerleave', false], ['blur', false]]) {
      this.link.addEventListener(event, () => (this.wanted = wanted));
    }
    this.link.addEventListener('click', (event) => {
      if (event.ctrlKey || event.metaKey || event.shiftKey) return;  // to another tab or window
      event.preventDefault();
      this.gallery.open(this);
    });
  }
}
