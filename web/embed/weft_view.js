import {serverAddress} from '../app/settings.js';
import {Player} from './player.js';

const kFieldOfView = 42;  // degrees
const kStyle = new CSSStyleSheet();  // a page's policy may forbid style elements
kStyle.replaceSync(`
  :host { display: block; position: relative; width: 100%; aspect-ratio: 16 / 10; overflow: hidden; }
  :host([hidden]) { display: none; }
  canvas { display: block; width: 100%; height: 100%; }
  p { position: absolute; inset: auto 0 0; margin: 0; padding: 6px 10px; font: 13px/1.4 system-ui, sans-serif; color: #fff; background: rgb(0 0 0 / 0.55); }
  p[hidden] { display: none; }`);
const kSays = {connecting: null, open: null, closed: null, waiting: 'Not connected to the scene. It is tried again.'};

/**
 * `<weft-view server="wss://weft.example" scene="flag" distance="3" controls></weft-view>`: a scene in any page.
 *
 * | attribute | meaning |
 * | `server` | the service; left out, the one that this module came from |
 * | `scene` | its name; without one nothing is shown |
 * | `token` | shown to the service, where it asks for one; whoever reads the page can read it: give one of the role `view` |
 * | `distance` | of the camera from what the scene's own looks at, m |
 * | `controls` | turn, zoom and pan by mouse or finger; without it the page scrolls on |
 * | `quality` | `low` for machines without a graphics card |
 * | `label` | what is shown, for those who do not see it |
 *
 * Fires `weft-state` (`detail`: `connecting`, `open`, `waiting` or `closed`) and `weft-stats` (`detail`: the `stats` message). It is
 * connected only while it is part of the page, in sight, and the page is not hidden.
 */
export class WeftView extends HTMLElement {
  static observedAttributes = ['server', 'scene', 'token', 'distance', 'controls', 'label'];

  #player = null;
  #inSight = false;
  #working = false;
  #state = 'closed';
  #sight = null;
  #leaving = null;
  #drawing = null;

  constructor() {
    super();
    const root = this.attachShadow({mode: 'open'});
    root.adoptedStyleSheets = [kStyle];
    this.canvas = document.createElement('canvas');
    this.canvas.setAttribute('role', 'img');
    this.said = Object.assign(document.createElement('p'), {hidden: true});
    this.said.setAttribute('role', 'status');
    root.append(this.canvas, this.said);
  }

  /** `connecting`, `open`, `waiting` (tries again by itself) or `closed`. */
  get state() {
    return this.#state;
  }

  /** Frames received so far. */
  get frames() {
    return this.#player?.frames ?? 0;
  }

  /** Where the camera is, m. @returns {number[]|null} */
  get eye() {
    return this.#player?.rig.eye ?? null;
  }

  /** The client's commands (protocol/clients/js) while connected, else null. */
  get commands() {
    return this.#player?.commands ?? null;
  }

  connectedCallback() {
    this.#leaving = new AbortController();
    this.#sight = new IntersectionObserver((entries) => {
      this.#inSight = entries.at(-1).isIntersecting;
      this.#work();
    });
    this.#sight.observe(this);
    document.addEventListener('visibilitychange', () => this.#work(), {signal: this.#leaving.signal});
    this.#label();
  }

  disconnectedCallback() {
    this.#leaving.abort();
    this.#sight.disconnect();
    this.#inSight = false;
    this.#work();
    this.#player?.dispose();
    this.#player = null;
    // A canvas whose WebGL is gone gives no other: back in the page this element needs a fresh one.
    const fresh = this.canvas.cloneNode();
    this.canvas.replaceWith(fresh);
    this.canvas = fresh;
  }

  attributeChangedCallback(name) {
    if (name === 'label') this.#label();
    else if (name === 'controls') this.#player?.setControls(this.hasAttribute('controls'));
    else if (name === 'distance') this.#player?.setDistance(this.#distance);
    else this.#work(true);
  }

  get #distance() {
    const metres = Number(this.getAttribute('distance'));
    return metres > 0 ? metres : null;
  }

  #label() {
    this.canvas.setAttribute('aria-label', this.getAttribute('label') ?? `The scene ${this.getAttribute('scene') ?? ''}`);
  }

  /** Begins or ends whatever costs the server something; `again`: with another server or scene. */
  #work(again = false) {
    const scene = this.getAttribute('scene');
    const working = Boolean(scene) && this.isConnected && this.#inSight && !document.hidden;
    if (working === this.#working && !again) return;
    this.#working = working;
    if (!working) return this.#player?.close();
    try {
      this.#player ??= this.#makePlayer();
      const server = serverAddress(this.getAttribute('server'), new URL('..', import.meta.url));
      this.#player.open(server, scene, this.getAttribute('token'));
    } catch (error) {  // no WebGL, or an address that is none
      this.#player?.close();
      this.#say(error.message);
      return;
    }
    this.#drawing ??= requestAnimationFrame((nowMs) => this.#draw(nowMs));
  }

  #draw(nowMs) {
    this.#drawing = this.#working ? requestAnimationFrame((next) => this.#draw(next)) : null;
    if (this.#working) this.#player.draw(nowMs);
  }

  #makePlayer() {
    const high = this.getAttribute('quality') !== 'low';
    const player = new Player(this.canvas, {
      high,
      pixelRatio: Math.min(devicePixelRatio, high ? 2 : 1),
      fieldOfView: kFieldOfView,
      instant: matchMedia('(prefers-reduced-motion: reduce)').matches,
    }, {
      state: (state) => {
        this.#state = state;
        this.#say(kSays[state]);
        this.dispatchEvent(new CustomEvent('weft-state', {detail: state}));
      },
      stats: (message) => this.dispatchEvent(new CustomEvent('weft-stats', {detail: message})),
    });
    player.setControls(this.hasAttribute('controls'));
    player.setDistance(this.#distance);
    return player;
  }

  #say(text) {
    this.said.hidden = text === null;
    if (text !== null) this.said.textContent = text;
  }
}
