import {glbBytes} from '../protocol/weft.js';

/**
 * What the scene showed as a binary glTF file: cloths with their fabric, without what is torn, balls and obstacles but for planes, which
 * have no end; of several frames an animation. Metres, y up; a cloth that is far from the world's origin is placed by its node.
 * @param {import('../app/show.js').Show} show
 * @param {import('../protocol/weft.js').Frame[]} frames
 * @returns {Promise<Blob>}
 */
export async function makeModel(show, frames) {
  const {description} = show;
  const views = new Map(show.cloths), surfaces = new Map(show.obstacles.surfaces);  // another scene may be shown by the time it is made
  const pictures = new Map();  // each once
  for (const {fabric} of views.values()) if (!pictures.has(fabric)) pictures.set(fabric, await pngOf(fabric.materials[0].map.image));
  return new Blob([glbBytes(frames, {
    scene: {...description, cloths: description.cloths.map(({cloth}) => ({cloth, name: views.get(cloth).name}))},
    surfaces,
    fabricOf: (cloth) => {
      const {fabric, size} = views.get(cloth);
      const [{map, roughness}] = fabric.materials;  // the front: no program draws two
      return {png: pictures.get(fabric), repeat: [size[0] * map.repeat.x, size[1] * map.repeat.y], roughness};
    },
  })], {type: 'model/gltf-binary'});
}

/** @param {HTMLCanvasElement} canvas */
const pngOf = async (canvas) => {
  const blob = await new Promise((resolve) => canvas.toBlob(resolve, 'image/png'));
  if (!blob) throw new Error('The fabric could not be drawn.');
  return new Uint8Array(await blob.arrayBuffer());
};
