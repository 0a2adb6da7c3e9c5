/** Whether the key belongs to the control that has the focus: typing, sliders and open lists keep their keys. */
function belongsToControl(target, key) {
  if (target.matches?.('input[type="number"], select, textarea')) return true;
  if (target.matches?.('input[type="range"]')) return key.startsWith('Arrow');
  return key === ' ' && target.matches?.('button, summary, input[type="checkbox"]');
}

/**
 * Keys of the page.
 * @param {import('./camera_rig.js').CameraRig} rig
 * @param {Record<string, () => void>} shortcuts by key, lower case
 * @param {() => boolean} active whether the keys mean anything now
 */
export function listenToKeys(rig, shortcuts, active) {
  addEventListener('keydown', (event) => {
    if (!active() || event.ctrlKey || event.metaKey || event.altKey || belongsToControl(event.target, event.key)) return;
    const shortcut = shortcuts[event.key.toLowerCase()];
    if (shortcut && event.repeat) return;
    if (shortcut) shortcut();
    else if (!rig.handleKey(event.key)) return;
    event.preventDefault();
  });
}
