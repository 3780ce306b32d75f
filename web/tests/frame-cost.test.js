// The CPU time of a frame. Real time depends on what else the machine does, so these tests measure the CPU time of the
// page's thread, while the test's clock makes the page draw sixty frames a second.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { openPage, withTimeout, useBrowser, findGaitButton, testPage } from './browser.js';

useBrowser();

/** Time from one frame to the next, ms. */
const FRAME_MS = 1000 / 60;
const FRAME_COUNT = 60;
/** Number of measurements. The shortest time counts, because a busy machine can only add time. */
const RUN_COUNT = 3;

/** Measures the CPU time of the page's thread for a frame, and the simulated time that passed. */
async function measureCost(page, readCpuMs) {
  const readSimulatedMs = () => page.evaluate(() => window.lizard.board.link.board.cycle / 16_000);
  let shortestMs = Infinity;
  let passedMs = 0;
  for (let n = 0; n < RUN_COUNT; n++) {
    const [startMs, startCpuMs] = [await readSimulatedMs(), await readCpuMs()];
    await page.clock.runFor(FRAME_COUNT * FRAME_MS);
    shortestMs = Math.min(shortestMs, ((await readCpuMs()) - startCpuMs) / FRAME_COUNT);
    passedMs += (await readSimulatedMs()) - startMs;
  }
  return { shortestMs, passedMs };
}

async function openWithWalkingRobot() {
  // The page's Content Security Policy would block the injected style.
  const page = await openPage({ viewport: { width: 1400, height: 1000 }, bypassCSP: true }, () => {});
  await page.clock.runFor(3000);
  await findGaitButton(page, 'walk').click();
  await page.clock.runFor(500);
  const session = await withTimeout('the page to be measured', page.context().newCDPSession(page));
  await withTimeout('the page to be measured', session.send('Performance.enable'));
  const readCpuMs = async () => {
    const { metrics } = await withTimeout('the CPU time of the page', session.send('Performance.getMetrics'));
    return 1000 * metrics.find(({ name }) => name === 'ThreadTime').value;
  };
  return { page, readCpuMs };
}

testPage('at sixty frames a second the processor is idle most of the time', openWithWalkingRobot, async ({ page, readCpuMs }, t) => {
  const fullCost = await measureCost(page, readCpuMs);
  // The simulation keeps real time: no frame exceeded its budget.
  const realMs = FRAME_COUNT * FRAME_MS * RUN_COUNT;
  assert.ok(fullCost.passedMs > 0.9 * realMs, `simulated ${fullCost.passedMs} ms in ${realMs} ms`);
  // Without canvases nothing is rendered; on a laptop the graphics chip would render.
  await page.addStyleTag({ content: 'canvas { display: none !important }' });
  const computeCost = await measureCost(page, readCpuMs);
  t.diagnostic(`a frame: ${fullCost.shortestMs.toFixed(1)} ms of CPU, ${computeCost.shortestMs.toFixed(1)} ms without rendering`);
  assert.ok(fullCost.shortestMs < FRAME_MS, `${fullCost.shortestMs} ms, rendered by the processor`);
  assert.ok(computeCost.shortestMs < FRAME_MS / 3, `${computeCost.shortestMs} ms without rendering`);
});

testPage('changing the spring force does not block rendering', openWithWalkingRobot, async ({ page, readCpuMs }) => {
  await page.addStyleTag({ content: 'canvas { display: none !important }' });
  await page.getByLabel('Driven by').selectOption('strut');
  await page.getByLabel('Pull in the strut').fill('0.5');
  // Meanwhile, another thread predicts ten gaits, which takes seconds.
  const { shortestMs } = await measureCost(page, readCpuMs);
  assert.ok(shortestMs < FRAME_MS / 2, `${shortestMs} ms without rendering`);
});

test('the floor is drawn while the robot moves, but not while it stands', async () => {
  const page = await openPage({}, () => {
    window.drawCount = 0;
    const { getContext } = HTMLCanvasElement.prototype;
    HTMLCanvasElement.prototype.getContext = function (...args) {
      if (this.id === 'floor') window.drawCount += 1;
      return getContext.apply(this, args);
    };
  });
  /** Counts the drawings of the floor in a second. */
  const countDrawings = async () => {
    const startCount = await page.evaluate(() => window.drawCount);
    await page.clock.runFor(1000);
    return (await page.evaluate(() => window.drawCount)) - startCount;
  };
  await page.clock.runFor(4000);
  assert.equal(await countDrawings(), 0, 'standing');
  await page.locator('#zoom-in').click();
  assert.ok((await countDrawings()) > 0, 'zoomed');
  await page.emulateMedia({ colorScheme: 'dark' });
  assert.ok((await countDrawings()) > 0, 'in dark colours');
  assert.equal(await countDrawings(), 0, 'standing again');
  await page.evaluate(() => void window.lizard.board.ask('walk'));
  assert.ok((await countDrawings()) > 20, 'walking');
});
