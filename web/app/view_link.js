/**
 * What a scene is seen like, in the page's address: `eye=x,y,z&target=x,y,z` (m) is the camera, `wind=x,y,z,speed` with
 * `gusts=strength,seconds` and `eddies=strength,metres` the wind. The camera is the viewer's own and is taken at once; the wind is the
 * scene's, for all who see it, and is only offered.
 */
const kMembers = ['eye', 'target', 'wind', 'gusts', 'eddies'];
const kFarthest = 1e6;  // m, as the `camera` message has it

/** So many finite numbers with commas between them, or null. */
function numbers(text, count) {
  const values = (text ?? '').split(',').map((part) => (part.trim() === '' ? NaN : Number(part)));
  return values.length === count && values.every(Number.isFinite) ? values : null;
}

/** Short, and exact enough for a tenth of a millimetre. */
const short = (values) => values.map((value) => String(Number(value.toFixed(4)))).join(',');

/**
 * The camera in an address, or null where there is none that makes sense.
 * @param {URL} address
 * @returns {{eye: number[], target: number[]}|null}
 */
export function readCamera({searchParams}) {
  const eye = numbers(searchParams.get('eye'), 3), target = numbers(searchParams.get('target'), 3);
  if (!eye || !target || [...eye, ...target].some((value) => Math.abs(value) > kFarthest)) return null;
  return eye.some((value, axis) => value !== target[axis]) ? {eye, target} : null;
}

/**
 * The wind in an address, as `wind.set` takes it, or null where there is none that makes sense.
 * @param {URL} address
 * @returns {{direction: number[], speed: number, gusts: number, turbulence: number, time_scale?: number, length_scale?: number}|null}
 */
export function readWind({searchParams}) {
  const wind = numbers(searchParams.get('wind'), 4);
  if (!wind || wind.slice(0, 3).every((value) => value === 0) || wind[3] < 0 || wind[3] > 100) return null;
  const gusts = numbers(searchParams.get('gusts'), 2), eddies = numbers(searchParams.get('eddies'), 2);
  return {
    direction: wind.slice(0, 3), speed: wind[3],
    gusts: gusts?.[0] ?? 0, ...(gusts && {time_scale: gusts[1]}),
    turbulence: eddies?.[0] ?? 0, ...(eddies && {length_scale: eddies[1]}),
  };
}

/** The same address without any of this. @param {URL} address */
export function withoutView(address) {
  const next = new URL(address);
  for (const member of kMembers) next.searchParams.delete(member);
  return next;
}

/**
 * The address that shows a scene as it is seen now. A token is not part of it: whoever follows the link has an own one.
 * @param {URL} address the page's own
 * @param {{scene: string, eye: number[], target: number[], wind: object|null, wireframe: boolean}} seen `wind`: null where there is none
 */
export function addressOfView(address, {scene, eye, target, wind, wireframe}) {
  const next = withoutView(address);
  next.hash = '';
  const {searchParams} = next;
  searchParams.set('scene', scene);
  if (wireframe) searchParams.set('wireframe', '1');
  else searchParams.delete('wireframe');
  searchParams.set('eye', short(eye));
  searchParams.set('target', short(target));
  if (wind) {
    searchParams.set('wind', short([...wind.direction, wind.speed]));
    if (wind.gusts) searchParams.set('gusts', short([wind.gusts, wind.time_scale]));
    if (wind.turbulence) searchParams.set('eddies', short([wind.turbulence, wind.length_scale]));
  }
  next.search = next.search.replaceAll('%2C', ',');  // a comma may stand there as it is
  return next;
}

/** Whether two winds are the same but for rounding. */
export function sameWind(a, b) {
  const flat = ({direction, speed, gusts = 0, turbulence = 0, time_scale: seconds, length_scale: metres}) =>
    [...direction, speed, gusts, gusts ? seconds : 0, turbulence, turbulence ? metres : 0];
  const first = flat(a), second = flat(b);
  return first.every((value, i) => Math.abs(value - second[i]) < 1e-3);
}
