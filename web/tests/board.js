// A board at the page's Web Serial port, run by the page's own clock.
import { page as openPage, within } from './browser.js';
import { fakeSerial } from './fake-serial.js';

/**
 * Opens the page and connects a board with the firmware and a robot, or an empty one for null; `ms` pass after that.
 */
export async function openWithBoard(robot, ms) {
  const page = await openPage({}, fakeSerial);
  await page.evaluate((robot) => (window.flashed = robot), robot);
  await page.locator('#connect').click();
  await page.waitForFunction(() => window.otherBoard);
  await page.clock.runFor(ms);
  return page;
}

/**
 * Advances the page's clock until `isSo` holds. There is no limit in page time, since the page may also wait for the
 * machine.
 */
export async function until(page, condition, isSo, step = 100) {
  let isWaiting = true;
  const advance = async () => {
    while (isWaiting && !(await isSo())) await page.clock.runFor(step);
  };
  await within(condition, advance()).finally(() => (isWaiting = false));
}
