import {BodyHand} from '../input/body_hand.js';
import {CameraRig, ViewReporter} from '../input/camera_rig.js';
import {ClothHand} from '../input/cloth_hand.js';
import {CostPanel} from '../panels/cost_panel.js';
import {EffectsPanel} from '../panels/effects_panel.js';
import {publishHook} from './hook.js';
import {Hud} from './hud.js';
import {listenToKeys} from '../input/keyboard.js';
import {Link} from '../connection/link.js';
import {MaterialPanel} from '../panels/material_panel.js';
import {ObstaclesPanel} from '../panels/obstacles_panel.js';
import {Panel} from '../panels/panel.js';
import {addressOfScene, readSettings} from './settings.js';
import {Show} from './show.js';
import {Stage} from '../view/stage.js';
import {ZonesPanel} from '../panels/zones_panel.js';

const kBallRadius = 0.2;
const kButtonThrow = 7;  // m/s

const hud = new Hud();
try {
  start(readSettings(new URL(location.href), devicePixelRatio));
} catch (error) {
  hud.showConnection('refused');
  hud.showBanner(`The page cannot start: ${error.message}`);
}

function start(settings) {
  const instant = matchMedia('(prefers-reduced-motion: reduce)').matches;
  const canvas = document.getElementById('stage');
  document.documentElement.classList.toggle('low', !settings.high);
  const stage = new Stage(canvas, settings);
  const rig = new CameraRig(stage, instant);
  const show = new Show(stage, {instant, wireframe: settings.wireframe, high: settings.high});
  const link = new Link();
  const counts = {frames: 0, bytes: 0, drawn: 0, total: 0, sinceMs: performance.now()};
  const latest = {stats: null};
  const notices = new Map();  // what is told until it is taken back, by what it is about
  let sceneShown = null;     // whose camera place was taken: a reconnection keeps the viewer's own
  let chosenBall = null;
  let newBall = null;        // chosen as soon as a frame has it: the answer may come before
  let retryAt = null;
  let {token} = settings;
  let mayControl = true;     // this page's role is more than to look

  // --- What the viewer wants ---

  const {commands} = link;
  /** The reply to a command, or null; what goes wrong is told, but for one code that the sender expects. */
  const ask = (reply, expected = 'closed') =>
    reply.catch((error) => {
      if (error.code !== 'closed' && error.code !== expected) hud.toast(error.message);
      return null;
    });
  const nearest = () => show.levels(rig.eye)[0];
  const choose = (ball) => {
    chosenBall = ball;
    show.balls.select(ball);
    stage.changed = true;
  };
  const actions = {
    joinScene: async (scene) => {
      if (!link.connected) return link.open(settings.server, scene, token);
      if (!(await ask(commands.joinScene(scene)))) panel.setScenes(scenes, sceneShown);
    },
    setPaused: (paused) => ask(paused ? commands.pause() : commands.resume()),
    step: () => ask(commands.step()),
    reset: () => ask(commands.reset()),
    goTo: (distance) => rig.goTo(distance),
    setWireframe: (on) => {
      show.setWireframe(on);
      panel.setWireframe(on);
    },
    setWind: ({direction, speed, gusts, turbulence, time_scale: timeScale, length_scale: lengthScale}) =>
      ask(commands.setWind(direction, speed, {gusts, turbulence, timeScale, lengthScale})),
    addBall: async () => {
      newBall = await ask(commands.addBall(placeForBall(), kBallRadius)) ?? newBall;
    },
    removeBall: (ball) => ask(commands.removeBall(ball)),
    throwBall: (ball) => {
      const velocity = aimedAtCloth(show.balls.ball(ball)?.position);
      if (velocity) ask(commands.throwBall(ball, velocity));
    },
    chooseBall: choose,
    moveBall: (ball, position) => ask(commands.moveBall(ball, position)),
    setBallFriction: async (ball, friction) => {
      if (!(await ask(commands.setFriction(friction, {ball})))) panel.ballFriction.takeBack(ball);
    },
    setHandTool: (on) => {
      clothHand.setTool(on);
      panel.setHandTool(on);
    },
  };
  let scenes = [];
  const panel = new Panel(actions);
  const cost = new CostPanel({
    askCost: () => ask(commands.askCost()),
    setQuality: ({max_error: maxError, max_ms: maxMs}) => ask(commands.setQuality({maxError, maxMs})),
  });
  const effects = new EffectsPanel({
    setEffect: async (effect, on) => {
      if (!(await ask(commands.setEffect(effect, on)))) effects.setOff(effectsOff);
    },
    tune: async (effect, parameters) => {
      if (!(await ask(commands.tuneEffect(effect, parameters)))) effects.takeBack(effect);
    },
  });
  const material = new MaterialPanel({
    tune: async (cloth, parameters) => {
      if (!(await ask(commands.tuneCloth(cloth, parameters)))) material.takeBack(cloth);
    },
  });
  const zones = new ZonesPanel({
    setZone: (zone, velocity) => ask(commands.setWindZone(zone, velocity)),
    showZones: (on) => show.setZonesShown(on),
  });
  const chooseObstacle = (obstacle) => {
    show.obstacles.select(obstacle);
    stage.changed = true;
  };
  const obstacles = new ObstaclesPanel({
    choose: chooseObstacle,
    move: (obstacle, position) => ask(commands.moveObstacle(obstacle, position)),
    throw: (obstacle) => {
      const velocity = aimedAtCloth(show.obstacles.place(obstacle));
      if (velocity) ask(commands.throwObstacle(obstacle, velocity));
    },
    setFriction: async (obstacle, friction) => {
      if (!(await ask(commands.setFriction(friction, {obstacle})))) obstacles.friction.takeBack(obstacle);
    },
  });
  let effectsOff = [];
  const setEffectsOff = (off) => {
    effectsOff = off;
    effects.setOff(off);
  };
  panel.setWireframe(settings.wireframe);
  // Before the bodies' hand: it takes what Shift and the tool make its own, and leaves the rest.
  const clothHand = new ClothHand(stage, show, {
    grab: (cloth, u, v, position) => ask(commands.grab(cloth, u, v, {position})),
    // A reset by somebody else may have ended it.
    move: (grab, position) => ask(commands.moveGrab(grab, position), 'not_found'),
    release: (grab) => ask(commands.release(grab), 'not_found'),
    pin: (cloth, u, v) => ask(commands.pin(cloth, u, v)),
    unpin: (cloth, u, v) => ask(commands.unpin(cloth, u, v)),
  });
  const hand = new BodyHand(stage, show, {
    commands,
    ask,
    taken: ({ball, obstacle}) => {
      if (ball !== undefined) return choose(ball);
      obstacles.choose(obstacle);
      chooseObstacle(obstacle);
    },
    holding: (holds) => (rig.controls.enabled = !holds),
  });
  new ResizeObserver(() => stage.setInsets(...panel.covers())).observe(document.getElementById('controls'));
  listenToKeys(rig, {
    'h': () => actions.setHandTool(!clothHand.tool),
    'w': () => actions.setWireframe(!show.wireframe),
    ' ': () => link.connected && actions.setPaused(!panel.paused),
    '.': () => link.connected && panel.paused && actions.step(),
    'r': () => link.connected && actions.reset(),
  });

  /** Where a new ball hangs: between the camera and the nearest cloth, off its surface. */
  function placeForBall() {
    const centre = nearest()?.centre ?? [0, 0, 0];
    const away = rig.eye.map((value, axis) => value - centre[axis]);
    const distance = Math.hypot(...away);
    const reach = Math.min(0.8, 0.6 * distance);
    return centre.map((value, axis) => value + (away[axis] / distance) * reach);
  }

  /** Velocity of a throw from there to the nearest cloth, if both are known. */
  function aimedAtCloth(from) {
    const to = nearest()?.centre;
    return from && to && aimed(from, to, kButtonThrow);
  }

  // --- What the server says ---

  const view = new ViewReporter((seen) => ask(commands.camera(seen)));

  link.addEventListener('state', ({detail}) => {
    hud.showConnection(detail.state);
    const live = detail.state === 'open';
    panel.setLive(live, mayControl);
    clothHand.forget();
    hand.forget();
    for (const part of [obstacles, cost, effects, material, zones]) part.setLive(live && mayControl);
    retryAt = null;
    if (detail.state === 'open') {
      hud.showBanner(null);
      tellNothing();
      view.forget();
      ask(commands.listScenes()).then((list) => list && panel.setScenes((scenes = list), sceneShown));
    } else if (detail.state === 'lost') {
      retryAt = performance.now() + detail.retryMs;
      hud.lostReason = detail.reason;
    } else if (detail.state === 'refused') {
      hud.showBanner(detail.reason);
      panel.setScenes((scenes = detail.scenes), null);
      document.getElementById('scene').disabled = false;
    } else if (detail.state === 'locked') {
      hud.askToken(detail.reason, (given) => {
        token = given;
        link.open(settings.server, sceneShown ?? settings.scene, token);
      });
    }
  });

  /** Whether a reset gives the scene other numbers than it has. */
  const changes = ({parameters = {}, materials = [], frictions = [], balls = []}) =>
    JSON.stringify([parameters, materials]) !== JSON.stringify([effects.parameters, material.materials]) ||
    obstacles.friction.differs([...frictions.entries()]) || panel.ballFriction.differs(balls.map(({ball, friction}) => [ball, friction]));

  const tell = (topic, text) => {
    if (text === null) notices.delete(topic);
    else notices.set(topic, text);
    hud.showNotice(notices.size > 0 ? [...notices.values()].join(' ') : null);
  };
  const tellNothing = () => {
    notices.clear();
    hud.showNotice(null);
  };

  const handlers = {
    welcome: ({role}) => (mayControl = role !== 'view'),
    scene: (message) => {
      clothHand.forget();
      hand.forget();
      show.begin(message);
      view.forget();
      if (sceneShown !== message.name) {
        rig.place(message.camera.eye ?? [0, 0, message.camera.distance], message.camera.target ?? [0, 0, 0]);
        history.replaceState(null, '', addressOfScene(new URL(location.href), message.name));
      }
      sceneShown = message.name;
      document.title = `${message.title || message.name} · Weft`;
      panel.setScenes(scenes, message.name);
      panel.setTitle(message.title);
      panel.setPaused(message.paused);
      panel.setWind(show.wind, show.hasWind);
      zones.begin(show.wind);
      obstacles.begin(message.obstacles ?? []);
      panel.setBallFrictions(message.balls);
      effects.begin(message);
      material.begin(message);
      setEffectsOff(message.effects_off ?? []);
      tellNothing();
      cost.begin();
    },
    surface: (message) => show.setSurface(message),
    event: (message) => {
      if (message.wind) {
        show.setWind(message.wind);
        panel.setWind(show.wind, show.hasWind);
        if (message.kind === 'reset') zones.begin(show.wind);
        else zones.show(show.wind);
      }
      if (typeof message.paused === 'boolean') panel.setPaused(message.paused);
      if (message.kind === 'cloth.pin' || message.kind === 'cloth.unpin') show.setPins(message.cloth, message.pins);
      if (message.kind === 'effect') {
        setEffectsOff(message.effects_off);
        cost.begin();  // what was measured was another composition
      }
      if (message.kind === 'tune') {
        effects.setParameters(message.effect, message.parameters);
        cost.begin();
      }
      if (message.kind === 'cloth.tune') {
        material.setMaterial(message.cloth, message.material);
        cost.begin();
      }
      if (message.kind === 'friction') cost.begin();
      if (message.kind === 'reset') {
        if (effectsOff.length > 0 || changes(message)) cost.begin();
        setEffectsOff([]);
        for (const [effect, parameters] of Object.entries(message.parameters ?? {})) effects.setParameters(effect, parameters);
        message.materials?.forEach((own, cloth) => material.setMaterial(cloth, own));
        tellNothing();
        clothHand.forget();
        hand.forget();
        message.pins?.forEach((pins, cloth) => show.setPins(cloth, pins));
      }
      if (message.balls) panel.setBallFrictions(message.balls);
      if (message.frictions) obstacles.setFrictions(message.frictions);
    },
    stats: (message) => {
      latest.stats = message;
      hud.showStats(message, nearest()?.cloth ?? 0);
      if (message.cloths.every((cloth) => cloth.state !== 'frozen')) tell('frozen', null);
      cost.setQuality(message.quality);
    },
    curve: (message) => cost.setCurve(message),
    notice: (message) => {
      if (message.code === 'real_time') tell('slow', null);
      else if (['recovered', 'crowded', 'too_costly'].includes(message.code)) hud.toast(message.message, 'plain');
      else tell(message.code, message.message);
    },
    round_trip: (message) => hud.showRoundTrip(message.ms),
  };
  link.addEventListener('message', ({detail}) => handlers[detail.op]?.(detail));
  link.addEventListener('frame', ({detail}) => {
    counts.frames += 1;
    counts.total += 1;
    counts.bytes += detail.bytes;
    show.push(detail.frame, detail.arrivedMs);
  });

  hud.onRetry(() => link.retry());
  addEventListener('online', () => link.retry());
  document.addEventListener('visibilitychange', () => document.hidden || link.retry());

  // --- The picture ---

  function draw(nowMs) {
    requestAnimationFrame(draw);
    show.update(nowMs, performance.timeOrigin + nowMs);
    rig.update(nowMs);
    const levels = show.levels(rig.eye);
    if (levels.length > 0) {
      rig.setCentre(levels[0].centre);
      hud.showLevels(levels, show.levelRange(levels[0].cloth));
      hud.showClock(show.stamp.time);
      if (link.connected) view.update(rig.view, nowMs);
    }
    showBalls();
    showWaiting(nowMs);
    showRates(nowMs);
    if (!stage.changed) return;
    counts.drawn += 1;
    stage.draw();
  }

  function showBalls() {
    const {ids} = show.balls;
    if (ids.includes(newBall)) {
      choose(newBall);
      newBall = null;
    } else if (!ids.includes(chosenBall)) {
      choose(ids[0] ?? null);
    }
    panel.setBalls(ids, chosenBall);
    panel.setBallPlace(show.balls.ball(chosenBall)?.position);
    obstacles.setPlace(show.obstacles.place(obstacles.chosen));
  }

  function showWaiting(nowMs) {
    if (retryAt === null) return;
    const seconds = Math.max(0, Math.ceil((retryAt - nowMs) / 1000));
    hud.showBanner(`${hud.lostReason} ${seconds > 0 ? `Next attempt in ${seconds} s.` : 'Connecting …'}`, true);
  }

  function showRates(nowMs) {
    const seconds = (nowMs - counts.sinceMs) / 1000;
    if (seconds < 1) return;
    hud.showRates({...counts, seconds});
    Object.assign(counts, {frames: 0, bytes: 0, drawn: 0, sinceMs: nowMs});
  }

  requestAnimationFrame(draw);
  link.open(settings.server, settings.scene, token);
  publishHook({link, show, rig, stage, hand, clothHand, counts, latest, effectsOff: () => effectsOff, effects, material, panel, obstacles});
}

/** Velocity of `speed` from one point to another, raised so that gravity brings it down onto the target. */
function aimed(from, to, speed) {
  const way = to.map((value, axis) => value - from[axis]);
  const distance = Math.hypot(...way) || 1;
  const velocity = way.map((value) => (value / distance) * speed);
  velocity[1] += 0.5 * 9.81 * (distance / speed);
  return velocity;
}
