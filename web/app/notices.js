/** What is told until it is taken back, one text a topic. */
export class Notices {
  #texts = new Map();

  /** @param {import('./hud.js').Hud} hud */
  constructor(hud) {
    this.hud = hud;
  }

  /** @param {string} topic @param {string|null} text null takes it back */
  tell(topic, text) {
    if (text === null) this.#texts.delete(topic);
    else this.#texts.set(topic, text);
    this.hud.showNotice(this.#texts.size > 0 ? [...this.#texts.values()].join(' ') : null);
  }

  clear() {
    this.#texts.clear();
    this.hud.showNotice(null);
  }
}
