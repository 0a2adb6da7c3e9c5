/** `window.weft` before there is a scene. */
export function publishEmptyHook() {
  window.weft = {stats: {connected: false, scene: null, frames: 0, cloths: [], balls: []}};
}

/** `window.weft`: what tests and the curious read. @param {import('./scene_page.js').ScenePage} page */
export function publishHook(page) {
  const {link, show, rig, stage, hand, clothHand, counts, latest, effects, material, panel, obstacles} = page;
  window.weft = {
    get stats() {
      return {
        connected: link.connected,
        scene: show.description?.name ?? null,
        frames: counts.total,
        cloths: show.levels(rig.eye),
        balls: show.balls.ids.map((id) => ({...show.balls.ball(id), friction: panel.ballFriction.frictions.get(id)})),
        distance: rig.distance,
        eye: rig.eye,
        settled: !show.moving && !stage.changed && !rig.flight,
        lastFrame: show.timeline.newest?.stamp ?? null,
        wind: show.wind,
        obstacles: show.obstacles.meshes.map((_, index) => show.obstacles.place(index)),
        hand: clothHand.held,
        effectsOff: page.effectsOff,
        parameters: effects.parameters,
        materials: material.materials,
        frictions: [...obstacles.friction.frictions.values()],
        pins: Object.fromEntries(show.marks.held),
        server: latest.stats,
      };
    },
    /** Newest decoded positions of a cloth, as plain numbers. */
    positions(cloth = 0) {
      const record = show.timeline.newest?.cloths.find((each) => each.cloth === cloth);
      return record ? Array.from(record.positions, (value, i) => record.origin[i % 3] + value) : null;
    },
    setCameraDistance(distance) {
      rig.goTo(distance);
    },
    /** The ball drawn at a point of the page, or null. */
    ballAt: (x, y) => hand.thingAt(x, y)?.ball ?? null,
    /** The obstacle to be dragged at a point of the page, or null. */
    obstacleAt: (x, y) => hand.thingAt(x, y)?.obstacle ?? null,
    /** Where a point of the scene is on the page, CSS pixels. */
    toPage([x, y, z]) {
      const point = stage.camera.position.clone().set(x, y, z).project(stage.camera);
      const {clientWidth, clientHeight} = stage.renderer.domElement;
      return [((point.x + 1) / 2) * clientWidth, ((1 - point.y) / 2) * clientHeight];
    },
  };
}
