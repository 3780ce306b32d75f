// An hour of dragging leaks nothing: the memory of WebAssembly does not grow with the number of robots tried.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { file, robot } from './wasm.js';

const toml = await file('robot.toml', 'utf8');

/** Measures the growth of the memory over a number of repetitions, bytes, after a warm-up. */
async function memoryGrowth(times, does) {
  const page = await robot();
  page.ask('read', toml);
  const warm = times / 10;
  for (let n = 0; n < warm; n++) does(page, n);
  const before = page.memory.buffer.byteLength;
  for (let n = warm; n < warm + times; n++) does(page, n);
  return page.memory.buffer.byteLength - before;
}

test('ten thousand robots with different lengths use no more memory', async () => {
  // With `stand` alone, because other gaits would only take time.
  const standing = toml.slice(0, toml.indexOf('[gait.walk]'));
  const grew = await memoryGrowth(10_000, (page, n) => {
    const { text, refusal } = page.ask('lengths', [standing, [['links.l0', 20 + n / 5000]], false]);
    assert.equal(refusal, null);
    assert.ok(text.includes('[gait.stand]') && text.includes('l0 = 2'));
  });
  assert.equal(grew, 0);
});

test('refused gaits and those tried for an offer use no more memory', async () => {
  let bars;
  const grew = await memoryGrowth(100, (page, n) => {
    bars ??= page.ask('bars', 1);
    const { refused, instead } = page.ask('trial', { ...bars, amplitude: 30 + n / 20 });
    assert.match(refused, /margin/);
    assert.equal(instead[0].what, 'amplitude');
  });
  assert.equal(grew, 0);
});
