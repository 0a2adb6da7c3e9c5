// The page's arithmetic: plain modules without a browser.
import assert from 'node:assert/strict';
import {test} from 'node:test';
import {chartColumns, choiceFor, digits, neighbourText, percent, spanText} from '../../web/panels/cost_curve.js';
import {creased} from '../../web/view/creased.js';
import {centreOf, gridNormals, materialCoordinates, mix, sideIndices, split, splitTo, tornNormals, tornOn, triangleIndices} from '../../web/view/grid.js';
import {Morph} from '../../web/view/morph.js';
import {addressOfScene, readSettings} from '../../web/app/settings.js';
import {ThrowSpeed} from '../../web/input/throw_speed.js';
import {Ages, limitOf} from '../../web/app/pace.js';
import {Motion} from '../../web/saving/motion.js';
import {Timeline} from '../../web/view/timeline.js';
import {Tuner, kTuneMs, sliderSpan, unitText} from '../../web/panels/tuning.js';
import {anglesOf, directionOf} from '../../web/panels/wind_angles.js';

/** A flat hanging sheet of `cells` x `cells`, 1 m wide, its top left corner at the origin. */
function sheet(cells, z = 0) {
  const rows = cells + 1;
  const positions = new Float32Array(rows * rows * 3);
  for (let r = 0; r < rows; ++r) {
    for (let c = 0; c < rows; ++c) positions.set([c / cells, -r / cells, z], (r * rows + c) * 3);
  }
  return {positions, rows, cols: rows};
}

const frame = (serverMs, extra = {}) => ({stamp: {serverMs, epoch: 1, ...extra}});
const near = (actual, expected, tolerance = 1e-9) =>
  assert.ok(Math.abs(actual - expected) <= tolerance, `${actual} is not ${expected} within ${tolerance}`);

test('a surface is round where its faces meet flatly, and sharp at edges', () => {
  // A roof of two faces that meet at a ridge along z, each steep by `slope`.
  const roof = (slope) => creased([-1, -slope, 0, 0, 0, 0, 1, -slope, 0, 0, 0, 1], [0, 3, 1, 1, 3, 2], {inset: 0.1});
  const flat = roof(0.1), steep = roof(2), ridge = 3 * 2;  // corner 2 of the first face: vertex 1
  near(flat.normals[ridge], 0);
  near(flat.normals[ridge + 1], 1);
  near(steep.normals[ridge], -2 / Math.hypot(1, 2), 1e-6);
  near(steep.normals[ridge + 1], 1 / Math.hypot(1, 2), 1e-6);
  near(steep.positions[ridge + 1], -0.1, 1e-6);  // below the ridge: its faces' mean is upwards
});

test('torn cells are not drawn, nor sides that only they have', () => {
  // 2 x 2 cells, the upper right one torn: its top and right sides belong to no other.
  const torn = new Set([1]);
  assert.deepEqual([...triangleIndices(3, 3, torn)], [0, 3, 1, 1, 3, 4, 3, 6, 4, 4, 6, 7, 4, 7, 5, 5, 7, 8]);
  const sides = sideIndices(3, 3, torn), pairs = [];
  for (let i = 0; i < sides.length; i += 2) pairs.push(`${sides[i]}-${sides[i + 1]}`);
  assert.equal(pairs.length, 12 - 2);
  for (const gone of ['1-2', '2-5']) assert.ok(!pairs.includes(gone), gone);
});

test('torn faces of a coarse record are all those within them on a finer grid', () => {
  const record = {torn: [1, 6], rows: 3, cols: 5};  // 2 x 4 cells
  assert.deepEqual([...tornOn(record, 3)], [1, 6]);
  assert.deepEqual([...tornOn(record, 5)].sort((a, b) => a - b), [2, 3, 10, 11, 20, 21, 28, 29]);
});

