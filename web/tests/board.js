// A board behind the page's Web Serial, in the page's own time.
import assert from 'node:assert/strict';

import { page } from './browser.js';
import { fakeSerial } from './fake-serial.js';

/** The page with a board that has the firmware and this robot, or nothing where it is null, so long after it was connected. */
export async function connected(robot, ms) {
  const opened = await page({}, fakeSerial);
  await opened.evaluate((robot) => (window.flashed = robot), robot);
  await opened.getByRole('button', { name: 'Connect a board' }).click();
  await opened.waitForFunction(() => window.otherBoard);
  await opened.clock.runFor(ms);
  return opened;
}

/** Lets the page's time go on until this is so, for 20 s of it at most. */
export async function until(opened, what, isSo) {
  for (let ms = 0; ms < 20_000; ms += 250) {
    if (await isSo()) return;
    await opened.clock.runFor(250);
  }
  assert.fail(`waited 20 s of the page's time until ${what}`);
}
