// Which cards of the gallery stream: web/gallery/turns.js.
import assert from 'node:assert/strict';
import {test} from 'node:test';
import {chooseLive} from '../../web/gallery/turns.js';

const kLimits = {most: 2, turnMs: 1000};
const card = (name, members = {}) => ({name, wanted: false, sinceMs: null, lastMs: -Infinity, ...members});
const live = (cards, nowMs) => [...chooseLive(cards, nowMs, kLimits)].sort();

test('where there are few, all stream, however long', () => {
  assert.deepEqual(live([card('a', {sinceMs: 0}), card('b', {sinceMs: 0})], 5000), ['a', 'b']);
});

test('those that never streamed come first, in the order of the page', () => {
  assert.deepEqual(live([card('a'), card('b'), card('c')], 0), ['a', 'b']);
  assert.deepEqual(live([card('a', {lastMs: 10}), card('b'), card('c')], 20), ['b', 'c']);
});

test('a turn lasts as long as it does, then whoever has waited longest is next', () => {
  const cards = [card('a', {sinceMs: 0}), card('b', {sinceMs: 500}), card('c', {lastMs: 300}), card('d', {lastMs: 200})];
  assert.deepEqual(live(cards, 900), ['a', 'b']);
  assert.deepEqual(live(cards, 1200), ['b', 'd']);
  assert.deepEqual(live(cards, 1600), ['c', 'd']);
});

test('what the viewer points at comes before all others and keeps its turn', () => {
  const cards = [card('a', {sinceMs: 0}), card('b', {sinceMs: 100}), card('c', {wanted: true})];
  assert.deepEqual(live(cards, 200), ['a', 'c']);
  assert.deepEqual(live([card('a', {wanted: true, sinceMs: 0}), card('b', {sinceMs: 4000}), card('c')], 5000), ['a', 'c']);
});