test('a torn sheet is lit by the faces that are left', () => {
  const {positions, rows, cols} = sheet(2);
  // The right column of nodes has fallen forward, the cells before it are torn: what is left is flat.
  for (const node of [2, 5, 8]) positions[3 * node + 2] = 5;
  const normals = tornNormals(positions, rows, cols, new Set([1, 3]), new Float32Array(positions.length));
  for (const node of [0, 1, 3, 4, 6, 7]) assert.deepEqual([...normals.slice(3 * node, 3 * node + 3)], [0, 0, 1]);
  assert.deepEqual([...normals.slice(6, 9)], [0, 0, 0]);  // nothing is left around it
});

test('a cell is two triangles, counter-clockwise from the front', () => {
  assert.deepEqual([...triangleIndices(2, 2)], [0, 2, 1, 1, 2, 3]);
  assert.equal(triangleIndices(65, 65).length, 64 * 64 * 6);
});

test('the wireframe has every side of every cell once', () => {
  // 3 rows of 1 side and 2 columns of 2 sides.
  assert.deepEqual([...sideIndices(3, 2)], [0, 1, 0, 2, 1, 3, 2, 3, 2, 4, 3, 5, 4, 5]);
});

test('material coordinates are metres, v upwards', () => {
  assert.deepEqual([...materialCoordinates(2, 2, 1.5, 1)], [0, 1, 1.5, 1, 0, 0, 1.5, 0]);
});

test('a sheet in the x-y plane faces +z', () => {
  const {positions, rows, cols} = sheet(2);
  const normals = gridNormals(positions, rows, cols, new Float32Array(positions.length));
  for (let at = 0; at < normals.length; at += 3) assert.deepEqual([...normals.slice(at, at + 3)], [0, 0, 1]);
});

test('a normal of nodes that coincide is no NaN', () => {
  const normals = gridNormals(new Float32Array(12), 2, 2, new Float32Array(12));
  assert.ok(normals.every((value) => value === 0));
});

test('the normal at the tip of a fold, where both neighbours are sewn together, is that of its faces', () => {
  const tent = Float32Array.of(0, 0, 0, 1, 0, 0, 0, 0, 0, 0, -1, 0.5, 1, -1, 0, 0, -1, -0.5);
  const tip = [...gridNormals(tent, 2, 3, new Float32Array(18)).slice(3, 6)];
  // Across the faces' diagonals: (0.5, 0.5, 2) + (0.5, 0.5, -2).
  tip.forEach((value, axis) => assert.ok(Math.abs(value - [Math.SQRT1_2, Math.SQRT1_2, 0][axis]) < 1e-6, `${tip}`));
});

test('split keeps shared nodes and puts new ones in the middle (Eq. 8)', () => {
  const coarse = {positions: Float32Array.of(0, 0, 0, 2, 0, 0, 0, -2, 0, 2, -2, 4), rows: 2, cols: 2};
  const fine = split(coarse.positions, 2, 2);
  const node = (r, c) => [...fine.positions.slice((r * 3 + c) * 3, (r * 3 + c) * 3 + 3)];
  assert.deepEqual([fine.rows, fine.cols], [3, 3]);
  assert.deepEqual(node(0, 0), [0, 0, 0]);
  assert.deepEqual(node(2, 2), [2, -2, 4]);
  assert.deepEqual(node(0, 1), [1, 0, 0]);
  assert.deepEqual(node(2, 1), [1, -2, 2]);
  assert.deepEqual(node(1, 1), [1, -1, 1]);  // mean of the four corners
});

test('splitting a flat sheet gives the finer flat sheet; not splitting gives the same object', () => {
  const coarse = sheet(16);
  assert.deepEqual(splitTo(coarse, 65).positions, sheet(64).positions);
  assert.equal(splitTo(coarse, 17), coarse);
});

test('mix and centre', () => {
  assert.deepEqual([...mix([0, 10], [4, 20], 0.25, new Float32Array(2))], [1, 12.5]);
  assert.deepEqual(centreOf(sheet(2, 3).positions), [0.5, -0.5, 3]);
});

