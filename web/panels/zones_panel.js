const byId = (id) => document.getElementById(id);
const kSendMs = 60;   // between two wind.zone.set while a slider moves
const kHoldMs = 600;  // what the viewer has set is not overwritten by what the server still says
const kLeastMost = 5;  // m/s, of a slider

/** A slider for the speed of the air in each of the wind's zones, along the way it blew last. */
export class ZonesPanel {
  /** @param {{setZone: (zone: number, velocity: number[]) => void, showZones: (on: boolean) => void}} actions */
  constructor(actions) {
    this.actions = actions;
    this.live = false;
    this.zones = [];
    this.heldUntilMs = 0;
    this.timers = [];
    byId('zones-shown').addEventListener('change', ({target}) => actions.showZones(target.checked));
    byId('zones-list').addEventListener('input', ({target}) => this.#slid(Number(target.dataset.zone)));
  }

  setLive(live) {
    this.live = live;
    for (const input of byId('zones-list').querySelectorAll('input')) input.disabled = !live;
  }

  /** @param {{direction: number[], zones?: {shape: string, velocity: number[]}[]}} wind */
  begin(wind) {
    const zones = wind.zones ?? [];
    byId('zones').hidden = zones.length === 0;
    this.heldUntilMs = 0;
    this.zones = zones.map(({velocity}) => {
      const speed = Math.hypot(...velocity);
      // Still air has no direction of its own: the wind's.
      return {direction: speed > 0 ? velocity.map((value) => value / speed) : wind.direction, most: Math.max(kLeastMost, Math.ceil(2 * speed))};
    });
    byId('zones-list').replaceChildren(...zones.map((zone, index) => this.#row(zone, index)));
    this.show(wind);
  }

  /** What the server says; a slider under the viewer's hand is not pulled away. */
  show(wind) {
    if (performance.now() < this.heldUntilMs) return;
    (wind.zones ?? []).forEach(({velocity}, index) => {
      const speed = Math.hypot(...velocity);
      if (speed > 0) this.zones[index].direction = velocity.map((value) => value / speed);
      const {input} = this.#parts(index);
      input.max = String(Math.max(this.zones[index].most, Math.ceil(speed)));
      input.value = String(speed);
      this.#write(index);
    });
  }

  #row(zone, index) {
    const row = Object.assign(document.createElement('div'), {className: 'slider'});
    const id = `zone-${index}`;
    const label = Object.assign(document.createElement('label'), {htmlFor: id, textContent: `Zone ${index + 1}`, title: zone.shape});
    const input = Object.assign(document.createElement('input'),
      {id, type: 'range', min: '0', max: String(this.zones[index].most), step: '0.1', disabled: !this.live});
    input.dataset.zone = String(index);
    row.append(label, input, document.createElement('output'));
    return row;
  }

  #parts(index) {
    const row = byId('zones-list').children[index];
    return {input: row.querySelector('input'), output: row.querySelector('output')};
  }

  #write(index) {
    const {input, output} = this.#parts(index);
    output.textContent = `${Number(input.value).toFixed(1)} m/s`;
  }

  #slid(index) {
    this.heldUntilMs = performance.now() + kHoldMs;
    this.#write(index);
    this.timers[index] ??= setTimeout(() => {
      this.timers[index] = null;
      const speed = Number(this.#parts(index).input.value);
      this.actions.setZone(index, this.zones[index].direction.map((value) => value * speed));
    }, kSendMs);
  }
}
