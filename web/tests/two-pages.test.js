// Two pages connected to one robot: through the board's cable, and through a Bluetooth module at the same serial line.
import assert from 'node:assert/strict';

import { openWithBoard } from './board.js';
import { openPage, readText, useBrowser, repeatUntil, findGaitButton, testPage } from './browser.js';

useBrowser();

const readActivity = (page) => readText(page, '#doing');
const startWalk = (page) => findGaitButton(page, 'walk').click();

/** Replaces Web Serial with a port whose bytes the test transfers; runs in the page before any other script. */
function installRelayedSerial() {
  window.bytesToBoard = [];
  let output;
  const port = {
    async open() {
      port.readable = new ReadableStream({ start: (controller) => (output = controller) });
      port.writable = new WritableStream({ write: (bytes) => void window.bytesToBoard.push(...bytes) });
    },
    getInfo: () => ({ bluetoothServiceClassId: '00001101-0000-1000-8000-00805f9b34fb' }),
    async setSignals() {},
    async close() {},
  };
  window.receiveBytes = (bytes) => output?.enqueue(Uint8Array.from(bytes));
  Object.defineProperty(navigator, 'serial', { value: { requestPort: async () => port } });
}

/** Opens both pages; returns them, and a function that advances both clocks until a condition is true. */
async function openTwoPages() {
  const cablePage = await openWithBoard();
  await cablePage.evaluate(() => {
    const { attachedBoard } = window;
    const { onByte } = attachedBoard;
    window.bytesFromBoard = [];
    attachedBoard.onByte = (byte) => {
      window.bytesFromBoard.push(byte);
      onByte(byte);
    };
  });
  const radioPage = await openPage({}, installRelayedSerial);
  const step = async () => {
    await cablePage.clock.runFor(20);
    const bytesFromBoard = await cablePage.evaluate(() => window.bytesFromBoard.splice(0));
    await radioPage.evaluate((bytes) => window.receiveBytes(bytes), bytesFromBoard);
    await radioPage.clock.runFor(20);
    const bytesToBoard = await radioPage.evaluate(() => window.bytesToBoard.splice(0));
    await cablePage.evaluate((bytes) => bytes.length > 0 && window.attachedBoard.send(bytes), bytesToBoard);
  };
  const runUntil = (awaitedEvent, condition) => repeatUntil(awaitedEvent, condition, step);
  await radioPage.locator('#connect').click();
  await runUntil('the second page finds the robot', async () => (await readText(radioPage, '#where')).includes('on Bluetooth'));
  return { cablePage, radioPage, runUntil };
}

testPage('each of two pages shows the robot\'s activity, and stops a gait that the other has started', openTwoPages, async ({ cablePage, radioPage, runUntil }) => {
  for (const [driver, watcher] of [[cablePage, radioPage], [radioPage, cablePage]]) {
    await startWalk(driver);
    for (const page of [driver, watcher]) await runUntil('both pages show the walk', async () => (await readActivity(page)) === 'walk');
    await watcher.keyboard.press('Escape');
    for (const page of [driver, watcher]) await runUntil('both pages show the stop', async () => (await readActivity(page)) === 'stop');
  }
  const readReceivedText = () => cablePage.evaluate(() => window.receivedText);
  const isRestored = async () => /deadman 0\n[^]*deadman 0\n[^]*$/.test(await readReceivedText());
  await runUntil('both pages have restored the deadman', isRestored);
  for (const page of [cablePage, radioPage]) assert.equal(await page.locator('#alarm').isVisible(), false);
});
