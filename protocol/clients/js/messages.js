/** Control messages (PROTOCOL.md sections 2 and 3). */
import { WeftError } from './errors.js';

/**
 * A client message as JSON text: op, id, then the members that are not undefined.
 * @param {string} op @param {object} [members] @param {number} [id]
 */
export function messageText(op, members = {}, id = undefined) {
  return JSON.stringify({ op, id, ...members }, (name, value) => {
    // JSON would turn these into null, and the server's answer would puzzle.
    if (typeof value === 'number' && !Number.isFinite(value)) throw new WeftError('range', `${name} is ${value}; allowed: finite numbers`);
    return value;
  });
}
