// A board at the page's Web Serial port, run by the page's own clock.
import { openPage, repeatUntil, readText } from './browser.js';
import { installFakeSerial } from './fake-serial.js';

/** Connects the board of the fake port after changing some of its settings. */
export async function connect(page, settings = {}) {
  await page.evaluate((settings) => Object.assign(window, settings), settings);
  await page.locator('#connect').click();
  await page.waitForFunction(() => window.attachedBoard);
}

/** Connects the same board again after it was unplugged. */
export async function reconnect(page) {
  await runUntil(page, 'a board can be connected', () => page.locator('#connect').isEnabled());
  await connect(page, { isSameBoard: true });
}

/**
 * Opens the page, connects a board that has the firmware and the named robot in its flash, and advances the page's
 * clock by `ms`: after the default, the robot stands.
 */
export async function openWithBoard(robotName = 'robot', ms = 8000, settings = {}) {
  const page = await openPage({}, installFakeSerial);
  await connect(page, { flashedRobot: robotName, ...settings });
  await page.clock.runFor(ms);
  return page;
}

/** Opens the page, connects a board with an erased flash, and waits until its boot loader has identified it. */
export async function openWithErasedBoard() {
  const page = await openWithBoard(null, 0);
  await waitForText(page, '#where', /without this firmware$/);
  return page;
}

/** Opens the page and connects a board that receives nothing. */
export async function openWithDeafBoard() {
  const page = await openWithBoard(null, 0);
  await page.evaluate(() => (window.attachedBoard.send = () => {}));
  return page;
}

/** Advances the page's clock until `condition` returns true. */
export const runUntil = (page, awaitedEvent, condition, stepMs = 100) => repeatUntil(awaitedEvent, condition, () => page.clock.runFor(stepMs));

/** Advances the page's clock until the text of an element matches. */
export const waitForText = (page, selector, pattern, stepMs) =>
  runUntil(page, `${selector} shows ${pattern}`, async () => pattern.test(await readText(page, selector)), stepMs);

/** Reads the board's flash from one address to another. */
export const readFlash = async (page, from, to) => Buffer.from(await page.evaluate(([from, to]) => Array.from(window.attachedBoard.flash.subarray(from, to)), [from, to]));

/** Sends a line to the board, and waits for its answer. */
export async function sendToBoard(page, line) {
  const countAnswers = () => page.locator('#log div', { hasText: `ok ${line}` }).count();
  const previousCount = await countAnswers();
  await page.getByLabel('A line for the robot').fill(line);
  await page.getByRole('button', { name: 'Send' }).click();
  await runUntil(page, `${line} is answered`, async () => (await countAnswers()) > previousCount);
  await page.locator('#log').focus();
}
