const byId = (id) => document.getElementById(id);
const kToastMs = 6000;
/** In place of the substeps, of which there are none. */
const kStandsStill = {asleep: 'none: asleep', frozen: 'none: frozen', unseen: 'none: unseen'};

/** What limits the pictures, for people. */
const kLimits = {
  server: 'the server: behind real time', link: 'the link: frames are left out', page: 'this page: drawing is slow', nothing: 'nothing',
};

/** Sets text only when it differs: screen readers and layout are spared. */
function write(id, text) {
  const element = byId(id);
  if (element.textContent !== text) element.textContent = text;
}

/** "64 × 64" of a grid's nodes. */
export const cellsText = (rows, cols) => `${cols - 1} × ${rows - 1}`;

/** What the page tells: the level badge, numbers, notices, the banner and toasts. */
export class Hud {
  /** Cloths that no viewer sees, by index. */
  #unseen = new Set();

  /**
   * @param {object[]} cloths {cloth, name, level, rows, cols, distance}, the nearest first
   * @param {{minLevel: number, maxLevel: number}} range of levels the nearest cloth can have
   */
  showLevels(cloths, range) {
    const [nearest, ...others] = cloths;
    write('badge-cells', cellsText(nearest.rows, nearest.cols));
    write('badge-level', String(nearest.level));
    write('badge-distance', `${nearest.distance.toFixed(nearest.distance < 10 ? 2 : 1)} m`);
    write('badge-nodes', (nearest.rows * nearest.cols).toLocaleString('en'));
    const bars = byId('badge-levels');
    const count = range.maxLevel - range.minLevel + 1;
    if (bars.children.length !== count) bars.replaceChildren(...Array.from({length: count}, () => document.createElement('i')));
    [...bars.children].forEach((bar, i) => bar.classList.toggle('on', i <= nearest.level - range.minLevel));
    const list = byId('badge-others');
    list.hidden = others.length === 0;
    const lines = others.map((cloth) => `${cloth.name}: ${cellsText(cloth.rows, cloth.cols)}, ${cloth.distance.toFixed(1)} m${this.#unseen.has(cloth.cloth) ? ', unseen' : ''}`);
    if (list.dataset.text !== lines.join('\n')) {
      list.dataset.text = lines.join('\n');
      list.replaceChildren(...lines.map((line) => Object.assign(document.createElement('li'), {textContent: line})));
    }
  }

  /** The `stats` message. `cloth` is the index of the nearest cloth. */
  showStats(stats, cloth) {
    this.#unseen = new Set(stats.cloths.filter((each) => each.unseen).map((each) => each.cloth));
    const mine = stats.cloths.find((each) => each.cloth === cloth) ?? stats.cloths[0];
    write('badge-step', `${stats.step_ms.toFixed(2)} ms per step`);
    write('number-rate', `${stats.rate.toFixed(2)} × real time`);
    write('number-viewers', String(stats.viewers));
    write('number-dropped', String(stats.dropped));
    if (mine) {
      const state = mine.unseen && mine.state === 'asleep' ? 'unseen' : mine.state;
      write('number-substeps', kStandsStill[state] ?? `${mine.substeps} per step`);
      write('number-simulated', `level ${mine.simulated_level}`);
    }
  }

  /** Once a second: what passed since the last time. */
  showRates({frames, bytes, drawn, seconds}) {
    write('number-received', `${(frames / seconds).toFixed(0)} per second`);
    write('number-data', `${((bytes * 8) / 1000 / seconds).toFixed(0)} kbit/s`);
    write('number-drawn', `${(drawn / seconds).toFixed(0)} per second`);
  }

  /** @param {{age: number, onWay: number}|null} ages ms @param {string|null} limit see limitOf @param {number} [coarser] levels that the link costs */
  showPace(ages, limit, coarser = 0) {
    write('number-age', ages ? `${ages.age.toFixed(0)} ms, ${ages.onWay.toFixed(0)} on the way` : '–');
    const cost = coarser > 0 ? ` (coarser by ${coarser} for the link)` : '';
    write('number-limit', limit === null ? 'it stands still' : kLimits[limit] + cost);
  }

  showRoundTrip(ms) {
    write('number-rtt', `${ms.toFixed(1)} ms`);
  }

  showClock(seconds) {
    write('clock', `${seconds.toFixed(2)} s`);
  }

  /** A notice that stays until it is taken back with null. */
  showNotice(text) {
    byId('notice').hidden = text === null;
    if (text !== null) write('notice', text);
  }

  showConnection(state) {
    byId('connection').dataset.state = state;
    write('connection', {open: 'live', connecting: 'connecting', lost: 'not connected', refused: 'not connected', locked: 'not connected', resting: 'resting'}[state]);
  }

  /** @param {string|null} text null takes it away @param {boolean} retry offer to try at once */
  showBanner(text, retry = false) {
    byId('banner').hidden = text === null;
    byId('banner-retry').hidden = !retry;
    byId('banner-token').hidden = true;
    if (text !== null) write('banner-text', text);
  }

  /** Without what has failed there is no page: a browser without WebGL, an address that is none. @param {Error} error */
  showFailure(error) {
    this.showConnection('refused');
    this.showBanner(`The page cannot start: ${error.message}`);
  }

  /** Asks for a token until one is given. @param {string} why @param {(token: string) => void} give */
  askToken(why, give) {
    this.showBanner(why);
    const form = byId('banner-token');
    form.hidden = false;
    form.onsubmit = (event) => {
      event.preventDefault();
      give(byId('token').value.trim());
    };
    byId('token').focus();
  }

  onRetry(action) {
    byId('banner-retry').addEventListener('click', action);
  }

  /** One text once at a time. */
  toast(text, kind = 'error') {
    if ([...byId('toasts').children].some((shown) => shown.textContent === text)) return;
    const toast = Object.assign(document.createElement('div'), {className: kind === 'error' ? 'toast' : 'toast plain', textContent: text});
    byId('toasts').append(toast);
    setTimeout(() => toast.remove(), kToastMs);
  }
}
