const byId = (id) => document.getElementById(id);

/** "1:05" */
const clockText = (seconds) => `${Math.floor(seconds / 60)}:${String(Math.floor(seconds % 60)).padStart(2, '0')}`;

/** Buttons for what a viewer takes along: a link to the present view, a picture, a video, a model of what is shown, still or in motion. */
export class KeepPanel {
  /**
   * @param {{address: () => URL, told: (text: string) => void, setWind: (wind: object) => void, picture: () => void, record: () => void,
   *   model: () => void, motion: () => void}} actions `address`: of the present view; `told`: says something in passing; `record` and
   *   `motion`: begin or end one
   */
  constructor(actions) {
    this.actions = actions;
    this.linkedWind = null;
    byId('copy-link').addEventListener('click', () => this.#copy());
    byId('save-picture').addEventListener('click', () => actions.picture());
    byId('record').addEventListener('click', () => actions.record());
    byId('save-model').addEventListener('click', () => actions.model());
    byId('save-motion').addEventListener('click', () => actions.motion());
    byId('wind-linked-set').addEventListener('click', () => {
      actions.setWind(this.linkedWind);
      this.offerWind(null);
    });
  }

  setLive(live) {
    byId('wind-linked-set').disabled = !live;
  }

  /** What can be saved: nothing before the first frame, no video where the browser has none. */
  setSaving(shown, video) {
    for (const [id, on] of [['copy-link', shown], ['save-picture', shown], ['save-model', shown], ['save-motion', shown], ['record', shown && video]]) {
      if (byId(id).disabled === on) byId(id).disabled = !on;
    }
  }

  /** @param {number|null} video seconds recorded so far @param {number|null} motion the same of a model; null: nothing is recorded */
  showRecording(video, motion) {
    for (const [id, seconds, name] of [['record', video, 'Video'], ['save-motion', motion, 'Motion']]) {
      const text = seconds === null ? name : `Stop ${clockText(seconds)}`;
      if (byId(id).textContent !== text) byId(id).textContent = text;
    }
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
