/** Which cards stream now. */

/**
 * A few cards at a time, the others in turn: who has waited longest is next, and the card that the viewer points at comes first.
 * @param {{name: string, wanted: boolean, sinceMs: number|null, lastMs: number}[]} cards those in sight, in order; `sinceMs`: streams
 *   since then, null if it does not; `lastMs`: when it streamed last, -Infinity for never
 * @param {number} nowMs
 * @param {{most: number, turnMs: number}} limits how many stream at once; how long they do where others wait
 * @returns {Set<string>}
 */
export function chooseLive(cards, nowMs, {most, turnMs}) {
  const rank = ({wanted, sinceMs}) => {
    if (wanted) return 0;
    if (sinceMs !== null && nowMs - sinceMs < turnMs) return 1;
    return sinceMs === null ? 2 : 3;
  };
  // Sorting is stable: of those that rank alike and never streamed, the first on the page comes first.
  const order = cards.map((card) => ({card, rank: rank(card)}))
    .sort((a, b) => a.rank - b.rank || (a.rank === 2 ? compare(a.card.lastMs, b.card.lastMs) : compare(a.card.sinceMs, b.card.sinceMs)));
  return new Set(order.slice(0, most).map(({card}) => card.name));
}

const compare = (a, b) => (a === b ? 0 : a < b ? -1 : 1);
