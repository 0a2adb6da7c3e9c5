const kMostThreads = 256;  // from stripe to stripe: PROTOCOL.md allows no more

const gcd = (a, b) => (b === 0 ? a : gcd(b, a % b));

/** How many threads a picture has side by side, and the width of cloth it covers, m: stripes begin anew where it does. */
export function repeatOf({thread, stripe}, {threads, period}) {
  if (!stripe) return {threads, metres: threads * thread};
  const spacing = Math.min(kMostThreads, Math.max(2, Math.round(stripe.spacing / thread)));
  const least = period / gcd(spacing, period);  // so often, so that the weave goes on where the picture ends
  const times = least * Math.max(1, Math.floor(threads / spacing / least));
  return {threads: times * spacing, metres: times * stripe.spacing};
}

/** Whether a thread of so many belongs to a stripe. */
export function inStripe(thread, threads, metres, {width, spacing, bands}) {
  const place = (((thread + 0.5) * metres) / threads) % spacing;
  return place < width && Math.floor((place / width) * (2 * bands - 1)) % 2 === 0;
}
