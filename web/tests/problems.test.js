// A problem is shown near the user's last action, and stays until it is solved.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { address, advance, dropBrowserErrors, openBlankPage, openForbidden, openStanding, openPage, readText, sendLine, unfold, useBrowser, chooseRobot, testPage, clickAndAdvance } from './browser.js';
import { installFakeSerial } from './fake-serial.js';

useBrowser();

const findProblems = (page) => page.locator('#problems');

testPage('the message about an unreadable robot file stays while the previous robot walks on', openStanding, async (page) => {
  await page.route('**/files/large.toml', (route) => route.fulfill({ status: 404 }));
  await page.locator('#robot').selectOption('large');
  const message = findProblems(page).getByText('files/large.toml is missing (status 404)');
  await message.waitFor();
  assert.equal(await page.locator('#robot').inputValue(), 'robot', 'the list shows the robot in use');
  await sendLine(page, 'walk', 'ok walk');
  await advance(page, 5000);
  await unfold(page, '#power');
  await page.locator('#health dd', { hasText: 'power' }).waitFor();
  assert.ok(await message.isVisible(), 'answers of the robot do not remove the message');
  assert.equal(await page.evaluate(() => window.lizard.robot.file), 'robot');
  await page.unroute('**/files/large.toml');
  await chooseRobot(page, 'large');
  assert.equal(await findProblems(page).isVisible(), false, 'a readable robot file removes the message');
  // The browser also reports the missing file, as expected.
  dropBrowserErrors(/404/);
});

testPage('the robot in use keeps its name if a second choice fails while the first is still loading', openStanding, async (page) => {
  await page.route('**/files/large.toml', () => {});
  await page.route('**/files/paper.toml', (route) => route.fulfill({ status: 404 }));
  await page.locator('#robot').selectOption('large');
  await page.locator('#robot').selectOption('paper');
  await findProblems(page).getByText('files/paper.toml is missing (status 404)').waitFor();
  assert.equal(await page.evaluate(() => window.lizard.robot.file), 'robot');
  // The browser also reports the missing file, as expected.
  dropBrowserErrors(/404/);
});

testPage('the page reports an unreadable first robot and accepts another robot', openBlankPage, async (page) => {
  await page.route('**/files/robot.toml', (route) => route.fulfill({ status: 404 }));
  await page.goto(address());
  await findProblems(page).getByText('files/robot.toml is missing (status 404)').waitFor();
  assert.equal(await readText(page, '#where'), 'No robot is loaded.');
  for (const control of ['#connect', '#reset']) assert.ok(await page.locator(control).isDisabled(), control);
  await page.keyboard.press('Escape');
  assert.doesNotMatch(await readText(page, '#problems'), /Cannot read/);
  await chooseRobot(page, 'paper');
  await advance(page, 2500);
  assert.match(await readText(page, '#where'), /^on a simulated UNO, robot paper [0-9a-f]{8}$/);
  assert.equal(await findProblems(page).isVisible(), false);
});

testPage('a failure of the simulation is reported, and another robot then walks', openStanding, async (page) => {
  await page.evaluate(() => {
    window.lizard.board.link.board.run = () => {
      throw new Error('unknown instruction');
    };
  });
  await findProblems(page).getByText('The simulated UNO has stopped: unknown instruction').waitFor();
  await chooseRobot(page, 'large');
  await advance(page, 2500);
  assert.equal(await findProblems(page).isVisible(), false);
  await sendLine(page, 'walk', 'ok walk');
  // The page also writes the error to the console, as expected.
  dropBrowserErrors(/unknown instruction/);
});

testPage('an error while drawing is reported once, and the simulation continues', openStanding, async (page) => {
  await page.evaluate(() => {
    CanvasRenderingContext2D.prototype.setTransform = () => {
      throw new Error('no memory');
    };
    void window.lizard.board.ask('walk');
  });
  await findProblems(page).getByText('The page cannot draw everything (no memory)').waitFor();
  await page.getByRole('button', { name: 'Dismiss' }).click();
  const clock = await page.evaluate(() => window.lizard.clock);
  await page.waitForFunction((clock) => window.lizard.clock > clock + 0.5, clock);
  assert.equal(await findProblems(page).isVisible(), false);
  // The page also writes the error to the console, as expected.
  dropBrowserErrors(/no memory/);
});

