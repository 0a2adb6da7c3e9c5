/** How a server is reached: the WebSocket, tokens, and when to try again (PROTOCOL.md section 1). */

export const SUBPROTOCOL = 'weft.v1';

const BACKOFF_FIRST_MS = 250, BACKOFF_MOST_MS = 10000;

/**
 * Milliseconds to wait before attempt 0, 1, ...: doubled up to 10 s, and jittered down to half, so that viewers do not return in step.
 * @param {number} attempt @param {() => number} [random]
 */
export function backoff(attempt, random = Math.random) {
  return Math.min(BACKOFF_MOST_MS, BACKOFF_FIRST_MS * 2 ** Math.min(attempt, 20)) * (0.5 + 0.5 * random());
}

/** The headers by which a request shows a token, if there is one. @param {string|null} [token] @returns {Record<string, string>} */
export const bearer = (token) => (token ? { Authorization: `Bearer ${token}` } : {});

/**
 * A WebSocket that is on its way to the server.
 * @param {string} url @param {string} [token] @param {any} [Socket] the class; default: the platform's, else package `ws`
 * @returns {Promise<any>}
 */
export async function openSocket(url, token, Socket) {
  const Class = Socket ?? globalThis.WebSocket ?? (await import(/** @type {string} */ ('ws'))).default;
  const socket = new Class(url, token ? [SUBPROTOCOL, `weft.token.${token}`] : SUBPROTOCOL);
  socket.binaryType = 'arraybuffer';
  return socket;
}
