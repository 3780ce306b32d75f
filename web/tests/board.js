// A board behind the page's Web Serial, in the page's own time.
import { page, within } from './browser.js';
import { fakeSerial } from './fake-serial.js';

/** The page with a board that has the firmware and this robot, or nothing where it is null, so long after it was connected. */
export async function connected(robot, ms) {
  const opened = await page({}, fakeSerial);
  await opened.evaluate((robot) => (window.flashed = robot), robot);
  await opened.locator('#connect').click();
  await opened.waitForFunction(() => window.otherBoard);
  await opened.clock.runFor(ms);
  return opened;
}

/** Lets the page's time go on until this is so. It is not counted, since the page may wait for the machine, too. */
export async function until(opened, what, isSo, step = 100) {
  let waits = true;
  const goes = async () => {
    while (waits && !(await isSo())) await opened.clock.runFor(step);
  };
  await within(what, goes()).finally(() => (waits = false));
}
