/** Whether a reset gives the scene other numbers than it has. */
const changes = ({obstacles, panel, effects, material}, {parameters = {}, materials = [], frictions = [], balls = []}) =>
  JSON.stringify([parameters, materials]) !== JSON.stringify([effects.parameters, material.materials]) ||
  obstacles.friction.differs([...frictions.entries()]) || panel.ballFriction.differs(balls.map(({ball, friction}) => [ball, friction]));

/**
 * What the server says, by `op`.
 * @param {import('./scene_page.js').ScenePage} page
 * @returns {Record<string, (message: object) => void>}
 */
export const handlersFor = (page) => {
  const {show, panel, zones, obstacles, effects, material, cost, hud} = page;
  return {
    welcome: ({role}) => (page.mayControl = role !== 'view'),
    scene: (message) => {
      page.letGo();
      page.motion.stop();  // of the scene before
      show.begin(message);
      page.arrive(message);
      panel.setScenes(page.scenes, message.name);
      panel.setTitle(message.title);
      panel.setPaused(message.paused);
      panel.setWind(show.wind, show.hasWind);
      zones.begin(show.wind);
      obstacles.begin(message.obstacles ?? []);
      panel.setBallFrictions(message.balls);
      effects.begin(message);
      material.begin(message);
      page.setEffectsOff(message.effects_off ?? []);
      page.notices.clear();
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
      if (message.kind === 'effect') page.setEffectsOff(message.effects_off);
      if (message.kind === 'tune') effects.setParameters(message.effect, message.parameters);
      if (message.kind === 'cloth.tune') material.setMaterial(message.cloth, message.material);
      // What was measured was another composition.
      if (['effect', 'tune', 'cloth.tune', 'friction'].includes(message.kind)) cost.begin();
      if (message.kind === 'reset') {
        if (page.effectsOff.length > 0 || changes(page, message)) cost.begin();
        page.setEffectsOff([]);
        for (const [effect, parameters] of Object.entries(message.parameters ?? {})) effects.setParameters(effect, parameters);
        message.materials?.forEach((own, cloth) => material.setMaterial(cloth, own));
        page.notices.clear();
        page.letGo();
        message.pins?.forEach((pins, cloth) => show.setPins(cloth, pins));
      }
      if (message.balls) panel.setBallFrictions(message.balls);
      if (message.frictions) obstacles.setFrictions(message.frictions);
    },
    stats: (message) => {
      page.latest.stats = message;
      hud.showStats(message, page.nearest()?.cloth ?? 0);
      if (message.cloths.every((cloth) => cloth.state !== 'frozen')) page.notices.tell('frozen', null);
      cost.setQuality(message.quality);
    },
    curve: (message) => cost.setCurve(message),
    notice: (message) => {
      if (message.code === 'real_time') page.notices.tell('slow', null);
      else if (['recovered', 'crowded', 'too_costly'].includes(message.code)) hud.toast(message.message, 'plain');
      else page.notices.tell(message.code, message.message);
    },
    round_trip: (message) => hud.showRoundTrip(message.ms),
  };
};
