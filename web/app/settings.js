import {withoutView} from './view_link.js';

/** What the page's address may say. */

const kFieldOfView = 42;  // degrees

/**
 * @typedef {object} Settings
 * @property {string} server address of the service, "ws://host:port" or "ws://host/path", without a slash at its end
 * @property {string|null} scene name of the scene; null: the gallery, or the only one there is
 * @property {string|null} split name of a scene that is shown at several levels side by side
 * @property {string|null} token shown to the service; null: none
 * @property {boolean} high quality: antialiasing, shadows, bumps, filtered textures
 * @property {number} pixelRatio device pixels a CSS pixel
 * @property {boolean} wireframe
 * @property {number} fieldOfView height of the view in a window that is not narrow, degrees
 */

/**
 * Reads the page's address: `?server=ws://host:port`, `?scene=NAME`, `?split=NAME`, `?wireframe=1`, `?fov=75` (degrees, 20 to 100) for a wider
 * or longer lens, `?quality=low` for machines that draw without a graphics card, and the view (view_link.js). `#token=T` is the token for a service that asks
 * for one: what stands behind `#` stays in the browser.
 * @param {URL} address the page's own
 * @param {number} devicePixelRatio
 * @returns {Settings}
 */
export function readSettings(address, devicePixelRatio) {
  const parameters = address.searchParams;
  const high = parameters.get('quality') !== 'low';
  return {
    server: serverAddress(parameters.get('server'), address),
    scene: parameters.get('scene') || null,
    split: parameters.get('split') || null,
    token: new URLSearchParams(address.hash.slice(1)).get('token') || null,
    high,
    // Beyond 2 nobody sees the difference, but four times the pixels are drawn.
    pixelRatio: Math.min(devicePixelRatio, high ? 2 : 1),
    wireframe: parameters.get('wireframe') === '1',
    fieldOfView: fieldOfView(parameters.get('fov')),
  };
}

/** The given one where it makes sense, else the usual one. */
function fieldOfView(given) {
  const degrees = Number(given);
  return degrees >= 20 && degrees <= 100 ? degrees : kFieldOfView;
}

/** The service's address as ws: or wss:, without a trailing slash; the folder of `address` when none is given. */
export function serverAddress(given, address) {
  const url = new URL(given || '.', address);
  if (url.protocol === 'http:') url.protocol = 'ws:';
  if (url.protocol === 'https:') url.protocol = 'wss:';
  if (url.protocol !== 'ws:' && url.protocol !== 'wss:') {
    throw new Error(`server=${given} is not an address like ws://host:8080`);
  }
  return `${url.protocol}//${url.host}${url.pathname.replace(/\/+$/, '')}`;
}

/** The address under which this page shows `scene`: what a reload gives. */
export function addressOfScene(address, scene) {
  const next = withoutView(address);
  next.searchParams.delete('split');
  next.searchParams.set('scene', scene);
  return next;
}

/** The address under which this page shows `scene` at several levels. */
export function addressOfSplit(address, scene) {
  const next = withoutView(address);
  next.searchParams.delete('scene');
  next.searchParams.set('split', scene);
  return next;
}

/** The address of the gallery on the same terms. */
export function addressOfGallery(address) {
  const next = withoutView(address);
  next.searchParams.delete('scene');
  next.searchParams.delete('split');
  return next;
}
