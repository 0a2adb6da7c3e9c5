// One browser for all tests of a CTest run: `node keeper.mjs start FILE` and `node keeper.mjs stop FILE`. FILE tells the tests where
// it is. It ends with the run, too, when that is interrupted before `stop`.
import {spawn} from 'node:child_process';
import {existsSync, readFileSync, renameSync, rmSync, writeFileSync} from 'node:fs';
import {setTimeout as sleep} from 'node:timers/promises';
import {fileURLToPath} from 'node:url';
import {launchServer} from './browsers.mjs';

const kPollMs = 100;

/** Keeps a browser until it is told to end or the process `run` is gone. It ends with this process, however that ends. */
async function keep(file, run) {
  let told = false;
  process.on('SIGTERM', () => (told = true));
  const server = await launchServer();
  writeFileSync(`${file}.new`, JSON.stringify({address: server.wsEndpoint(), keeper: process.pid}));
  renameSync(`${file}.new`, file);  // never seen half written
  while (!told && runs(run)) await sleep(kPollMs);
  await server.close();
  rmSync(file);
}

/** Whether a process is there and has not ended: one that nobody has waited for is still listed, as Z. */
function runs(pid) {
  try {
    return !readFileSync(`/proc/${pid}/stat`, 'latin1').includes(') Z ');
  } catch {
    return false;
  }
}

async function start(file) {
  rmSync(file, {force: true});
  const keeper = spawn(process.execPath, [process.argv[1], 'keep', file, process.ppid], {detached: true, stdio: 'ignore'});
  while (!existsSync(file) && keeper.exitCode === null) await sleep(kPollMs);
  if (keeper.exitCode !== null) throw new Error(`The browser's keeper ended with ${keeper.exitCode}`);
  keeper.unref();
}

async function stop(file) {
  process.kill(JSON.parse(readFileSync(file)).keeper, 'SIGTERM');
  while (existsSync(file)) await sleep(kPollMs);
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const [, , what, file, run] = process.argv;
  await {start, stop, keep}[what](file, Number(run));
}
