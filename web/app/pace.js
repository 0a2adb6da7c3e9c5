/** How old the picture is, and what keeps it from coming sooner. */

const kMostFrames = 60;     // a second; the server sends no more
const kEnough = 0.8;        // of what is due
const kRealTime = 0.97;     // seconds of the scene a second; below it runs behind

/** What the server calls the page. */
const kOfServer = {client: 'page'};

/**
 * What limits the pictures: as the server tells, which knows what it leaves out and why; else as it looks from here.
 * @param {{limit?: string, rate: number, dt: number, received: number, looks: number}} of the server's `limit`, simulated seconds a second (0: nothing is stepped), length
 *   of a step (s), frames received a second, and how often a second the page comes to draw
 * @returns {'server'|'page'|'link'|'nothing'|null} null: the scene stands still
 */
export function limitOf({limit, rate, dt, received, looks}) {
  if (rate === 0) return null;
  if (limit) return kOfServer[limit] ?? limit;
  if (rate < kRealTime) return 'server';
  const due = kEnough * Math.min(kMostFrames, rate / dt);
  // A page that is slow to take frames is sent fewer: it is looked at before the link.
  if (looks < due) return 'page';
  return received < due ? 'link' : 'nothing';
}

/** Ages of what was drawn, between two times that they are told. */
export class Ages {
  constructor() {
    this.clear();
  }

  clear() {
    Object.assign(this, {sum: 0, onWay: 0, count: 0});
  }

  /** A picture was drawn. @param {number} age ms since the server sent off what it shows @param {number} onWay the part until it arrived, ms */
  add(age, onWay) {
    if (!Number.isFinite(age + onWay)) return;  // no ping has been answered yet
    const way = Math.max(0, onWay);  // the clocks' difference is known to half a round trip
    this.sum += age - onWay + way;
    this.onWay += way;
    this.count += 1;
  }

  /** The means, and nothing is kept of them; null where nothing was drawn. @returns {{age: number, onWay: number}|null} */
  take() {
    const {sum, onWay, count} = this;
    this.clear();
    return count > 0 ? {age: sum / count, onWay: onWay / count} : null;
  }
}
