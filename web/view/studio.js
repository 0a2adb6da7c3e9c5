import {BackSide, Color, Mesh, MeshBasicMaterial, PlaneGeometry, PMREMGenerator, Scene, SphereGeometry, Vector3} from '../three/three.module.js';

const kRoom = 10;      // m, to its wall
const kBlur = 0.04;    // rad

/** Where a lamp hangs as seen from the middle, m, how large it is, m, and how bright; the first is the key light's. */
const kLamps = [
  {place: [3.2, 5.2, 4.4], size: [4, 3], light: 9},
  {place: [-6, 3, 2], size: [2.4, 6], light: 3.5},
  {place: [-3, 2, -6.5], size: [7, 2], light: 3},
  {place: [6.5, 0.5, -2], size: [1.6, 5], light: 3},
];

/**
 * What shines and is mirrored all around: a pale room with lamps as a photographer hangs them. Without it satin and leather would
 * have nothing to reflect.
 * @param {import('../three/three.module.js').WebGLRenderer} renderer
 * @returns {import('../three/three.module.js').Texture}
 */
export function studio(renderer) {
  const room = new Scene();
  const wall = new SphereGeometry(kRoom, 32, 16);
  const shades = new Float32Array(wall.attributes.position.count * 3);
  const low = new Color(0.3, 0.28, 0.26), high = new Color(1, 1.02, 1.06), shade = new Color();
  for (let i = 0; i < wall.attributes.position.count; ++i) {
    const up = wall.attributes.position.getY(i) / kRoom;
    shade.lerpColors(low, high, Math.min(1, Math.max(0, 0.5 + 0.8 * up))).toArray(shades, 3 * i);
  }
  wall.setAttribute('color', wall.attributes.position.clone().copyArray(shades));
  room.add(new Mesh(wall, new MeshBasicMaterial({vertexColors: true, side: BackSide, toneMapped: false})));
  for (const {place, size, light} of kLamps) {
    const lamp = new Mesh(new PlaneGeometry(...size), new MeshBasicMaterial({toneMapped: false}));
    lamp.material.color.setScalar(light);
    lamp.position.fromArray(place);
    lamp.lookAt(new Vector3());
    room.add(lamp);
  }
  const generator = new PMREMGenerator(renderer);
  const {texture} = generator.fromScene(room, kBlur);
  generator.dispose();
  room.traverse(({geometry, material}) => {
    geometry?.dispose();
    material?.dispose();
  });
  return texture;
}
