/** Wind as people set it: where it blows to, seen from above (0 degrees away along -z, 90 to the right), and how far it points up. */

const kDegree = Math.PI / 180;

/** @returns {number[]} unit vector */
export function directionOf(headingDegrees, tiltDegrees) {
  const level = Math.cos(tiltDegrees * kDegree);
  return [
    Math.sin(headingDegrees * kDegree) * level,
    Math.sin(tiltDegrees * kDegree),
    -Math.cos(headingDegrees * kDegree) * level,
  ];
}

/** @param {number[]} direction not zero @returns {{heading: number, tilt: number}} whole degrees */
export function anglesOf([x, y, z]) {
  const length = Math.hypot(x, y, z);
  const heading = x === 0 && z === 0 ? 0 : Math.atan2(x, -z);
  return {heading: Math.round(heading / kDegree) + 0, tilt: Math.round(Math.asin(y / length) / kDegree) + 0};
}