test('a change of level begins where the cloth was shown and ends where it is sent', () => {
  for (const [from, to] of [[16, 32], [32, 16], [16, 64], [64, 16]]) {
    const morph = new Morph();
    morph.update(sheet(from, 0), sheet(from, 0), 1, 0);
    const start = morph.update(sheet(to, 1), sheet(to, 1), 1, 1000);
    assert.equal(start.rows, Math.max(from, to) + 1);  // on the finer grid
    assert.ok(start.positions.every((value, i) => i % 3 !== 2 || value === 0), 'starts at z = 0');
    assert.ok(morph.active);
    const middle = morph.update(sheet(to, 1), sheet(to, 1), 1, 1125);
    near(middle.positions[2], 0.5);  // half of 250 ms, and the ease is symmetric
    const end = morph.update(sheet(to, 1), sheet(to, 1), 1, 1250);
    assert.equal(end.rows, to + 1);
    assert.equal(end.positions[2], 1);
    assert.ok(!morph.active);
  }
});

test('a change of level moves nothing by more than 1.5 pixels between two pictures', () => {
  // A sheet of 32 cells that stands up to 0.3 m off the one of 16 that it was, 1 mm a pixel.
  const fine = sheet(32);
  for (let i = 0; i < fine.positions.length; i += 3) fine.positions[i + 2] = 0.3 * fine.positions[i];
  const morph = new Morph();
  morph.update(sheet(16), sheet(16), 1, 0, 1e-3);
  let shown = morph.update(fine, fine, 1, 1000, 1e-3), most = 0, pictures = 0;
  while (morph.active) {
    const next = morph.update(fine, fine, 1, 1000 + (++pictures * 1000) / 60, 1e-3);
    for (let i = 2; i < next.positions.length; i += 3) most = Math.max(most, Math.abs(next.positions[i] - shown.positions[i]));
    shown = {positions: next.positions.slice()};
  }
  assert.ok(most <= 1.5e-3 && most > 1.4e-3, `${1e3 * most} pixels`);
  assert.equal(pictures, 300);  // 0.3 m at 1.5 mm a picture, where the ease is steepest by 1.5
});

test('a change of level is instant for who prefers reduced motion', () => {
  const morph = new Morph(true);
  morph.update(sheet(64), sheet(64), 1, 0);
  assert.equal(morph.update(sheet(16, 1), sheet(16, 1), 1, 1).rows, 17);
  assert.ok(!morph.active);
});

test('the timeline shows a frame interval late, between the two frames around that moment', () => {
  const timeline = new Timeline();
  // The server's clock at 0, 20, ..; each message takes 5 ms more on the local clock, which is 1000 ahead.
  for (let i = 0; i <= 10; ++i) timeline.push(frame(5_000 + 20 * i), 1_005 + 20 * i);
  const moment = timeline.sample(1_205 + timeline.delayMs - 10);  // 10 ms before the last frame is due
  assert.equal(moment.before.stamp.serverMs, 5_180);
  assert.equal(moment.after.stamp.serverMs, 5_200);
  near(moment.behindMs, 10, 0.4);  // the newest is at 200 ms, this at 190
  near(moment.share, 0.5, 0.02);  // the drift allowance moves it by 0.02 ms a frame
  assert.ok(timeline.delayMs > 15 && timeline.delayMs < 25);
});

test('what limits the pictures: server, page, link, in this order', () => {
  const well = {rate: 1, dt: 1 / 60, received: 60, looks: 60};
  assert.equal(limitOf(well), 'nothing');
  assert.equal(limitOf({...well, rate: 0.5, received: 30}), 'server');
  assert.equal(limitOf({...well, looks: 20, received: 20}), 'page');  // it takes no more, so no more are sent
  assert.equal(limitOf({...well, received: 20}), 'link');
  assert.equal(limitOf({...well, limit: 'client', received: 20}), 'page');  // the server knows better
  assert.equal(limitOf({...well, limit: 'link', looks: 20, received: 20}), 'link');
  assert.equal(limitOf({...well, dt: 1 / 30, received: 30}), 'nothing');  // there are no more
  assert.equal(limitOf({...well, dt: 1 / 240, received: 60}), 'nothing');  // no more are sent
  assert.equal(limitOf({...well, rate: 0, received: 0}), null);
});

