import {BufferAttribute, BufferGeometry, DoubleSide, Group, Mesh, MeshStandardMaterial} from '../three/three.module.js';

/**
 * What is shown now as a binary glTF file: cloths with their fabric, without what is torn, balls and obstacles but for planes, which
 * have no end. Metres, y up; a cloth that is far from the world's origin is placed by its node.
 * @param {import('../app/show.js').Show} show
 * @returns {Promise<Blob>}
 */
export async function makeModel(show) {
  const model = new Group();
  model.name = show.description.name;
  model.userData = {scene: show.description.name, seconds: show.stamp.time};
  const fabrics = new Map();  // each once
  for (const view of show.cloths.values()) {
    if (!view.mesh) continue;
    if (!fabrics.has(view.fabric)) fabrics.set(view.fabric, fabricOf(view.fabric));
    model.add(clothOf(view, fabrics.get(view.fabric)));
  }
  for (const id of show.balls.ids) model.add(solidOf(show.balls.meshes.get(id), `ball ${id}`));
  show.obstacles.meshes.forEach((mesh, index) => {
    if (mesh?.geometry.attributes.position && mesh.userData.home.shape !== 'plane') model.add(solidOf(mesh, `obstacle ${index}`));
  });
  const {GLTFExporter} = await import('../three/GLTFExporter.js');  // of no use before; what is shown then is another moment
  const bytes = await new GLTFExporter().parseAsync(model, {binary: true, trs: true});
  return new Blob([bytes], {type: 'model/gltf-binary'});
}

/** A fabric's front with texture coordinates that count its repeats: not every program scales a texture, or draws two sides. */
function fabricOf({materials: [{map, roughness = 0.92}]}) {
  const plain = map.clone();
  plain.repeat.set(1, 1);
  const material = new MeshStandardMaterial({map: plain, roughness, side: DoubleSide});
  material.name = 'fabric';
  return {material, repeat: map.repeat};
}

function clothOf(view, {material, repeat}) {
  const {attributes, index, drawRange} = view.mesh.geometry;
  const uv = attributes.uv.array.map((value, i) => value * (i % 2 === 0 ? repeat.x : repeat.y));
  const geometry = new BufferGeometry()
    .setAttribute('position', new BufferAttribute(attributes.position.array.slice(), 3))
    .setAttribute('normal', new BufferAttribute(unit(attributes.normal.array), 3))
    .setAttribute('uv', new BufferAttribute(uv, 2))
    .setIndex(new BufferAttribute(index.array.slice(0, Math.min(drawRange.count, index.count)), 1));
  const mesh = new Mesh(geometry, material);
  mesh.name = view.name;
  mesh.position.copy(view.group.position);
  return mesh;
}

/** Normals as the format wants them, also where a cell has no area. */
function unit(normals) {
  const result = normals.slice();
  for (let at = 0; at < result.length; at += 3) {
    const length = Math.hypot(result[at], result[at + 1], result[at + 2]);
    if (length > 0) for (let axis = 0; axis < 3; ++axis) result[at + axis] /= length;
    else result[at + 1] = 1;
  }
  return result;
}

function solidOf(shown, name) {
  const mesh = new Mesh(shown.geometry, new MeshStandardMaterial({color: shown.material.color, roughness: shown.material.roughness}));
  mesh.name = name;
  mesh.position.copy(shown.position);
  mesh.quaternion.copy(shown.quaternion);
  mesh.scale.copy(shown.scale);
  return mesh;
}
