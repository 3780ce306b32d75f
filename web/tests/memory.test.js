// A page that stays open for hours leaks no memory, whatever robots and gaits the user tries, and whatever rooms the
// user visits.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { address, openPage, useBrowser, testPage, readGait, waitForGait } from './browser.js';
import { readPageFile, memory, Robot } from './wasm.js';

useBrowser();

const toml = await readPageFile('robot.toml', 'utf8');

/** Measures by how many bytes `count` repetitions of an action enlarge the memory, after a warm-up. */
function measureGrowth(count, action) {
  const robot = new Robot();
  robot.load(toml);
  const warmUpCount = count / 10;
  for (let n = 0; n < warmUpCount; n++) action(robot, n);
  const startBytes = memory.buffer.byteLength;
  for (let n = warmUpCount; n < warmUpCount + count; n++) action(robot, n);
  return memory.buffer.byteLength - startBytes;
}

test('ten thousand robots with different lengths do not enlarge the memory', async () => {
  // The text ends after `stand`, because other gaits would make the test slower without testing more.
  const standingToml = toml.slice(0, toml.indexOf('[gait.walk]'));
  const growthBytes = measureGrowth(10_000, (_, n) => {
    const { text, refusal } = Robot.tryLengths(standingToml, [['links.l0', 20 + n / 5000]], false);
    assert.equal(refusal, null);
    assert.ok(text.includes('[gait.stand]') && text.includes('l0 = 2'));
  });
  assert.equal(growthBytes, 0);
});

test('refused gaits, and the search for alternatives, do not enlarge the memory', async () => {
  let bars;
  const growthBytes = measureGrowth(100, (robot, n) => {
    bars ??= robot.bars(1);
    const { reason, alternatives } = robot.tryGait({ ...bars, amplitude: 30 + n / 20 });
    assert.match(reason, /margin/);
    assert.equal(alternatives[0].parameter, 'amplitude');
  });
  assert.equal(growthBytes, 0);
});

/**
 * Seconds in each room in each of two rounds; the environment variable SECONDS_IN_ROOM overrides the number. In the
 * first round the page fills its buffers for the last pulses, the log and the track.
 */
const SECONDS_IN_ROOM = Number(process.env.SECONDS_IN_ROOM ?? 8);
/** Largest growth without a leak: a kilobyte that leaks in each frame would be 3 MB in a round. */
const MAX_GROWTH_BYTES = 2_000_000;

testPage('while a robot walks, a second visit to every room takes no more memory than the first visit', () => openPage({ reducedMotion: 'no-preference' }), async (page, t) => {
  await waitForGait(page, 'walk');
  const devTools = await page.context().newCDPSession(page);
  await devTools.send('Performance.enable');
  const rooms = await page.evaluate(() => [...document.querySelectorAll('.room')].map(({ id }) => id.replace('room-', '')));
  assert.ok(rooms.length > 5);
  const visitRooms = async () => {
    const measurements = [];
    for (const room of rooms) {
      await page.goto(`${address()}#room=${room}`);
      await page.waitForTimeout(SECONDS_IN_ROOM * 1000);
      await devTools.send('HeapProfiler.collectGarbage');
      const { metrics } = await devTools.send('Performance.getMetrics');
      const getMetric = (metricName) => metrics.find(({ name }) => name === metricName).value;
      measurements.push({ room, heap: getMetric('JSHeapUsedSize'), nodes: getMetric('Nodes'), listeners: getMetric('JSEventListeners') });
    }
    return measurements;
  };
  const firstRound = await visitRooms();
  for (const [n, { room, ...later }] of (await visitRooms()).entries()) {
    const { heap, nodes, listeners } = firstRound.at(-1);
    t.diagnostic(`${room}: ${firstRound[n].heap}, then ${later.heap} bytes; ${firstRound[n].nodes}, then ${later.nodes} nodes`);
    assert.ok(later.heap < heap + MAX_GROWTH_BYTES, `${room}: ${heap}, then ${later.heap} bytes`);
    assert.ok(later.nodes < nodes + 200, `${room}: ${nodes}, then ${later.nodes} nodes`);
    assert.ok(later.listeners < listeners + 20, `${room}: ${listeners}, then ${later.listeners} listeners`);
  }
  assert.equal(await readGait(page), 'walk');
});
