import {Tuner} from './tuning.js';
import {Tunings, words} from './tunings.js';

const byId = (id) => document.getElementById(id);
/** What a material's numbers are called here, in the order in which they are shown; those of later servers follow by their own names. */
const kLabels = {
  structural: ['Stiffness along u'], structural_weft: ['Stiffness along v'], shear: ['Stiffness to shear'], bending: ['Stiffness to bending'], damping: ['Damping'],
  rigidity: ['Rigidity along u', 'Rigidity along v', 'Rigidity of the twist'],
  limit_warp: ['Limit along u'], limit_weft: ['Limit along v'], limit_shear: ['Limit to shear'], stiffening: ['Stiffening'],
};
const kOrder = Object.keys(kLabels);

const labelOf = (name, i, count) => kLabels[name]?.[i] ?? words(name) + (count > 1 ? ` ${i + 1}` : '');
const rank = ([name]) => (kOrder.includes(name) ? kOrder.indexOf(name) : kOrder.length);

/** What can be set of a cloth's material, one cloth at a time. Shows what the server says. */
export class MaterialPanel {
  /** @param {{tune: (cloth: number, parameters: Object<string, number|number[]>) => void}} actions */
  constructor(actions) {
    this.live = false;
    /** Of each cloth; none from an older server. */
    this.materials = [];
    this.tunable = [];
    this.tunings = null;  // of the chosen cloth
    this.tuner = new Tuner(actions.tune);
    byId('material-cloth').addEventListener('change', () => this.#choose(!this.tunings.body.hidden));
  }

  setLive(live) {
    this.live = live;
    byId('material-cloth').disabled = !live;
    this.tunings?.enable(live);
  }

  /** @param {{cloths: {name: string, material?: object}[], material_tunable?: object}} scene the server's message */
  begin({cloths, material_tunable: tunable = {}}) {
    this.materials = cloths.flatMap(({material}) => material ?? []);
    this.tunable = Object.entries(tunable).sort((a, b) => rank(a) - rank(b));
    this.tunings = null;
    byId('material').hidden = this.materials.length === 0 || this.tunable.length === 0;
    if (byId('material').hidden) return;
    const names = cloths.map(({name}, cloth) => name || `Cloth ${cloth}`);
    byId('material-cloth').replaceChildren(...names.map((name, cloth) => new Option(name, String(cloth))));
    byId('material-cloth').hidden = names.length === 1;
    byId('material-name').textContent = names.length === 1 ? names[0] : 'Cloth';
    this.#choose(false);
  }

  /** @param {number} cloth @param {object} material all that it has now */
  setMaterial(cloth, material) {
    this.materials[cloth] = material;
    if (cloth === this.#chosen) this.tunings?.show(material);
  }

  /** The server did not take what was set of it. */
  takeBack(cloth) {
    if (cloth === this.#chosen) this.tunings?.takeBack();
  }

  get #chosen() {
    return Number(byId('material-cloth').value);
  }

  #choose(unfolded) {
    const cloth = this.#chosen;
    const values = this.materials[cloth];
    this.tunings = new Tunings(
      {id: 'tuning-material', label: 'the material', tunable: this.tunable.filter(([name]) => name in values), values, labelOf},
      (name, value) => this.tuner.set(cloth, name, value));
    this.tunings.unfold(unfolded);
    byId('material-fold').replaceChildren(this.tunings.fold);
    byId('material-numbers').replaceChildren(this.tunings.body);
    this.setLive(this.live);
  }
}
