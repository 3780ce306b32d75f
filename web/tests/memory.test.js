// A page that stays open for an evening: what was tried and drawn leaves nothing behind.
import assert from 'node:assert/strict';
import { after, afterEach, test } from 'node:test';

import { address, close, complaints, open, page, closePages } from './browser.js';
import { file, memory, Robot } from './wasm.js';

afterEach(closePages);
after(close);

const toml = await file('robot.toml', 'utf8');

/** Measures the growth of the memory over a number of repetitions, bytes, after a warm-up. */
function memoryGrowth(times, action) {
  const page = new Robot();
  page.read(toml);
  const warm = times / 10;
  for (let n = 0; n < warm; n++) action(page, n);
  const before = memory.buffer.byteLength;
  for (let n = warm; n < warm + times; n++) action(page, n);
  return memory.buffer.byteLength - before;
}

test('ten thousand robots with different lengths use no more memory', async () => {
  // With `stand` alone, because other gaits would only take time.
  const standing = toml.slice(0, toml.indexOf('[gait.walk]'));
  const grew = memoryGrowth(10_000, (_, n) => {
    const { text, refusal } = Robot.lengths(standing, [['links.l0', 20 + n / 5000]], false);
    assert.equal(refusal, null);
    assert.ok(text.includes('[gait.stand]') && text.includes('l0 = 2'));
  });
  assert.equal(grew, 0);
});

test('refused gaits and those tried for an offer use no more memory', async () => {
  let bars;
  const grew = memoryGrowth(100, (page, n) => {
    bars ??= page.bars(1);
    const { refused, instead } = page.trial({ ...bars, amplitude: 30 + n / 20 });
    assert.match(refused, /margin/);
    assert.equal(instead[0].what, 'amplitude');
  });
  assert.equal(grew, 0);
});

test('an argument of another form is refused and changes nothing', () => {
  const robot = new Robot();
  assert.equal(robot.predict(1), null, 'without a robot there is no answer');
  const { floor } = robot.read(toml);
  const first = robot.predict(1);
  assert.ok(first.forward > 10);
  for (const wrong of [null, {}, { ...floor, kind: 'soft' }, { ...floor, twist: undefined }]) {
    assert.throws(() => robot.setFloor(wrong), /Error/, JSON.stringify(wrong));
  }
  assert.throws(() => robot.pulses([1, 2, 3]), /Error/);
  assert.match(robot.read('').refused, /./);
  assert.deepEqual(robot.predict(1), first);
  robot.setFloor({ ...floor, ratio: 0.5 });
  assert.notDeepEqual(robot.predict(1), first);
});

/** Time in each room, in each of two rounds, s. In the first the page fills what it keeps: the last pulses, the log, the track. */
const SECONDS_IN_ROOM = Number(process.env.STAY ?? 8);
/** Memory that may come and go without a leak, bytes: a kilobyte leaked at each picture would be 3 MB in a round. */
const ALLOWANCE = 2_000_000;

test('a robot that walks while somebody goes through the rooms twice takes no more memory the second time', async (t) => {
  await open();
  const opened = await page({ reducedMotion: 'no-preference' });
  await opened.waitForFunction(() => window.lizard.gait === 'walk');
  const tools = await opened.context().newCDPSession(opened);
  await tools.send('Performance.enable');
  const rooms = await opened.evaluate(() => [...document.querySelectorAll('.room')].map(({ id }) => id.replace('room-', '')));
  assert.ok(rooms.length > 5);
  const round = async () => {
    const used = [];
    for (const room of rooms) {
      await opened.goto(`${address()}#room=${room}`);
      await opened.waitForTimeout(SECONDS_IN_ROOM * 1000);
      await tools.send('HeapProfiler.collectGarbage');
      const { metrics } = await tools.send('Performance.getMetrics');
      const of = (wanted) => metrics.find(({ name }) => name === wanted).value;
      used.push({ room, heap: of('JSHeapUsedSize'), nodes: of('Nodes'), listeners: of('JSEventListeners') });
    }
    return used;
  };
  const first = await round();
  for (const [n, { room, ...then }] of (await round()).entries()) {
    const { heap, nodes, listeners } = first.at(-1);
    t.diagnostic(`${room}: ${first[n].heap}, then ${then.heap} bytes; ${first[n].nodes}, then ${then.nodes} nodes`);
    assert.ok(then.heap < heap + ALLOWANCE, `${room}: ${heap}, then ${then.heap} bytes`);
    assert.ok(then.nodes < nodes + 200, `${room}: ${nodes}, then ${then.nodes} nodes`);
    assert.ok(then.listeners < listeners + 20, `${room}: ${listeners}, then ${then.listeners} listeners`);
  }
  assert.equal(await opened.evaluate(() => window.lizard.gait), 'walk');
  assert.deepEqual(complaints, []);
});
