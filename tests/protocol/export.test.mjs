// Files that both clients make of frames: .glb by Khronos' validator and three.js, which shows the frames again; .obj line by line.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import validator from 'gltf-validator';
import { AnimationMixer, LoopOnce, Vector3 } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

import { glbBytes, objText } from '../../protocol/clients/js/weft.js';

globalThis.self ??= globalThis;  // GLTFLoader's name for it

let folder;
before(() => { folder = mkdtempSync(join(tmpdir(), 'weft-export-')); });
after(() => rmSync(folder, { recursive: true }));

/** A grid of nodes 1 m apart, from (0, lift, 0). */
function cloth(index, rows, cols, lift, torn = []) {
  const nodes = Array.from({ length: rows * cols }, (_, i) => [i % cols, lift, Math.floor(i / cols)]);
  return { cloth: index, rows, cols, origin: [0, 0, 0], positions: Float32Array.from(nodes.flat()), torn };
}
const frame = (time, ...cloths) => ({ stamp: { time, epoch: 0 }, cloths, balls: [], obstacles: [] });

// Cloth 0 becomes coarser, then tears; cloth 3 comes late.
const FRAMES = [
  frame(2, cloth(0, 3, 3, 0)),
  frame(2.25, cloth(0, 3, 3, 0.5)),
  frame(2.5, cloth(0, 2, 3, 1), cloth(3, 2, 2, 5)),
  frame(3, cloth(0, 2, 3, 2, [1]), cloth(3, 2, 2, 6)),
];

function byPython(frames) {
  const told = frames.map(({ stamp, cloths }) => ({ ...stamp, cloths: cloths.map((each) => ({ ...each, positions: [...each.positions] })) }));
  const { status, stderr } = spawnSync('/usr/bin/python3', [fileURLToPath(new URL('export_frames.py', import.meta.url)), folder],
    { input: JSON.stringify(told), encoding: 'utf8' });
  if (status !== 0) throw new RangeError(stderr);
  return { glb: new Uint8Array(readFileSync(join(folder, 'frames.glb'))), obj: readFileSync(join(folder, 'frame.obj'), 'utf8') };
}
const byJavaScript = (frames) => ({ glb: glbBytes(frames), obj: objText(frames.at(-1)) });

/** What is seen at a time since the first frame: by name of cloth, the nodes that its faces have. */
function seenAt(gltf, time) {
  const mixer = new AnimationMixer(gltf.scene);
  for (const clip of gltf.animations) {
    const action = mixer.clipAction(clip).setLoop(LoopOnce);
    action.clampWhenFinished = true;
    action.play();
  }
  mixer.setTime(time);
  gltf.scene.updateMatrixWorld(true);
  const seen = {};
  gltf.scene.traverse((node) => {
    if (!node.isMesh || node.scale.x === 0) return;
    const { count } = node.geometry.attributes.position;
    seen[node.name.replace(/-frame.*/, '')] = {
      positions: Array.from({ length: count }, (_, i) => node.getVertexPosition(i, new Vector3()).toArray()).flat(),
      triangles: node.geometry.index.count / 3,
    };
  });
  return seen;
}

for (const [language, write] of [['JavaScript', byJavaScript], ['Python', byPython]]) {
  test(`${language}: a .glb is valid, and shows each frame at its time`, async () => {
    const { glb } = write(FRAMES);
    const { issues } = await validator.validateBytes(glb);
    assert.deepEqual([issues.numErrors, issues.numWarnings], [0, 0], JSON.stringify(issues.messages.slice(0, 5)));
    const gltf = await new GLTFLoader().parseAsync(glb.buffer.slice(glb.byteOffset, glb.byteOffset + glb.length), '');
    for (const { stamp, cloths } of FRAMES) {
      const expected = Object.fromEntries(cloths.map(({ cloth: index, rows, cols, positions, torn }) => [`cloth-${index}`,
        { positions: [...positions], triangles: 2 * ((rows - 1) * (cols - 1) - torn.length) }]));
      assert.deepEqual(seenAt(gltf, stamp.time - FRAMES[0].stamp.time), expected, `at ${stamp.time} s`);
    }
    // Half way between two frames of one mesh: (0 + 0.5) / 2 m.
    assert.equal(seenAt(gltf, 0.125)['cloth-0'].positions[1], 0.25);
  });

  test(`${language}: an .obj has each cloth's nodes and the faces that are not torn`, () => {
    assert.deepEqual(write(FRAMES).obj.split('\n'), [
      'o cloth-0', 'v 0 2 0', 'v 1 2 0', 'v 2 2 0', 'v 0 2 1', 'v 1 2 1', 'v 2 2 1', 'f 1 4 5 2',
      'o cloth-3', 'v 0 6 0', 'v 1 6 0', 'v 0 6 1', 'v 1 6 1', 'f 7 9 10 8', '']);
  });

  test(`${language}: a single frame, and one without a face, are valid`, async () => {
    for (const only of [frame(0, cloth(0, 2, 2, 1)), frame(0, cloth(0, 2, 2, 1, [0]))]) {
      const { issues } = await validator.validateBytes(write([only]).glb);
      assert.deepEqual([issues.numErrors, issues.numWarnings], [0, 0], JSON.stringify(issues.messages.slice(0, 5)));
    }
  });

  test(`${language}: frames that make no animation are refused`, () => {
    assert.throws(() => write([]), /frames is empty; allowed: 1 or more/);
    assert.throws(() => write([FRAMES[1], FRAMES[0]]), /frames\[1\] is at 2 s; allowed: after 2.25 s/);
    assert.throws(() => write([FRAMES[0], { ...FRAMES[1], stamp: { time: 9, epoch: 1 } }]), /epoch/);
  });
}

test('positions from an origin near the cloth are written in the world', () => {
  assert.match(objText(frame(0, { ...cloth(0, 2, 2, 1), origin: [16, -32, 0] })), /^o cloth-0\nv 16 -31 0\n/);
});
