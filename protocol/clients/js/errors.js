/** What goes wrong between a client and its server. */

/** A request refused by the server, or a connection that failed: `code` is one of PROTOCOL.md's, or `closed`, `timeout`, `connect`. */
export class WeftError extends Error {
  /** @param {string} code @param {string} message @param {string} [path] JSON pointer into the request */
  constructor(code, message, path = '') {
    super(message);
    this.name = 'WeftError';
    this.code = code;
    this.path = path;
  }
}

/** @param {string} reason @returns {never} */
export function malformed(reason) {
  throw new WeftError('bad_frame', reason);
}