testPage('the page reports a room that cannot be opened, for example because its files belong to another version', openStanding, async (page) => {
  await page.route('**/measure-*.js', (route) => route.fulfill({ status: 404 }));
  await page.locator('nav a', { hasText: 'Measure' }).click();
  await findProblems(page).getByText('The room Measure cannot be opened').waitFor();
  // The browser also reports the missing file, as expected.
  dropBrowserErrors(/404/);
});

testPage('the page reports once that its predictions cannot be computed', openStanding, async (page) => {
  await page.evaluate(() => {
    const { Worker } = window;
    window.Worker = function () {
      return new Worker('missing.js', { type: 'module' });
    };
    window.lizard.robot.setServos('ideal');
  });
  await findProblems(page).getByText('The page cannot compute predictions').waitFor();
  await page.getByRole('button', { name: 'Dismiss' }).click();
  await page.evaluate(() => window.lizard.robot.setServos('copy'));
  await advance(page, 500);
  assert.equal(await findProblems(page).isVisible(), false);
  // The browser also reports the missing worker, as expected.
  dropBrowserErrors(/404|worker could not be loaded/);
});

testPage('the message about a busy port stays until the user dismisses it', () => openPage({}, installFakeSerial), async (page) => {
  await page.evaluate(() => {
    window.onPortOpen = () => {
      throw new DOMException('Failed to open serial port.', 'NetworkError');
    };
  });
  await page.locator('#connect').click();
  const message = findProblems(page).getByText('No board is connected: Failed to open serial port.');
  await message.waitFor();
  await unfold(page, '#power');
  await page.clock.runFor(8000);
  await page.locator('#health dd', { hasText: 'power' }).waitFor();
  assert.ok(await message.isVisible());
  await page.getByRole('button', { name: 'Dismiss' }).click();
  assert.equal(await findProblems(page).isVisible(), false);
});

testPage('cancelling the choice of a port reports no problem', () => openPage({}, installFakeSerial), async (page) => {
  await page.evaluate(() => {
    window.onPortPick = () => {
      window.isPickCancelled = true;
      throw new DOMException('No port selected by the user.', 'NotFoundError');
    };
  });
  await page.locator('#connect').click();
  await page.waitForFunction(() => window.isPickCancelled);
  await page.clock.runFor(500);
  assert.equal(await findProblems(page).isVisible(), false);
  assert.match(await readText(page, '#where'), /simulated UNO/);
});

testPage('the page gives the reason why ports are forbidden, and the simulation continues', () => openForbidden('serial'), async (page) => {
  await page.locator('#connect').click();
  await findProblems(page).getByText('Access to the feature "serial" is disallowed by permissions policy.').waitFor();
  assert.match(await findProblems(page).innerText(), /^No board is connected: /);
  assert.match(await readText(page, '#where'), /simulated UNO/);
});

test('the page reports a browser without Web Serial at once', async () => {
  const page = await openPage({}, () => Object.defineProperty(navigator, 'serial', { value: undefined }));
  await page.getByText('This browser cannot connect to a board on USB').waitFor();
});

test('a refusal is on the screen beside the buttons, also on a phone', async () => {
  const page = await openStanding({ viewport: { width: 390, height: 844 }, hasTouch: true });
  await clickAndAdvance(page, '[data-command="rest"]', 300);
  await clickAndAdvance(page, '#gaits button[data-command="walk"]', 300);
  const message = page.locator('#drive-message');
  await message.getByText('walk: the servos are resting; send stand first').waitFor();
  const { y, height } = await message.boundingBox();
  assert.ok(y >= 0 && y + height <= 844, `the message is on the screen: ${y} to ${y + height}`);
  await clickAndAdvance(page, '#gaits button[data-command="stand"]', 300);
  await message.waitFor({ state: 'hidden' });
});
