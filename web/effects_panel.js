const byId = (id) => document.getElementById(id);
/** What the effects are called here; one that is not known goes by its own name. */
const kLabels = {
  gravity: 'Gravity', damping: 'Damping', paper_wind: 'Wind', aerodynamics: 'Wind and drag',
  strain_damping: 'Inner friction', plate_bending: 'Stiffness to bending', strain_limit: 'Limit to stretch',
};

const label = (effect) => kLabels[effect] ?? (effect[0].toUpperCase() + effect.slice(1)).replaceAll('_', ' ');

/** A switch for each effect of the scene. Shows what the server says. */
export class EffectsPanel {
  /** @param {{setEffect: (effect: string, on: boolean) => void}} actions */
  constructor(actions) {
    this.live = false;
    byId('effects').addEventListener('change', ({target}) => {
      actions.setEffect(target.dataset.effect, target.checked);
    });
  }

  setLive(live) {
    this.live = live;
    for (const box of this.#boxes()) box.disabled = !live;
  }

  /** @param {string[]} effects the scene's */
  begin(effects) {
    const rows = [...new Set(effects)].map((effect) => {
      const row = Object.assign(document.createElement('label'), {className: 'row check'});
      const box = Object.assign(document.createElement('input'), {type: 'checkbox', checked: true, disabled: !this.live});
      box.dataset.effect = effect;
      row.append(box, ` ${label(effect)}`);
      return row;
    });
    byId('effects-list').replaceChildren(...rows);
    byId('effects').hidden = rows.length === 0;
  }

  /** @param {string[]} off those that are taken away now */
  setOff(off) {
    for (const box of this.#boxes()) box.checked = !off.includes(box.dataset.effect);
  }

  #boxes() {
    return byId('effects').querySelectorAll('input');
  }
}