test('ages are the means since they were last told', () => {
  const ages = new Ages();
  assert.equal(ages.take(), null);
  ages.add(NaN, NaN);
  ages.add(30, 10);
  ages.add(50, 20);
  assert.deepEqual(ages.take(), {age: 40, onWay: 15});
  assert.equal(ages.take(), null);
  // A way that the clocks tell as -2 ms is one of none, and the picture was drawn 3 ms after its frame came.
  ages.add(1, -2);
  assert.deepEqual(ages.take(), {age: 3, onWay: 0});
});

test('the timeline never goes beyond the newest frame', () => {
  const timeline = new Timeline();
  timeline.push(frame(0), 0);
  timeline.push(frame(16), 16);
  const moment = timeline.sample(10_000);
  assert.equal(moment.share, 1);
  assert.ok(moment.settled);
});

test('the timeline crosses the wrap of the 32-bit clock', () => {
  const timeline = new Timeline();
  timeline.push(frame(2 ** 32 - 10), 0);
  timeline.push(frame(10), 20);
  const {before, after, share} = timeline.sample(10 + timeline.delayMs);
  assert.equal(before.stamp.serverMs, 2 ** 32 - 10);
  assert.equal(after.stamp.serverMs, 10);
  near(share, 0.5, 0.01);
});

test('two epochs are never mixed', () => {
  const timeline = new Timeline();
  timeline.push(frame(0), 0);
  timeline.push(frame(20, {epoch: 2}), 20);
  const {before, after} = timeline.sample(21);
  assert.equal(before.stamp.epoch, 2);
  assert.equal(after.stamp.epoch, 2);
});

test('the timeline keeps few frames when the page does not draw', () => {
  const timeline = new Timeline();
  for (let i = 0; i < 1000; ++i) timeline.push(frame(20 * i), 20 * i);
  assert.ok(timeline.entries.length <= 6);
});

test('a throw is the speed of the last tenth of a second', () => {
  const speed = new ThrowSpeed();
  speed.add([0, 0, 0], 0);       // rested here
  speed.add([0, 0, 0], 1000);
  for (let i = 1; i <= 10; ++i) speed.add([0.04 * i, 0, 0], 1000 + 20 * i);  // 2 m/s
  const [x, y, z] = speed.velocity(1205, 25);
  near(x, 2);
  assert.deepEqual([y, z], [0, 0]);
});

test('a hand that rests before letting go does not throw, and no throw is faster than allowed', () => {
  const speed = new ThrowSpeed();
  speed.add([0, 0, 0], 0);
  speed.add([3, 4, 0], 50);  // 100 m/s
  assert.deepEqual(speed.velocity(500, 25), [0, 0, 0]);
  const capped = speed.velocity(60, 25);
  near(capped[0], 15, 1e-6);
  near(capped[1], 20, 1e-6);
  assert.deepEqual(new ThrowSpeed().velocity(0, 25), [0, 0, 0]);
});

test('wind by heading and upward angle, and back', () => {
  const cases = [[[0, 0, -1], 0, 0], [[1, 0, 0], 90, 0], [[0, 0, 1], 180, 0], [[-1, 0, 0], -90, 0], [[0, 1, 0], 0, 90]];
  for (const [direction, heading, tilt] of cases) {
    directionOf(heading, tilt).forEach((value, axis) => near(value, direction[axis], 1e-12));
    assert.deepEqual(anglesOf(direction), {heading, tilt});
  }
  const diagonal = anglesOf([3, 0, -3]);  // need not be of unit length
  assert.deepEqual(diagonal, {heading: 45, tilt: 0});
});

test('the address of the service: the page’s own folder, or the parameter', () => {
  const read = (text) => readSettings(new URL(text), 3);
  assert.equal(read('http://a.example:8080/').server, 'ws://a.example:8080');
  assert.equal(read('https://a.example/').server, 'wss://a.example');
  assert.equal(read('https://a.example/cloth/?scene=flag').server, 'wss://a.example/cloth');
  assert.equal(read('https://a.example/cloth/index.html').server, 'wss://a.example/cloth');
  assert.equal(read('http://a/?server=ws://b:9000').server, 'ws://b:9000');
  assert.equal(read('http://a/cloth/?server=ws://b:9000').server, 'ws://b:9000');
  assert.equal(read('http://a/?server=https://b/weft/').server, 'wss://b/weft');
  assert.throws(() => read('http://a/?server=ftp://b'), /not an address like ws/);
});

