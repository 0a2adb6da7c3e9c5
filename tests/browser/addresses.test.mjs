// What the page's address says, and the addresses that the page makes: web/app/settings.js and web/app/view_link.js.
import assert from 'node:assert/strict';
import {test} from 'node:test';
import {addressOfGallery, addressOfScene, readSettings} from '../../web/app/settings.js';
import {addressOfView, readCamera, readWind, sameWind} from '../../web/app/view_link.js';

const kPage = 'http://host:8080/cloth/';
const at = (query) => new URL(`${kPage}?${query}`);

test('a view that is written is read again', () => {
  const seen = {
    scene: 'flag', eye: [1.23456789, -2, 3e-6], target: [0, 0.5, -1], wireframe: false,
    wind: {direction: [1, 0, -0.25], speed: 7, gusts: 0.3, time_scale: 1.5, turbulence: 0.2, length_scale: 0.5},
  };
  const address = addressOfView(new URL(`${kPage}?quality=low&scene=old&wireframe=1#token=a-token-of-a-viewer`), seen);
  assert.equal(address.href,
    `${kPage}?quality=low&scene=flag&eye=1.2346,-2,0&target=0,0.5,-1&wind=1,0,-0.25,7&gusts=0.3,1.5&eddies=0.2,0.5`);
  assert.deepEqual(readCamera(address), {eye: [1.2346, -2, 0], target: [0, 0.5, -1]});
  assert.deepEqual(readWind(address), seen.wind);
  assert.ok(sameWind(readWind(address), seen.wind));
  assert.equal(readSettings(address, 1).scene, 'flag');
});

test('a scene without wind, gusts or eddies has none in its link', () => {
  const seen = {scene: 'flag', eye: [0, 0, 5], target: [0, 0, 0], wireframe: true, wind: null};
  assert.equal(addressOfView(at('wind=1,0,0,1&gusts=1,1'), seen).search, '?scene=flag&wireframe=1&eye=0,0,5&target=0,0,0');
  assert.equal(addressOfView(at(''), {...seen, wind: {direction: [1, 0, 0], speed: 2}}).searchParams.get('gusts'), null);
});

test('a camera or a wind that makes no sense is none', () => {
  for (const view of ['eye=1,2&target=0,0,0', 'eye=1,2,3&target=1,2,3', 'eye=1,2,x&target=0,0,0', 'eye=1,,3&target=0,0,0', 'eye=1,2,3',
    'eye=1e9,0,0&target=0,0,0', 'eye=NaN,0,0&target=0,0,0', '']) assert.equal(readCamera(at(view)), null, view);
  for (const wind of ['wind=0,0,0,1', 'wind=1,0,0', 'wind=1,0,0,-1', 'wind=1,0,0,101', 'wind=1,0,0,Infinity', ''])
    assert.equal(readWind(at(wind)), null, wind);
});

test('winds differ by what there is: how long gusts would last means nothing without gusts', () => {
  const wind = {direction: [1, 0, 0], speed: 2};
  assert.ok(sameWind(wind, {...wind, gusts: 0, time_scale: 9, turbulence: 0}));
  assert.ok(!sameWind(wind, {...wind, speed: 2.1}));
  assert.ok(!sameWind({...wind, gusts: 0.2, time_scale: 1}, {...wind, gusts: 0.2, time_scale: 2}));
});

test('the addresses of scenes and of the gallery have no view of another scene', () => {
  const address = at('quality=low&scene=flag&eye=0,0,5&target=0,0,0&wind=1,0,0,1');
  assert.equal(addressOfScene(address, 'fan').search, '?quality=low&scene=fan');
  assert.equal(addressOfGallery(address).search, '?quality=low');
});
