// Waits of a person, in real time: nothing runs beside this file. What is busy all the same only ever adds to them, so
// one try in time is enough.
import assert from 'node:assert/strict';
import { after, afterEach, before, test } from 'node:test';

import { address, close, complaints, open, openBlank, page, closePages, within } from './browser.js';

before(open);
afterEach(closePages);
after(close);

const TRIES = 12;
/** From the page's address to the first step of the robot at full speed, ms. */
const FIRST_STEP = 1500;
/** From a press of Stop to its line on the way to the robot and its answer, ms, on a processor six times as slow. */
const STOP = 300;
const SLOW = 6;
const MOVING = { reducedMotion: 'no-preference' };

const tools = (opened) => within('the tools of the browser', opened.context().newCDPSession(opened));
const walks = () => window.lizard?.gait === 'walk';

/** Measures until a time is short enough, at most TRIES times, and returns the shortest. */
async function least(enough, measure) {
  let shortest = Infinity;
  for (let n = 0; n < TRIES && shortest > enough; n++) shortest = Math.min(shortest, await measure());
  return shortest;
}

test('the first step comes soon after the page was asked for', async (t) => {
  const time = await least(FIRST_STEP, async () => {
    const opened = await openBlank(MOVING);
    await opened.goto(address());
    await opened.waitForFunction(walks);
    const time = await opened.evaluate(() => performance.now());
    await opened.close();
    return time;
  });
  t.diagnostic(`first step after ${time.toFixed(0)} ms`);
  assert.ok(time <= FIRST_STEP, `${time} ms`);
});

test('on a slow phone the opening walk begins, and Stop stops it in 0.3 s', async (t) => {
  const phone = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true, ...MOVING };
  const opened = await openBlank(phone);
  await (await tools(opened)).send('Emulation.setCPUThrottlingRate', { rate: SLOW });
  await opened.goto(address());
  await opened.waitForFunction(walks);
  const time = await least(STOP, async () => {
    await opened.evaluate(() => {
      addEventListener('pointerdown', ({ timeStamp }) => {
        const look = () => (window.lizard.gait === 'stop' ? (window.stopped = performance.now() - timeStamp) : requestAnimationFrame(look));
        look();
      }, { once: true, capture: true });
      delete window.stopped;
    });
    await opened.locator('button.stop').tap();
    await opened.waitForFunction(() => window.stopped);
    const time = await opened.evaluate(() => window.stopped);
    await opened.evaluate(() => void window.lizard.ask('walk'));
    await opened.waitForFunction(walks);
    return time;
  });
  t.diagnostic(`stopped after ${time.toFixed(0)} ms`);
  assert.ok(time <= STOP, `${time} ms`);
});

test('nothing was complained of', () => assert.deepEqual(complaints, []));
