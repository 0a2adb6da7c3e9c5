import {CameraRig, ViewReporter} from '../input/camera_rig.js';
import {Link} from '../connection/link.js';
import {Stage} from '../view/stage.js';
import {addressOfGallery, addressOfScene, addressOfSplit, readSettings} from './settings.js';
import {equip} from './wishes.js';
import {handlersFor} from './messages.js';
import {listenToKeys} from '../input/keyboard.js';
import {Ages, limitOf} from './pace.js';
import {Notices} from './notices.js';
import {publishHook} from './hook.js';
import {addressOfView, readCamera, readWind, sameWind} from './view_link.js';
import {Show} from './show.js';
import {splitsOf, withoutHeld} from '../split/levels.js';

const byId = (id) => document.getElementById(id);

/** One scene on the whole page, with its controls. It is connected only while it is shown and the page is not hidden. */
export class ScenePage {
  /**
   * @param {import('./settings.js').Settings} settings
   * @param {{token: string|null}} access
   * @param {import('./hud.js').Hud} hud
   * @param {{goTo: (address: string) => void}} router
   */
  constructor(settings, access, hud, router) {
    Object.assign(this, {settings, access, hud, router});
    const instant = matchMedia('(prefers-reduced-motion: reduce)').matches;
    this.stage = new Stage(byId('stage'), settings);
    this.rig = new CameraRig(this.stage, instant);
    this.show = new Show(this.stage, {
      instant, wireframe: settings.wireframe, high: settings.high, arrow: byId('wind-arrow'), loupe: byId('loupe'),
    });
    this.link = new Link();
    this.counts = {frames: 0, bytes: 0, drawn: 0, looks: 0, total: 0, sinceMs: performance.now()};
    this.ages = new Ages();
    this.latest = {stats: null, frame: null};
    this.notices = new Notices(hud);
    this.scenes = [];
    this.effectsOff = [];
    this.wanted = null;      // the scene to be connected to; null while this is not shown, or there is nothing to connect to
    this.sceneShown = null;  // whose camera place was taken: a reconnection keeps the viewer's own
    this.chosenBall = null;
    this.newBall = null;     // chosen as soon as a frame has it: the answer may come before
    this.retryAt = null;
    this.mayControl = true;  // this page's role is more than to look
    this.here = false;
    this.drawing = false;
    equip(this);
    this.panel.setWireframe(settings.wireframe);
    this.view = new ViewReporter((seen) => this.ask(this.link.commands.camera(seen)));
    this.#listen();
    publishHook(this);
  }

