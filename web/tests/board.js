// A board at the page's Web Serial port, run by the page's own clock.
import { openPage, text, withTimeout } from './browser.js';
import { installFakeSerial } from './fake-serial.js';

/**
 * Opens the page, connects a board that has the firmware and the named robot in its flash, and advances the page's
 * clock by `ms`.
 */
export async function openWithBoard(robotName, ms) {
  const page = await openPage({}, installFakeSerial);
  await page.evaluate((name) => (window.flashedRobot = name), robotName);
  await page.locator('#connect').click();
  await page.waitForFunction(() => window.attachedBoard);
  await page.clock.runFor(ms);
  return page;
}

/** Opens the page, connects a board with an erased flash, and waits until its boot loader has identified it. */
export async function openWithErasedBoard() {
  const page = await openWithBoard(null, 0);
  await runUntil(page, 'the board is identified', async () => /without this firmware$/.test(await text(page, '#where')));
  return page;
}

/** Opens the page and connects a board that receives nothing. */
export async function openWithDeafBoard() {
  const page = await openWithBoard(null, 0);
  await page.evaluate(() => (window.attachedBoard.send = () => {}));
  return page;
}

/**
 * Advances the page's clock until `condition` returns true. Only real time is limited, because the page may also wait
 * for the machine.
 */
export async function runUntil(page, waitName, condition, stepMs = 100) {
  let isWaiting = true;
  const advance = async () => {
    while (isWaiting && !(await condition())) await page.clock.runFor(stepMs);
  };
  await withTimeout(waitName, advance()).finally(() => (isWaiting = false));
}
