import {backoff} from '../protocol/weft.js';
import {kNoToken, kUnknownToken, listScenes} from '../connection/scenes.js';
import {Card} from './card.js';
import {chooseLive} from './turns.js';
import {Painter} from './painter.js';
import {withoutHeld} from '../split/levels.js';

const kMostLive = 4;     // streams at once
const kTurnMs = 4000;    // of a card, where others wait
const kTickMs = 250;     // between two looks at whose turn it is
const kListMs = 5000;    // between two looks at the list
const kLeastSeen = 0.3;  // of a card, so that it is in sight

/** All scenes of the server, a card each. Nothing is asked of the server while it is not shown, or the page is hidden. */
export class Gallery {
  /**
   * @param {HTMLElement} place
   * @param {import('../app/settings.js').Settings} settings
   * @param {{token: string|null}} access
   * @param {import('../app/hud.js').Hud} hud
   * @param {{open: (address: string) => void, single: (scene: string) => void}} router `single`: there is only this scene
   */
  constructor(place, settings, access, hud, router) {
    Object.assign(this, {place, settings, access, hud, router});
    this.list = place.querySelector('#gallery-cards');
    this.summary = place.querySelector('#gallery-summary');
    this.still = matchMedia('(prefers-reduced-motion: reduce)').matches;
    this.painter = null;  // made with the first card: there may be no gallery at all
    /** @type {Map<string, Card>} */
    this.cards = new Map();
    this.here = false;
    this.working = false;  // shown, and not hidden
    this.timers = [];
    this.sight = new IntersectionObserver((entries) => {
      for (const {target, isIntersecting} of entries) {
        const card = this.cards.get(target.dataset.scene);  // gone, if its scene was ended meanwhile
        if (card) card.inSight = isIntersecting;
      }
    }, {root: place, threshold: kLeastSeen});
    this.sizes = new ResizeObserver((entries) => {
      for (const {target} of entries) this.cards.get(target.parentElement.dataset.scene)?.soil();
    });
    document.addEventListener('visibilitychange', () => this.#work());
    hud.onRetry(() => this.working && this.#lookNow());
    addEventListener('online', () => this.working && this.#lookNow());
  }

  enter() {
    this.here = true;
    document.title = 'Weft';
    for (const card of this.cards.values()) card.done = false;
    this.#work();
  }

  /** On the card of the scene that was opened last, else on the first. */
  focus() {
    (this.cards.get(this.opened) ?? this.cards.values().next().value)?.link.focus();
  }

  leave() {
    this.here = false;
    this.hud.showBanner(null);
    this.#work();
  }

  /** A card is to be drawn: all that are, with the next picture of the screen. */
  painted() {
    this.drawing ??= requestAnimationFrame(() => {
      this.drawing = null;
      for (const card of this.cards.values()) if (card.dirty && card.inSight) card.paint();
    });
  }

  /** Opens a card. */
  open({name, link}) {
    this.opened = name;
    this.router.open(link.href);
  }

  /** Begins or ends whatever costs the server something. */
  #work() {
    const working = this.here && !document.hidden;
    if (working === this.working) return;
    this.working = working;
    this.timers.forEach(clearInterval);
    this.timers = [];
    clearTimeout(this.looking);
    if (!working) {
      for (const card of this.cards.values()) card.setLive(false, performance.now());
      return;
    }
    this.timers = [setInterval(() => this.#giveTurns(), kTickMs)];
    this.#lookNow();
  }

  #giveTurns() {
    const nowMs = performance.now();
    const cards = [...this.cards.values()];
    const live = chooseLive(cards.filter((card) => card.mayStream(nowMs)), nowMs, {most: kMostLive, turnMs: kTurnMs});
    // Those that end make room first.
    for (const card of cards) if (!live.has(card.name)) card.setLive(false, nowMs);
    for (const card of cards) if (live.has(card.name)) card.setLive(true, nowMs, this.settings.server, this.access.token);
  }

  #lookNow() {
    clearTimeout(this.looking);
    this.#look(0);
  }

  /** Asks for the list of scenes, again and again; `failed`: how often in a row there was none. */
  async #look(failed) {
    const round = (this.round = (this.round ?? 0) + 1);
    const {scenes: all, locked} = await listScenes(this.settings.server, this.access.token);
    if (!this.working || round !== this.round) return;
    const scenes = all && withoutHeld(all);
    if (locked) return this.#askToken();
    let delay = kListMs;
    if (scenes) {
      this.hud.showBanner(null);
      if (scenes.length === 1 && this.cards.size === 0) return this.router.single(scenes[0].name);
      this.#tell(scenes);
      if (!this.working) return;
    } else {
      delay = backoff(failed);
      this.hud.showBanner(`No list of scenes from ${new URL(this.settings.server).host}. Next attempt in ${Math.ceil(delay / 1000)} s.`, true);
    }
    this.looking = setTimeout(() => this.#look(scenes ? 0 : failed + 1), delay);
  }

  #askToken() {
    for (const card of this.cards.values()) card.setLive(false, performance.now());
    this.hud.askToken(this.access.token ? kUnknownToken : kNoToken, (given) => {
      this.access.token = given;
      this.#lookNow();
    });
  }

  /** Shows the list: new scenes get a card, those that are gone lose theirs. */
  #tell(scenes) {
    try {
      this.painter ??= new Painter(this.settings, () => this.cards.forEach((card) => card.soil()));
    } catch (error) {
      this.leave();
      this.hud.showFailure(error);
      return;
    }
    const summary = scenes.length === 0 ? 'This server has no scene.' : `${scenes.length} ${scenes.length === 1 ? 'scene' : 'scenes'}`;
    if (this.summary.textContent !== summary) this.summary.textContent = summary;
    const names = new Set(scenes.map(({name}) => name));
    for (const [name, card] of this.cards) {
      if (names.has(name)) continue;
      this.sight.unobserve(card.link);
      this.sizes.unobserve(card.canvas);
      card.remove();
      this.cards.delete(name);
    }
    for (const scene of scenes) {
      let card = this.cards.get(scene.name);
      if (!card) {
        card = new Card(scene, this);
        this.cards.set(scene.name, card);
        this.list.append(card.item);
        this.sight.observe(card.link);
        this.sizes.observe(card.canvas);
      }
      card.tell(scene);
    }
  }
}
