// A board at the page's Web Serial port, run by the page's own clock.
import { page, within } from './browser.js';
import { fakeSerial } from './fake-serial.js';

/** Opens the page and connects a board with the firmware and a robot, or an empty one for null; `ms` pass after that. */
export async function openWithBoard(robot, ms) {
  const opened = await page({}, fakeSerial);
  await opened.evaluate((robot) => (window.flashed = robot), robot);
  await opened.locator('#connect').click();
  await opened.waitForFunction(() => window.otherBoard);
  await opened.clock.runFor(ms);
  return opened;
}

/** Advances the page's clock until `isSo` holds. There is no limit in page time, since the page may also wait for the machine. */
export async function until(opened, what, isSo, step = 100) {
  let isWaiting = true;
  const advance = async () => {
    while (isWaiting && !(await isSo())) await opened.clock.runFor(step);
  };
  await within(what, advance()).finally(() => (isWaiting = false));
}
