/** The shared vectors, for the Node tests. */
import { readFileSync } from 'node:fs';

export const loadJson = (file) => JSON.parse(readFileSync(new URL(`../../protocol/${file}`, import.meta.url), 'utf8'));
export const frames = loadJson('vectors/frames.json');
export const messages = loadJson('vectors/messages.json');
export const serverMessages = loadJson('vectors/server_messages.json');
export const fromHex = (hex) => Uint8Array.from(Buffer.from(hex, 'hex'));