  /** Shows a scene. */
  enter(scene) {
    this.here = true;
    byId('scenes').href = addressOfGallery(new URL(location.href));
    if (!this.drawing) requestAnimationFrame((nowMs) => this.#draw(nowMs));
    this.drawing = true;
    if (this.link.connected && scene === this.sceneShown) return;
    if (this.link.connected) return this.join(scene);
    if (scene !== this.sceneShown) this.show.clear();  // left and shown again it keeps its picture
    this.wanted = scene;
    this.#connect();
  }

  focus() {
    byId('stage').focus();
  }

  /** Something else is shown: nothing is received or drawn any more. */
  leave() {
    this.here = false;
    this.wanted = null;
    this.retryAt = null;
    this.endRecordings();
    this.hud.showBanner(null);
    this.link.rest();
  }

  /** Goes to another scene, on the same connection if there is one. */
  async join(scene) {
    if (!this.link.connected) {
      this.wanted = scene;
      return this.#connect();
    }
    if (await this.ask(this.link.commands.joinScene(scene))) this.wanted = this.wanted && scene;
    else this.panel.setScenes(this.scenes, this.sceneShown);
  }

  /** A scene's `scene` message has come: takes its camera, or the link's, and its address. */
  arrive({name, title, camera}) {
    this.view.forget();
    const address = new URL(location.href);
    const asked = readSettings(address, devicePixelRatio).scene;
    if (this.sceneShown !== name) {
      const linked = asked === name ? readCamera(address) : null;
      if (linked) this.rig.place(linked.eye, linked.target);
      else this.rig.place(camera.eye ?? [0, 0, camera.distance], camera.target ?? [0, 0, 0]);
      const wind = asked === name && this.show.hasWind ? readWind(address) : null;
      this.keep.offerWind(wind && !sameWind(wind, this.show.wind) ? wind : null);
    }
    if (asked !== name) history[asked === null ? 'replaceState' : 'pushState'](null, '', addressOfScene(address, name));
    this.sceneShown = name;
    this.#offerSplit();
    document.title = `${title || name} · Weft`;
  }

  /** The reply to a command, or null; what goes wrong is told, but for one code that the sender expects. */
  ask(reply, expected = 'closed') {
    return reply.catch((error) => {
      if (error.code !== 'closed' && error.code !== expected) this.hud.toast(error.message);
      return null;
    });
  }

  nearest() {
    return this.show.levels(this.rig.eye)[0];
  }

  chooseBall(ball) {
    this.chosenBall = ball;
    this.show.balls.select(ball);
    this.stage.changed = true;
  }

  setEffectsOff(off) {
    this.effectsOff = off;
    this.effects.setOff(off);
  }

  /** The address of what is seen now. */
  get address() {
    const {eye, target} = this.rig.view;
    return addressOfView(new URL(location.href), {
      scene: this.sceneShown, eye, target, wind: this.show.hasWind ? this.show.wind : null, wireframe: this.show.wireframe,
    });
  }

  /** The hands hold nothing any more. */
  letGo() {
    this.clothHand.forget();
    this.hand.forget();
  }

  #connect() {
    if (this.wanted !== null && !document.hidden) this.link.open(this.settings.server, this.wanted, this.access.token);
  }

  #listen() {
    const {link, panel, actions} = this;
    const handlers = handlersFor(this);
    link.addEventListener('state', ({detail}) => this.here && this.#follow(detail));
    link.addEventListener('message', ({detail}) => this.here && handlers[detail.op]?.(detail));
    link.addEventListener('frame', ({detail}) => {
      if (!this.here) return;
      this.counts.frames += 1;
      this.counts.total += 1;
      this.counts.bytes += detail.bytes;
      this.latest.frame = detail;
      this.show.push(detail.frame, detail.arrivedMs);
      this.motion.take(detail.frame);
    });
    this.hud.onRetry(() => this.here && link.retry());
    addEventListener('online', () => this.here && link.retry());
    document.addEventListener('visibilitychange', () => {
      if (!document.hidden) this.#connect();
      else if (this.wanted !== null) link.rest();
      if (document.hidden) this.endRecordings();  // nothing is received or drawn any more
    });
    new ResizeObserver(() => this.stage.setInsets(...panel.covers())).observe(byId('controls'));
    for (const id of ['scenes', 'split']) {
      byId(id).addEventListener('click', (event) => {
        if (event.ctrlKey || event.metaKey || event.shiftKey) return;  // to another tab or window
        event.preventDefault();
        this.router.goTo(event.currentTarget.href);
      });
    }
    listenToKeys(this.rig, {
      'h': () => actions.setHandTool(!this.clothHand.tool),
      'w': () => actions.setWireframe(!this.show.wireframe),
      ' ': () => link.connected && actions.setPaused(!panel.paused),
      '.': () => link.connected && panel.paused && actions.step(),
      'r': () => link.connected && actions.reset(),
    }, () => this.here);
  }

  /** What has become of the connection. */
  #follow(detail) {
    const {hud, panel} = this;
    hud.showConnection(detail.state);
    const live = detail.state === 'open';
    panel.setLive(live, this.mayControl);
    this.letGo();
    for (const part of [this.obstacles, this.cost, this.effects, this.material, this.zones, this.keep]) part.setLive(live && this.mayControl);
    this.retryAt = null;
    if (live) {
      hud.showBanner(null);
      this.notices.clear();
      this.view.forget();
      this.ask(this.link.commands.listScenes()).then((list) => list && this.#setScenes(list, this.sceneShown));
    } else if (detail.state === 'lost') {
      this.retryAt = performance.now() + detail.retryMs;
      hud.lostReason = detail.reason;
    } else if (detail.state === 'refused') {
      this.wanted = null;
      hud.showBanner(detail.reason);
      this.#setScenes(detail.scenes, null);
      byId('scene').disabled = false;
    } else if (detail.state === 'locked') {
      const asked = this.wanted;
      this.wanted = null;
      hud.askToken(detail.reason, (given) => {
        this.access.token = given;
        this.wanted = asked;
        this.#connect();
      });
    }
  }

