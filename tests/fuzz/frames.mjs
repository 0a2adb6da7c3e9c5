// Feeds mutated frames to the JavaScript client's decoder: node frames.mjs SECONDS SEED FINDINGS. It decodes or refuses them with
// its own error; anything else is a finding, whose input is written into the folder FINDINGS. Ends with "executions N".
import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { argv, exit } from 'node:process';

import { decodeFrame, WeftError } from '../../protocol/clients/js/weft.js';
import { frames, fromHex } from '../protocol/vectors.mjs';

const [seconds, seed, findings] = [Number(argv[2]), Number(argv[3]), argv[4]];
const corpus = new URL('corpus/frames/', import.meta.url);
const seeds = [...frames.good.map(({ hex }) => fromHex(hex)), ...readdirSync(corpus).map((name) => new Uint8Array(readFileSync(new URL(name, corpus))))]
  .filter((bytes) => bytes.length > 0);

/** Tommy Ettinger's mulberry32: the same numbers from the same seed everywhere. */
let state = seed | 0;
function random() {
  state = (state + 0x6d2b79f5) | 0;
  let t = Math.imul(state ^ (state >>> 15), 1 | state);
  t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
  return (t ^ (t >>> 14)) >>> 0;
}
const below = (end) => random() % end;
const REMARKABLE = [0, 1, 2, 3, 4, 7, 8, 16, 64, 127, 128, 255];

const MUTATIONS = [
  (bytes, at) => { bytes[at] = random(); },
  (bytes, at) => { bytes[at] ^= 1 << below(8); },
  (bytes, at) => { bytes[at] = REMARKABLE[below(REMARKABLE.length)]; },
  (bytes, at) => { bytes.splice(at, 1 + below(8)); },
  (bytes, at) => { bytes.splice(at, 0, ...Array.from({ length: 1 + below(8) }, random)); },
  (bytes, at) => { bytes.splice(at, 0, ...bytes.slice(at, at + 64)); },
  (bytes) => { bytes.push(...seeds[below(seeds.length)]); },
];
function mutated() {
  const bytes = Array.from(seeds[below(seeds.length)]);
  for (let changes = 1 + below(4); changes > 0 && bytes.length > 0; --changes) {
    // Half of them in the first header, where the decisions are taken.
    const at = below(below(2) ? bytes.length : Math.min(64, bytes.length));
    MUTATIONS[below(MUTATIONS.length)](bytes, at);
  }
  return Uint8Array.from(bytes);
}

/** What of a decoded frame is not as the decoder promises; undefined if nothing. */
function fault({ stamp, cloths, balls, obstacles }) {
  if (!Number.isFinite(stamp.time)) return 'the time is not finite';
  for (const { rows, cols, positions, torn } of cloths) {
    if (positions.length !== 3 * rows * cols) return 'a cloth has not three numbers a node';
    if (!positions.every(Number.isFinite)) return 'a position is not finite';
    const faces = (rows - 1) * (cols - 1);
    if (!torn.every((face, i) => Number.isInteger(face) && face < faces && (i === 0 || face > torn[i - 1]))) return 'torn faces are not the mesh\'s, ascending';
  }
  for (const { position } of [...balls, ...obstacles])
    if (!position.every(Number.isFinite)) return 'a place is not finite';
  return undefined;
}

function check(bytes, local) {
  try {
    return fault(decodeFrame(bytes, { local }));
  } catch (error) {
    return error instanceof WeftError && error.code === 'bad_frame' && error.message ? undefined : String(error?.stack ?? error);
  }
}

let executions = 0;
for (const end = Date.now() + 1000 * seconds; Date.now() < end; ++executions) {
  const bytes = mutated();
  const what = check(bytes, below(2) === 1);
  if (what === undefined) continue;
  const file = `${findings}/javascript-${executions}-of-seed-${seed}`;
  writeFileSync(file, bytes);
  console.log(`${what}\nWritten to ${file}\nexecutions ${executions}`);
  exit(1);
}
console.log(`executions ${executions}`);
