const byId = (id) => document.getElementById(id);

/** Buttons for what a viewer takes along: a link to the present view. */
export class KeepPanel {
  /**
   * @param {{address: () => URL, told: (text: string) => void, setWind: (wind: object) => void}} actions
   *   `address`: of the present view; `told`: says something in passing
   */
  constructor(actions) {
    this.actions = actions;
    this.linkedWind = null;
    byId('copy-link').addEventListener('click', () => this.#copy());
    byId('wind-linked-set').addEventListener('click', () => {
      actions.setWind(this.linkedWind);
      this.offerWind(null);
    });
  }

  setLive(live) {
    byId('wind-linked-set').disabled = !live;
  }

  /** Offers the wind of the link that was opened; null: nothing to offer. */
  offerWind(wind) {
    this.linkedWind = wind;
    byId('wind-linked').hidden = wind === null;
    if (wind) byId('wind-linked-text').textContent = `The link has other wind: ${wind.speed.toFixed(1)} m/s.`;
  }

  /** Onto the clipboard; where the browser has none for this page (it is not on https), into a field to copy from. */
  async #copy() {
    const text = this.actions.address().href;
    const field = byId('link-text');
    try {
      await navigator.clipboard.writeText(text);
      field.hidden = true;
      this.actions.told('The link is on the clipboard.');
    } catch {
      field.hidden = false;
      field.value = text;
      field.focus();
      field.select();
    }
  }
}
