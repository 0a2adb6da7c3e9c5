import {BodyHand} from '../input/body_hand.js';
import {ClothHand} from '../input/cloth_hand.js';
import {CostPanel} from '../panels/cost_panel.js';
import {EffectsPanel} from '../panels/effects_panel.js';
import {KeepPanel} from '../panels/keep_panel.js';
import {MaterialPanel} from '../panels/material_panel.js';
import {ObstaclesPanel} from '../panels/obstacles_panel.js';
import {Panel} from '../panels/panel.js';
import {ZonesPanel} from '../panels/zones_panel.js';
import {download, fileName} from '../saving/download.js';
import {makeModel} from '../saving/model.js';
import {Motion} from '../saving/motion.js';
import {takePicture} from '../saving/picture.js';
import {Video} from '../saving/video.js';

const kBallRadius = 0.2;
const kButtonThrow = 7;  // m/s

/**
 * What the viewer wants: gives the page its panels and hands, each of which sends commands.
 * @param {import('./scene_page.js').ScenePage} page
 */
export function equip(page) {
  const {show, stage, rig} = page;
  const {commands} = page.link;
  const ask = (reply, expected) => page.ask(reply, expected);
  page.actions = {
    joinScene: (scene) => page.join(scene),
    setPaused: (paused) => ask(paused ? commands.pause() : commands.resume()),
    step: () => ask(commands.step()),
    reset: () => ask(commands.reset()),
    goTo: (distance) => rig.goTo(distance),
    setWireframe: (on) => {
      show.setWireframe(on);
      page.panel.setWireframe(on);
    },
    setWind: ({direction, speed, gusts, turbulence, time_scale: timeScale, length_scale: lengthScale}) =>
      ask(commands.setWind(direction, speed, {gusts, turbulence, timeScale, lengthScale})),
    addBall: async () => {
      page.newBall = await ask(commands.addBall(placeForBall(page), kBallRadius)) ?? page.newBall;
    },
    removeBall: (ball) => ask(commands.removeBall(ball)),
    throwBall: (ball) => {
      const velocity = aimedAtCloth(page, show.balls.ball(ball)?.position);
      if (velocity) ask(commands.throwBall(ball, velocity));
    },
    chooseBall: (ball) => page.chooseBall(ball),
    moveBall: (ball, position) => ask(commands.moveBall(ball, position)),
    setBallFriction: async (ball, friction) => {
      if (!(await ask(commands.setFriction(friction, {ball})))) page.panel.ballFriction.takeBack(ball);
    },
    setHandTool: (on) => {
      page.clothHand.setTool(on);
      page.panel.setHandTool(on);
    },
  };
  page.panel = new Panel(page.actions);
  page.cost = new CostPanel({
    askCost: () => ask(commands.askCost()),
    setQuality: ({max_error: maxError, max_ms: maxMs}) => ask(commands.setQuality({maxError, maxMs})),
  });
  page.effects = new EffectsPanel({
    setEffect: async (effect, on) => {
      if (!(await ask(commands.setEffect(effect, on)))) page.effects.setOff(page.effectsOff);
    },
    tune: async (effect, parameters) => {
      if (!(await ask(commands.tuneEffect(effect, parameters)))) page.effects.takeBack(effect);
    },
  });
  page.material = new MaterialPanel({
    tune: async (cloth, parameters) => {
      if (!(await ask(commands.tuneCloth(cloth, parameters)))) page.material.takeBack(cloth);
    },
  });
  page.zones = new ZonesPanel({
    setZone: (zone, velocity) => ask(commands.setWindZone(zone, velocity)),
    showZones: (on) => show.setZonesShown(on),
  });
  const chooseObstacle = (obstacle) => {
    show.obstacles.select(obstacle);
    stage.changed = true;
  };
  page.obstacles = new ObstaclesPanel({
    choose: chooseObstacle,
    move: (obstacle, position) => ask(commands.moveObstacle(obstacle, position)),
    throw: (obstacle) => {
      const velocity = aimedAtCloth(page, show.obstacles.place(obstacle));
      if (velocity) ask(commands.throwObstacle(obstacle, velocity));
    },
    setFriction: async (obstacle, friction) => {
      if (!(await ask(commands.setFriction(friction, {obstacle})))) page.obstacles.friction.takeBack(obstacle);
    },
  });
  page.keep = new KeepPanel({
    address: () => page.address,
    told: (text) => page.hud.toast(text, 'plain'),
    setWind: page.actions.setWind,
    picture: () => save(page, 'png', takePicture(stage)),
    record: () => (page.video.recording ? page.video.stop() : page.video.start()),
    model: () => save(page, 'glb', makeModel(show, [show.timeline.newest])),
    motion: () => (page.motion.gathering ? page.motion.stop() : page.motion.start(show.timeline.newest)),
  });
  page.video = new Video(stage.renderer.domElement, (video, ending) => save(page, ending, video));
  page.motion = new Motion((frames) => save(page, 'glb', makeModel(show, frames)));
  page.endRecordings = () => {
    page.video.stop();
    page.motion.stop();
  };
  // Before the bodies' hand: it takes what Shift and the tool make its own, and leaves the rest.
  page.clothHand = new ClothHand(stage, show, {
    grab: (cloth, u, v, position) => ask(commands.grab(cloth, u, v, {position})),
    // A reset by somebody else may have ended it.
    move: (grab, position) => ask(commands.moveGrab(grab, position), 'not_found'),
    release: (grab) => ask(commands.release(grab), 'not_found'),
    pin: (cloth, u, v) => ask(commands.pin(cloth, u, v)),
    unpin: (cloth, u, v) => ask(commands.unpin(cloth, u, v)),
  });
  page.hand = new BodyHand(stage, show, {
    commands,
    ask,
    taken: ({ball, obstacle}) => {
      if (ball !== undefined) return page.chooseBall(ball);
      page.obstacles.choose(obstacle);
      chooseObstacle(obstacle);
    },
    holding: (holds) => (rig.controls.enabled = !holds),
  });
}

/** Saves a file, when it is made, under the name of the scene and its time now. */
async function save(page, ending, file) {
  const name = fileName(page.sceneShown, page.show.stamp.time, ending);
  try {
    download(await file, name);
  } catch (error) {
    page.hud.toast(error.message);
  }
}

/** Where a new ball hangs: between the camera and the nearest cloth, off its surface. */
function placeForBall(page) {
  const centre = page.nearest()?.centre ?? [0, 0, 0];
  const away = page.rig.eye.map((value, axis) => value - centre[axis]);
  const distance = Math.hypot(...away);
  const reach = Math.min(0.8, 0.6 * distance);
  return centre.map((value, axis) => value + (away[axis] / distance) * reach);
}

/** Velocity of a throw from there to the nearest cloth, if both are known. */
function aimedAtCloth(page, from) {
  const to = page.nearest()?.centre;
  return from && to && aimed(from, to, kButtonThrow);
}

/** Velocity of `speed` from one point to another, raised so that gravity brings it down onto the target. */
function aimed(from, to, speed) {
  const way = to.map((value, axis) => value - from[axis]);
  const distance = Math.hypot(...way) || 1;
  const velocity = way.map((value) => (value / distance) * speed);
  velocity[1] += 0.5 * 9.81 * (distance / speed);
  return velocity;
}
