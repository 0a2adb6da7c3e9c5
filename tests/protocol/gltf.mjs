// What a .glb holds, as Khronos' validator and three.js read it.
import assert from 'node:assert/strict';
import validator from 'gltf-validator';
import { AnimationMixer, LoopOnce, Vector3 } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

globalThis.self ??= globalThis;  // GLTFLoader's name for it

/** Fails unless the file is without errors and warnings. @param {Uint8Array} bytes */
export async function validate(bytes) {
  const { issues } = await validator.validateBytes(bytes);
  assert.deepEqual([issues.numErrors, issues.numWarnings], [0, 0], JSON.stringify(issues.messages.slice(0, 5)));
}

/** A valid file, read by three.js; it has no pictures, which Node cannot show. @param {Uint8Array} bytes */
export async function load(bytes) {
  await validate(bytes);
  return new GLTFLoader().parseAsync(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), '');
}

/** The meshes that are seen at a time, s: those that are not scaled to nothing. */
export function seenAt(gltf, time) {
  const mixer = new AnimationMixer(gltf.scene);
  for (const clip of gltf.animations) {
    const action = mixer.clipAction(clip).setLoop(LoopOnce);
    action.clampWhenFinished = true;
    action.play();
  }
  mixer.setTime(time);
  gltf.scene.updateMatrixWorld(true);
  const seen = [];
  gltf.scene.traverse((node) => {
    if (node.isMesh && node.scale.x > 0) seen.push(node);
  });
  return seen;
}

/** A mesh as it is morphed now, in the world: x, y, z of each node, m. */
export function positionsOf(mesh) {
  const at = new Vector3();
  return Array.from({ length: mesh.geometry.attributes.position.count }, (_, i) =>
    mesh.getVertexPosition(i, at).applyMatrix4(mesh.matrixWorld).toArray()).flat();
}
