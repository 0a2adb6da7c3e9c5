/** A binary glTF 2.0 document with one buffer. */

const FLOAT = 5126, UINT32 = 5125;  // glTF's componentType
const SIZES = { SCALAR: 1, VEC3: 3 };
const JSON_CHUNK = 0x4e4f534a, BIN_CHUNK = 0x004e4942, MAGIC = 0x46546c67;

export class Glb {
  /** @type {(Float32Array|Uint32Array)[]} */ #data = [];
  #bytes = 0;
  /** @type {Record<string, object[]>} */ #lists = { bufferViews: [], accessors: [], meshes: [], nodes: [] };
  /** @type {object[]} */ #channels = [];
  /** @type {object[]} */ #samplers = [];

  /**
   * @param {Float32Array|Uint32Array} data @param {keyof typeof SIZES} type
   * @returns {number} the accessor
   */
  add(data, type) {
    const size = SIZES[type], { bufferViews, accessors } = this.#lists;
    const min = Array(size).fill(Infinity), max = Array(size).fill(-Infinity);
    data.forEach((value, i) => {
      min[i % size] = Math.min(min[i % size], value);
      max[i % size] = Math.max(max[i % size], value);
    });
    bufferViews.push({ buffer: 0, byteOffset: this.#bytes, byteLength: data.byteLength });
    this.#data.push(data);
    this.#bytes += data.byteLength;
    const componentType = data instanceof Uint32Array ? UINT32 : FLOAT;
    return accessors.push({ bufferView: bufferViews.length - 1, componentType, count: data.length / size, type, min, max }) - 1;
  }

  /** @param {string} name @param {object} mesh @returns {number} the node */
  addNode(name, mesh) {
    const { meshes, nodes } = this.#lists;
    return nodes.push({ name, mesh: meshes.push({ name, ...mesh }) - 1 }) - 1;
  }

  /**
   * @param {number} node @param {'weights'|'scale'} path @param {'LINEAR'|'STEP'} interpolation @param {number[]} times s
   * @param {number[]} values @param {keyof typeof SIZES} type
   */
  animate(node, path, interpolation, times, values, type) {
    this.#channels.push({ sampler: this.#samplers.length, target: { node, path } });
    const input = this.add(Float32Array.from(times), 'SCALAR');
    this.#samplers.push({ input, output: this.add(Float32Array.from(values), type), interpolation });
  }

  /** @returns {Uint8Array} */
  bytes() {
    const nodes = this.#lists.nodes.map((_, i) => i);
    const json = JSON.stringify({
      asset: { version: '2.0', generator: 'weft-client' },
      scene: 0,
      scenes: [nodes.length ? { nodes } : {}],
      materials: [{ doubleSided: true, pbrMetallicRoughness: { metallicFactor: 0 } }],
      ...Object.fromEntries(Object.entries(this.#lists).filter(([, list]) => list.length)),
      ...(this.#bytes && { buffers: [{ byteLength: this.#bytes }] }),
      ...(this.#channels.length && { animations: [{ channels: this.#channels, samplers: this.#samplers }] }),
    });
    const text = new TextEncoder().encode(json.padEnd(4 * Math.ceil(json.length / 4)));
    const total = 20 + text.length + (this.#bytes && 8 + this.#bytes);
    const file = new Uint8Array(total), view = new DataView(file.buffer);
    [MAGIC, 2, total, text.length, JSON_CHUNK].forEach((word, i) => view.setUint32(4 * i, word, true));
    file.set(text, 20);
    if (this.#bytes) {
      view.setUint32(20 + text.length, this.#bytes, true);
      view.setUint32(24 + text.length, BIN_CHUNK, true);
      let at = 28 + text.length;
      for (const { buffer, byteOffset, byteLength } of this.#data) {
        file.set(new Uint8Array(buffer, byteOffset, byteLength), at);
        at += byteLength;
      }
    }
    return file;
  }
}
