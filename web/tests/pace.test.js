// The cost of a picture. Real time depends on the machine, so this measures the CPU time of the page's thread, while the test's clock
// makes it draw sixty pictures a second.
import assert from 'node:assert/strict';
import { after, afterEach, before, test } from 'node:test';

import { close, complaints, open, page, closePages, within } from './browser.js';

before(open);
afterEach(closePages);
after(close);

/** Time from one picture to the next, ms. */
const PICTURE = 1000 / 60;
const PICTURES = 60;
/** Number of measurements, of which the least counts, since a busy machine can only add time. */
const RUNS = 3;

/** Measures the CPU time of the page's thread for a picture, ms, and the simulated ms that passed. */
async function measureCost(opened, metrics) {
  const simulated = () => opened.evaluate(() => window.lizard.link.board.cycle / 16_000);
  let least = Infinity;
  let passed = 0;
  for (let n = 0; n < RUNS; n++) {
    const [before, begun] = [await simulated(), await metrics()];
    await opened.clock.runFor(PICTURES * PICTURE);
    least = Math.min(least, ((await metrics()) - begun) / PICTURES);
    passed += (await simulated()) - before;
  }
  return { least, passed };
}

async function openWalking() {
  // The page's own policy would not allow a style to be put into it.
  const opened = await page({ viewport: { width: 1400, height: 1000 }, bypassCSP: true }, () => {});
  await opened.clock.runFor(3000);
  await opened.locator('#gaits button[data-command="walk"]').click();
  await opened.clock.runFor(500);
  const session = await within('the page to be measured', opened.context().newCDPSession(opened));
  await within('the page to be measured', session.send('Performance.enable'));
  const metrics = async () => {
    const { metrics } = await within('the CPU time of the page', session.send('Performance.getMetrics'));
    return 1000 * metrics.find(({ name }) => name === 'ThreadTime').value;
  };
  return { opened, metrics };
}

test('at sixty pictures a second the processor is idle most of the time', async (t) => {
  const { opened, metrics } = await openWalking();
  const all = await measureCost(opened, metrics);
  // The simulation keeps real time: no picture exceeded its budget.
  const second = PICTURES * PICTURE * RUNS;
  assert.ok(all.passed > 0.9 * second, `${all.passed} of ${second} ms simulated`);
  // Without canvases nothing is painted; on a laptop the graphics chip would do that.
  await opened.addStyleTag({ content: 'canvas { display: none !important }' });
  const computed = await measureCost(opened, metrics);
  t.diagnostic(`a picture: ${all.least.toFixed(1)} ms of CPU, ${computed.least.toFixed(1)} ms without painting`);
  assert.ok(all.least < PICTURE, `${all.least} ms, painted by the processor`);
  assert.ok(computed.least < PICTURE / 3, `${computed.least} ms without painting`);
});

test('moving the slider of the springs does not block drawing', async () => {
  const { opened, metrics } = await openWalking();
  await opened.addStyleTag({ content: 'canvas { display: none !important }' });
  await opened.getByLabel('Driven by').selectOption('strut');
  await opened.getByLabel('Pull in the strut').fill('0.5');
  // Meanwhile another thread predicts ten gaits, which takes seconds.
  const { least } = await measureCost(opened, metrics);
  assert.ok(least < PICTURE / 2, `${least} ms without painting`);
});

test('the floor is painted while the robot moves, and not while it stands', async () => {
  const opened = await page({}, () => {
    window.painted = 0;
    const { getContext } = HTMLCanvasElement.prototype;
    HTMLCanvasElement.prototype.getContext = function (...values) {
      if (this.id === 'floor') window.painted += 1;
      return getContext.apply(this, values);
    };
  });
  /** Counts the paintings of a second. */
  const painted = async () => {
    const before = await opened.evaluate(() => window.painted);
    await opened.clock.runFor(1000);
    return (await opened.evaluate(() => window.painted)) - before;
  };
  await opened.clock.runFor(4000);
  assert.equal(await painted(), 0, 'standing');
  await opened.locator('#zoom-in').click();
  assert.ok((await painted()) > 0, 'zoomed');
  await opened.emulateMedia({ colorScheme: 'dark' });
  assert.ok((await painted()) > 0, 'in dark colours');
  assert.equal(await painted(), 0, 'standing again');
  await opened.evaluate(() => void window.lizard.ask('walk'));
  assert.ok((await painted()) > 20, 'walking');
});

test('the browser reported no error or warning', () => assert.deepEqual(complaints, []));