test('scene and quality of the page’s address', () => {
  const plain = readSettings(new URL('http://a/'), 3);
  assert.deepEqual([plain.scene, plain.high, plain.pixelRatio, plain.wireframe], [null, true, 2, false]);
  const low = readSettings(new URL('http://a/?scene=flag&quality=low&wireframe=1'), 3);
  assert.deepEqual([low.scene, low.high, low.pixelRatio, low.wireframe], ['flag', false, 1, true]);
  const view = (text) => readSettings(new URL(`http://a/${text}`), 1).fieldOfView;
  assert.deepEqual(['', '?fov=75', '?fov=5', '?fov=wide'].map(view), [42, 75, 42, 42]);  // what makes no sense is the usual one
  assert.equal(addressOfScene(new URL('http://a/?server=ws://b:1&scene=x'), 'y').search, '?server=ws%3A%2F%2Fb%3A1&scene=y');
});

// --- The cost panel ---

const point = (ms, error, more = {}) => ({integrator: 'xpbd', setting: `${ms} substeps`, ms, error, best: true, own: false, ...more});
const curve = {
  frames: 30, chaotic: false,
  levels: [
    {level: 4, space: 0.02, floor: 0, points: [point(1, 0.1), point(2, 0.01), point(3, 0.05, {best: false, own: true}), point(4, 0.001)]},
    {level: 5, space: 0.005, floor: 0, points: [point(4, 0.08), point(8, 0.009), point(12, 0.05, {best: false, own: true}), point(16, 0.002)]},
    {level: 6, space: 0, floor: 0, points: [point(16, 0.06), point(32, 0.007), point(48, 0, {best: false, own: true})]},
  ],
};

test('what a level would choose is what the server chooses', () => {
  const [, level] = curve.levels;
  assert.equal(choiceFor(level, {max_error: 0.05}).ms, 8);
  assert.equal(choiceFor(level, {max_error: 1e-6}).ms, 16);  // the nearest
  assert.equal(choiceFor(level, {max_ms: 9}).ms, 8);
  assert.equal(choiceFor(level, {max_ms: 9}, 2).ms, 4);
  assert.equal(choiceFor(level, {max_ms: 1}).ms, 4);
  assert.equal(choiceFor(level, {}).ms, 12);
});

test('what the next levels would cost and gain', () => {
  const quality = {wish: {max_error: 0.05}, state: 'chosen', level: 5, ms_expected: 8, ms_measured: 12, error_expected: 0.009};
  assert.equal(neighbourText(curve, quality, 1), 'Level 6: 4 × the time (48 ms), the finest grid known instead of 0.5 %; steps 0.7 % instead of 0.9 %.');
  assert.equal(neighbourText(curve, quality, -1), 'Level 4: 0.25 × the time (3 ms), grid error 2 % instead of 0.5 %; steps 1 % instead of 0.9 %.');
  assert.equal(neighbourText(curve, {...quality, level: 6}, 1), null);
  assert.equal(neighbourText(curve, {...quality, level: 4}, -1), null);
});

test('the chart has times ascending, each kind in its column, and now', () => {
  const quality = {ms_measured: 10, error_expected: 0.009};
  assert.deepEqual(chartColumns(curve.levels[1], quality), [
    [4, 8, 10, 12, 16], [0.08, 0.009, null, null, 0.002], [null, null, null, 0.05, null], [null, null, 0.009, null, null]]);
  assert.deepEqual(chartColumns(curve.levels[2], {})[0], [16, 32]);  // an error of zero has no place
});

test('an error says over which span it was measured', () => {
  assert.equal(spanText(10), 'over the scene’s first 10 s');
});

test('numbers for people', () => {
  assert.deepEqual([0.00123, 0.1, 1, 0.0000123].map(percent), ['0.12 %', '10 %', '100 %', '0.0012 %']);
  assert.deepEqual([123.4, 0, 0.00001234].map(digits), ['120', '0', '1.2e-5']);
});

