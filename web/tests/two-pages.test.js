// Two pages at one robot: one by the board's cable, the other by a module at the same serial line.
import assert from 'node:assert/strict';
import { after, afterEach, before, test } from 'node:test';

import { openWithBoard } from './board.js';
import { close, closePages, complaints, open, page as openPage, text, within } from './browser.js';

before(open);
afterEach(closePages);
after(close);

const activityOf = (page) => text(page, '#doing');
const startWalk = (page) => page.locator('#gaits button[data-command="walk"]').click();

/** A port whose bytes a test carries; runs in the page before anything else. */
function farSerial() {
  window.toBoard = [];
  let output;
  const port = {
    async open() {
      port.readable = new ReadableStream({ start: (controller) => (output = controller) });
      port.writable = new WritableStream({ write: (bytes) => void window.toBoard.push(...bytes) });
    },
    getInfo: () => ({ bluetoothServiceClassId: '00001101-0000-1000-8000-00805f9b34fb' }),
    async setSignals() {},
    async close() {},
  };
  window.hear = (bytes) => output?.enqueue(Uint8Array.from(bytes));
  Object.defineProperty(navigator, 'serial', { value: { requestPort: async () => port } });
}

/** Opens both pages; returns them, and a function that advances both clocks until a condition holds. */
async function openTwoPages() {
  const first = await openWithBoard('robot', 8000);
  await first.evaluate(() => {
    const { otherBoard } = window;
    const { onByte } = otherBoard;
    window.spoken = [];
    otherBoard.onByte = (byte) => {
      window.spoken.push(byte);
      onByte(byte);
    };
  });
  const second = await openPage({}, farSerial);
  const step = async () => {
    await first.clock.runFor(20);
    const spoken = await first.evaluate(() => window.spoken.splice(0));
    await second.evaluate((bytes) => window.hear(bytes), spoken);
    await second.clock.runFor(20);
    const bytes = await second.evaluate(() => window.toBoard.splice(0));
    await first.evaluate((bytes) => bytes.length > 0 && window.otherBoard.send(bytes), bytes);
  };
  const until = async (waitName, isSo) => {
    let isWaiting = true;
    const advance = async () => {
      while (isWaiting && !(await isSo())) await step();
    };
    await within(waitName, advance()).finally(() => (isWaiting = false));
  };
  await second.locator('#connect').click();
  await until('the second page finds the robot', async () => (await text(second, '#where')).includes('on Bluetooth'));
  return { first, second, until };
}

test('each of two pages shows the robot\'s activity, and stops a gait that the other has started', async () => {
  const { first, second, until } = await openTwoPages();
  for (const [driver, watcher] of [
    [first, second],
    [second, first],
  ]) {
    await startWalk(driver);
    for (const page of [driver, watcher]) await until('it is seen to walk', async () => (await activityOf(page)) === 'walk');
    await watcher.keyboard.press('Escape');
    for (const page of [driver, watcher]) await until('it is seen to stop', async () => (await activityOf(page)) === 'stop');
  }
  const isSettled = async () => /deadman 0\n[^]*deadman 0\n[^]*$/.test(await first.evaluate(() => window.heard));
  await until('each driver has given the deadman back', isSettled);
  for (const page of [first, second]) assert.equal(await page.locator('#alarm').isVisible(), false);
});

test('the browser reported no error or warning', () => assert.deepEqual(complaints, []));
