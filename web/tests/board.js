// A board at the page's Web Serial port, run by the page's own clock.
import { openPage, withTimeout } from './browser.js';
import { installFakeSerial } from './fake-serial.js';

/**
 * Opens the page, connects a board, and advances the page's clock by `ms`. The board has the firmware and the named
 * robot in its flash, or an erased flash if the name is null.
 */
export async function openWithBoard(robotName, ms) {
  const page = await openPage({}, installFakeSerial);
  await page.evaluate((name) => (window.flashedRobot = name), robotName);
  await page.locator('#connect').click();
  await page.waitForFunction(() => window.attachedBoard);
  await page.clock.runFor(ms);
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