test('a slider reaches twice as far as the value, within the range, on round numbers', () => {
  assert.deepEqual(sliderSpan([0, -9.81, 0], [-1e4, 1e4]), {min: -20, max: 20, step: 0.2});
  assert.deepEqual(sliderSpan([1.2], [0, 100]), {min: 0, max: 5, step: 0.05});
  assert.deepEqual(sliderSpan([0], [0, 100]), {min: 0, max: 1, step: 0.01});
  assert.deepEqual(sliderSpan([80], [0, 100]), {min: 0, max: 100, step: 2});
  assert.deepEqual(sliderSpan([0.005], [1e-4, 1]), {min: 0, max: 0.01, step: 0.0001});
  assert.deepEqual(sliderSpan([1000, 500], [0.001, 1e9]), {min: 0, max: 2000, step: 20});
  assert.deepEqual(sliderSpan([100], [-1e5, 1e6]), {min: -200, max: 200, step: 2});
});

test('units are written as people do', () => {
  assert.equal(unitText('m/s2'), 'm/s²');
  assert.equal(unitText('kg/m3'), 'kg/m³');
  assert.equal(unitText('N at 1 m/s'), 'N at 1 m/s');
  assert.equal(unitText(''), '');
});

test('while something is dragged the newest is sent, ten times a second at most, and the last of each in the end', (context) => {
  context.mock.timers.enable({apis: ['setTimeout']});
  const sent = [];
  const tuner = new Tuner((effect, parameters) => sent.push([effect, parameters]));
  for (let i = 0; i < 100; ++i) {  // a second of pointer moves
    tuner.set('aerodynamics', 'drag', i);
    context.mock.timers.tick(10);
  }
  assert.equal(kTuneMs, 100);
  assert.ok(sent.length >= 9 && sent.length <= 11, `${sent.length} messages`);
  assert.deepEqual(sent[0], ['aerodynamics', {drag: 0}]);
  assert.deepEqual(sent.at(-1), ['aerodynamics', {drag: 99}]);
  tuner.set('aerodynamics', 'lift', 1);
  tuner.set('gravity', 'acceleration', [0, 1, 0]);
  tuner.set('aerodynamics', 'drag', 7);
  for (let i = 0; i < 100; ++i) context.mock.timers.tick(10);
  assert.deepEqual(sent.slice(-2), [['aerodynamics', {lift: 1, drag: 7}], ['gravity', {acceleration: [0, 1, 0]}]]);
  const before = sent.length;
  for (let i = 0; i < 100; ++i) context.mock.timers.tick(10);
  assert.equal(sent.length, before);
});

test('a model that moves has thirty frames a second for ten seconds, or ends before: when told, at a reset, when it is large', () => {
  const ended = [];
  const motion = new Motion((frames) => ended.push(frames.map(({stamp}) => stamp.time)));
  const at = (time, {epoch = 1, bytes = 12} = {}) => ({stamp: {time, epoch}, cloths: [{positions: {byteLength: bytes}}]});
  motion.take(at(0));  // nobody asked
  motion.start(at(5));
  for (let step = 1; step <= 660; ++step) motion.take(at(5 + step / 60));
  assert.equal(ended.length, 1);
  assert.equal(ended[0].length, 301);  // 0 to 10 s, every second of 60 steps a second
  near(ended[0].at(-1), 15);
  assert.ok(!motion.gathering);

  motion.start(at(1));
  motion.take(at(1));  // paused: the same step again
  motion.take(at(3));
  near(motion.seconds, 2);
  motion.stop();
  assert.deepEqual(ended[1], [1, 3]);

  motion.start(at(1));
  motion.take(at(2));
  motion.take(at(0, {epoch: 2}));
  assert.deepEqual(ended[2], [1, 2]);

  motion.start(at(0, {bytes: 20e6}));
  for (let step = 1; step <= 9; ++step) motion.take(at(step, {bytes: 20e6}));
  assert.deepEqual(ended[3], [0, 1, 2, 3]);  // the first that are more than 64 MB
});