  #setScenes(scenes, current) {
    this.scenes = scenes;
    this.panel.setScenes(scenes, current);
    byId('scenes').hidden = withoutHeld(scenes).length < 2;
    this.#offerSplit();
  }

  #offerSplit() {
    byId('split').hidden = !splitsOf(this.scenes).has(this.sceneShown);
    if (this.sceneShown) byId('split').href = addressOfSplit(new URL(location.href), this.sceneShown);
  }

  #draw(nowMs) {
    if (!this.here) {
      this.drawing = false;
      return;
    }
    requestAnimationFrame((next) => this.#draw(next));
    const {show, rig, hud, stage, counts} = this;
    counts.looks += 1;
    show.update(nowMs, performance.timeOrigin + nowMs);
    rig.update(nowMs);
    const levels = show.levels(rig.eye);
    if (levels.length > 0) {
      rig.setCentre(levels[0].centre);
      hud.showLevels(levels, show.levelRange(levels[0].cloth));
      hud.showClock(show.stamp.time);
      if (this.link.connected) this.view.update(rig.view, nowMs);
    }
    this.#showBalls();
    this.#showWaiting(nowMs);
    this.#showRates(nowMs);
    this.keep.setSaving(levels.length > 0, this.video.possible);
    this.keep.showRecording(this.video.recording ? this.video.seconds : null, this.motion.gathering ? this.motion.seconds : null);
    if (!stage.changed && !this.video.recording) return;  // a video has pictures of what stands still, too
    counts.drawn += 1;
    this.#noteAge();
    stage.draw();
  }

  /** How old what is drawn now is: what passed on the way, and since. */
  #noteAge() {
    const {frame} = this.latest;
    if (!frame || this.show.behindMs === null) return;
    this.ages.add(frame.ageMs + performance.timeOrigin + performance.now() - frame.arrivedMs + this.show.behindMs, frame.ageMs);
  }

  #showBalls() {
    const {balls, obstacles} = this.show;
    const {ids} = balls;
    if (ids.includes(this.newBall)) {
      this.chooseBall(this.newBall);
      this.newBall = null;
    } else if (!ids.includes(this.chosenBall)) {
      this.chooseBall(ids[0] ?? null);
    }
    this.panel.setBalls(ids, this.chosenBall);
    this.panel.setBallPlace(balls.ball(this.chosenBall)?.position);
    this.obstacles.setPlace(obstacles.place(this.obstacles.chosen));
  }

  #showWaiting(nowMs) {
    if (this.retryAt === null) return;
    const seconds = Math.max(0, Math.ceil((this.retryAt - nowMs) / 1000));
    this.hud.showBanner(`${this.hud.lostReason} ${seconds > 0 ? `Next attempt in ${seconds} s.` : 'Connecting …'}`, true);
  }

  #showRates(nowMs) {
    const seconds = (nowMs - this.counts.sinceMs) / 1000;
    if (seconds < 1) return;
    const {frames, looks} = this.counts;
    this.hud.showRates({...this.counts, seconds});
    const {rate = 0, limit, coarser} = this.latest.stats ?? {};
    const dt = this.show.description?.dt ?? 1;
    const limits = limitOf({limit, rate, dt, received: frames / seconds, looks: looks / seconds});
    this.hud.showPace(this.ages.take(), limits, coarser);
    Object.assign(this.counts, {frames: 0, bytes: 0, drawn: 0, looks: 0, sinceMs: nowMs});
  }
}
