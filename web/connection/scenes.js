import {bearer} from '../protocol/weft.js';

const kListMs = 4000;  // longest wait for the list

export const kNoToken = 'This server asks for a token.';
export const kUnknownToken = 'This server does not know that token.';

/**
 * The scenes, if they can be had (not of a server that lets no page of another origin read them), and whether a token is in want.
 * @param {string} server ws: or wss:, without a slash at its end
 * @param {string|null} token
 * @returns {Promise<{scenes: {name: string, title: string, viewers: number, cloths: number}[]|null, locked: boolean}>}
 */
export async function listScenes(server, token) {
  try {
    const address = `${server.replace(/^ws/, 'http')}/v1/scenes`;
    const answer = await fetch(address, {signal: AbortSignal.timeout(kListMs), headers: bearer(token)});
    return {scenes: answer.ok ? (await answer.json()).scenes : null, locked: answer.status === 400 || answer.status === 401};
  } catch {
    return {scenes: null, locked: false};
  }
}
