/** A binary glTF 2.0 document with one buffer. */

const FLOAT = 5126, UINT32 = 5125;  // glTF's componentType
const SIZES = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 };
const JSON_CHUNK = 0x4e4f534a, BIN_CHUNK = 0x004e4942, MAGIC = 0x46546c67;

export class Glb {
  /** @type {Uint8Array[]} */ #data = [];
  #bytes = 0;
  /** @type {Record<string, object[]>} */ #lists = {
    bufferViews: [], accessors: [], images: [], textures: [], materials: [], meshes: [], nodes: [] };
  /** @type {object[]} */ #channels = [];
  /** @type {object[]} */ #samplers = [];

  /**
   * @param {Float32Array|Uint32Array} data @param {keyof typeof SIZES} type
   * @returns {number} the accessor
   */
  add(data, type) {
    const size = SIZES[type];
    const min = Array(size).fill(Infinity), max = Array(size).fill(-Infinity);
    data.forEach((value, i) => {
      min[i % size] = Math.min(min[i % size], value);
      max[i % size] = Math.max(max[i % size], value);
    });
    const bufferView = this.#append(new Uint8Array(data.buffer, data.byteOffset, data.byteLength));
    const componentType = data instanceof Uint32Array ? UINT32 : FLOAT;
    return this.#push('accessors', { bufferView, componentType, count: data.length / size, type, min, max });
  }

  /** @param {Uint8Array} png @returns {number} the texture */
  addTexture(png) {
    const source = this.#push('images', { bufferView: this.#append(png), mimeType: 'image/png' });
    return this.#push('textures', { source });
  }

  /** @param {object} material @returns {number} its index */
  addMaterial(material) {
    return this.#push('materials', material);
  }

  /** @param {object} mesh @returns {number} its index */
  addMesh(mesh) {
    return this.#push('meshes', mesh);
  }

  /** @param {{name: string, mesh: number, translation?: number[], rotation?: number[], scale?: number[]}} node @returns {number} its index */
  addNode(node) {
    return this.#push('nodes', node);
  }

  /**
   * @param {number} node @param {'weights'|'scale'|'translation'|'rotation'} path @param {'LINEAR'|'STEP'} interpolation
   * @param {number[]} times s @param {number[]} values @param {keyof typeof SIZES} type
   */
  animate(node, path, interpolation, times, values, type) {
    this.#channels.push({ sampler: this.#samplers.length, target: { node, path } });
    const input = this.add(Float32Array.from(times), 'SCALAR');
    this.#samplers.push({ input, output: this.add(Float32Array.from(values), type), interpolation });
  }

  /** @returns {Uint8Array} */
  bytes() {
    const nodes = this.#lists.nodes.map((_, i) => i);
    const json = new TextEncoder().encode(JSON.stringify({
      asset: { version: '2.0', generator: 'weft-client' },
      scene: 0,
      scenes: [nodes.length ? { nodes } : {}],
      ...Object.fromEntries(Object.entries(this.#lists).filter(([, list]) => list.length)),
      ...(this.#bytes && { buffers: [{ byteLength: this.#bytes }] }),
      ...(this.#channels.length && { animations: [{ channels: this.#channels, samplers: this.#samplers }] }),
    }));
    const text = 4 * Math.ceil(json.length / 4), total = 20 + text + (this.#bytes && 8 + this.#bytes);
    const file = new Uint8Array(total).fill(0x20, 0, 20 + text), view = new DataView(file.buffer);  // JSON is filled up with spaces
    [MAGIC, 2, total, text, JSON_CHUNK].forEach((word, i) => view.setUint32(4 * i, word, true));
    file.set(json, 20);
    if (this.#bytes) {
      view.setUint32(20 + text, this.#bytes, true);
      view.setUint32(24 + text, BIN_CHUNK, true);
      let at = 28 + text;
      for (const part of this.#data) {
        file.set(part, at);
        at += padded(part.length);
      }
    }
    return file;
  }

  /** @param {string} list @param {object} entry */
  #push(list, entry) {
    return this.#lists[list].push(entry) - 1;
  }

  /** @param {Uint8Array} part @returns {number} its view */
  #append(part) {
    const bufferView = this.#push('bufferViews', { buffer: 0, byteOffset: this.#bytes, byteLength: part.length });
    this.#data.push(part);
    this.#bytes += padded(part.length);
    return bufferView;
  }
}

/** Numbers begin at multiples of their size. @param {number} bytes */
const padded = (bytes) => 4 * Math.ceil(bytes / 4);
