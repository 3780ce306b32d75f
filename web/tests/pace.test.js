// What a picture costs. Time on the wall says more of the machine than of the page, so this counts
// CPU time of the page's own thread, while a clock of the test's has it draw sixty pictures a second.
import assert from 'node:assert/strict';
import { after, afterEach, before, test } from 'node:test';

import { close, complaints, open, page, tidy, within } from './browser.js';

before(open);
afterEach(tidy);
after(close);

/** ms from one picture to the next. */
const PICTURE = 1000 / 60;
const PICTURES = 60;
/** A busy machine only ever adds to it: the least of so many counts. */
const RUNS = 3;

/** CPU time of the page's thread for a picture, ms, and simulated ms that went by. */
async function cost(opened, metrics) {
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

async function walking() {
  // A style is put into the page, which its policy would not have.
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

test('sixty pictures a second leave time to spare', async (t) => {
  const { opened, metrics } = await walking();
  const all = await cost(opened, metrics);
  // Real time is kept: no picture has run out of its budget.
  const second = PICTURES * PICTURE * RUNS;
  assert.ok(all.passed > 0.9 * second, `${all.passed} of ${second} ms simulated`);
  // Without canvases there is no painting, which a laptop's graphics chip does.
  await opened.addStyleTag({ content: 'canvas { display: none !important }' });
  const computed = await cost(opened, metrics);
  t.diagnostic(`a picture: ${all.least.toFixed(1)} ms of CPU, ${computed.least.toFixed(1)} ms without painting`);
  assert.ok(all.least < PICTURE, `${all.least} ms, painted by the processor`);
  assert.ok(computed.least < PICTURE / 3, `${computed.least} ms without painting`);
});

test('the slider of the springs does not keep the page from drawing', async () => {
  const { opened, metrics } = await walking();
  await opened.addStyleTag({ content: 'canvas { display: none !important }' });
  await opened.getByLabel('Driven by').selectOption('strut');
  await opened.getByLabel('Pull in the strut').fill('0.5');
  // Ten gaits are predicted meanwhile, for seconds; in another thread.
  const { least } = await cost(opened, metrics);
  assert.ok(least < PICTURE / 2, `${least} ms without painting`);
});

test('nothing was complained of', () => assert.deepEqual(complaints, []));
