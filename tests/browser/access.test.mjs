// The page and a server that asks who one is.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {mkdtemp, rm, writeFile} from 'node:fs/promises';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {openPage, startServer, until} from './harness.mjs';

const kTokens = {view: 'a-token-of-a-viewer', control: 'a-token-of-a-hand.1'};

let folder, guarded;
before(async () => {
  folder = await mkdtemp(join(tmpdir(), 'weft-access-'));
  const file = join(folder, 'tokens.json');
  await writeFile(file, JSON.stringify({tokens: Object.entries(kTokens).map(([role, token]) => ({role, token}))}));
  guarded = await startServer(['flag', '--tokens', file]);
});
after(() => rm(folder, {recursive: true}));

const banner = (page) => page.locator('#banner-text');
const seesCloth = (page) => until(page, () => weft.stats.connected && weft.stats.cloths.length > 0);

test('asks for a token until it has one that the server knows', async () => {
  const {page} = await openPage(`${guarded.address}/?quality=low`);
  await page.locator('#token').waitFor();
  assert.equal(await banner(page).textContent(), 'This server asks for a token.');
  await page.locator('#token').fill('not-a-token-of-this-server');
  await page.locator('#banner-token button').click();
  await until(page, () => document.getElementById('banner-text').textContent === 'This server does not know that token.');
  await page.locator('#token').fill(kTokens.control);
  await page.locator('#token').press('Enter');
  await seesCloth(page);
  assert.equal(await page.locator('#banner').isVisible(), false);
  assert.equal(await page.locator('#pause').isEnabled(), true);
  await page.close();
});

test('takes it from what its address has behind #, which is sent nowhere', async () => {
  const {page, witness} = await openPage(`${guarded.address}/?quality=low&scene=flag#token=${kTokens.control}`);
  await seesCloth(page);
  assert.deepEqual(witness.requests.filter((url) => url.includes(kTokens.control)), []);
  assert.deepEqual(witness.errors, []);
  await page.close();
});

test('who may only look has no controls but the camera and the choice of scene', async () => {
  const {page, witness} = await openPage(`${guarded.address}/?quality=low#token=${kTokens.view}`);
  await seesCloth(page);
  for (const id of ['pause', 'reset', 'step', 'ball-add']) assert.equal(await page.locator(`#${id}`).isEnabled(), false, id);
  assert.equal(await page.locator('#scene').isEnabled(), true);
  assert.equal(await page.locator('#wind input').first().isEnabled(), false);
  const server = () => weft.stats.server?.cloths[0].distance;
  await until(page, server);
  const before = await page.evaluate(server);
  await page.locator('#stage').focus();
  for (let i = 0; i < 5; ++i) await page.keyboard.press('-');
  await until(page, (distance) => weft.stats.server.cloths[0].distance > distance + 0.1, before);
  assert.deepEqual(witness.errors, []);
  await page.close();
});

test('a token that is typed once goes for the gallery, its pictures and the scenes that it opens', async () => {
  const several = await startServer(['flag', 'curtain', '--tokens', join(folder, 'tokens.json')]);
  const {page} = await openPage(`${several.address}/?quality=low`);
  await page.locator('#token').fill(kTokens.view);
  await page.locator('#token').press('Enter');
  await page.waitForSelector('.card[data-scene=curtain][data-frames]');
  assert.equal(await page.locator('#banner').isVisible(), false);
  assert.equal((await page.locator('.card').first().getAttribute('href')).includes(kTokens.view), false);
  await page.click('.card[data-scene=curtain]');
  await until(page, () => weft.stats.connected && weft.stats.scene === 'curtain' && weft.stats.cloths.length > 0);
  assert.equal(await page.locator('#banner').isVisible(), false);
  await page.close();
});

test('works over TLS', async () => {
  const certificate = join(folder, 'certificate.pem'), key = join(folder, 'key.pem');
  execFileSync('openssl', ['req', '-x509', '-newkey', 'ec', '-pkeyopt', 'ec_paramgen_curve:prime256v1', '-nodes', '-days', '2', '-subj', '/CN=localhost',
    '-addext', 'subjectAltName=IP:127.0.0.1', '-keyout', key, '-out', certificate], {stdio: 'ignore'});
  const secure = await startServer(['flag', '--tls-certificate', certificate, '--tls-key', key]);
  assert.match(secure.address, /^https:/);
  const {page, witness} = await openPage(`${secure.address}/?quality=low`, {ignoreHTTPSErrors: true});
  await seesCloth(page);
  assert.deepEqual(witness.errors, []);
  await page.close();
});
