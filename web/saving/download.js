const kKeptMs = 60_000;  // until the browser has surely read it

/** Hands a file to the viewer, as a download. @param {Blob} blob @param {string} name */
export function download(blob, name) {
  const address = URL.createObjectURL(blob);
  const link = Object.assign(document.createElement('a'), {href: address, download: name});
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), kKeptMs);
}

/**
 * "weft-flag-12.50s.png": a file's name.
 * @param {string} scene @param {number} seconds of the scene's clock @param {string} ending
 */
export const fileName = (scene, seconds, ending) => `weft-${scene}-${seconds.toFixed(2)}s.${ending}`;
