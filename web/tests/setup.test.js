// The first connection, from a new board to a robot that walks and has a saved calibration, with interruptions at every
// step.
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { writeFile } from 'node:fs/promises';
import { join } from 'node:path';
import { promisify } from 'node:util';

import { openWithBoard, openWithDeafBoard, openWithErasedBoard, runUntil, connect, waitForText, sendToBoard } from './board.js';
import { advance, openStanding, measureOverflow, openPage, TIMEOUT_MS, readText, unfold, useBrowser, download, testPage, PHONE, findGaitButton, readGait } from './browser.js';
import { installFakeSerial } from './fake-serial.js';
import { makeFolder } from './temporary-folder.js';

useBrowser();

/** Arduino pins of A1 to A4 in robot.toml. */
const PINS = [9, 10, 11, 3];
const findDialog = (page) => page.locator('#setup');
const press = async (page, name) => {
  await findDialog(page).scrollIntoViewIfNeeded();
  await findDialog(page).getByRole('button', { name, exact: true }).click();
};
/** Goes to a step, and then advances the clock by `ms`. */
const goToStep = async (page, name, ms = 0) => {
  await findDialog(page).scrollIntoViewIfNeeded();
  await findDialog(page).getByRole('list', { name: 'Steps' }).getByRole('button', { name: new RegExp(`${name}$`) }).click();
  if (ms > 0) await page.clock.runFor(ms);
};
const readPulseWidths = (page) => page.evaluate((pins) => pins.map((pin) => window.pulseWidthsUs[pin]), PINS);

const waitForMessage = (page, pattern) => waitForText(page, '#setup-message', pattern);
/** Advances the clock until the dialog reports that the board has this firmware and this robot. */
const waitForThisRobot = (page) =>
  runUntil(page, 'the board sends its banner', async () => (await findDialog(page).getByText('has this firmware and this robot, robot.toml.').count()) > 0);
/** Types a number into a box of the dialog, and waits for a message. */
async function typeNumber(page, label, number, pattern) {
  await findDialog(page).getByLabel(label).fill(number);
  await findDialog(page).getByLabel(label).press('Enter');
  await waitForMessage(page, pattern);
}
/** Leaves the dialog, and waits until it is closed. */
async function leave(page) {
  await press(page, 'Leave');
  await runUntil(page, 'the dialog is closed', async () => !(await findDialog(page).isVisible()));
}

async function pressAndWait(page, name, pattern) {
  await press(page, name);
  await waitForMessage(page, pattern);
}

function assertNear(values, expected, tolerance, quantity) {
  values.forEach((value, n) => assert.ok(Math.abs(value - expected[n]) <= tolerance, `${quantity}: ${values}, not ${expected}`));
}

/** Reads the robot's own answer to `cal`. */
async function readCalibration(page) {
  await sendToBoard(page, 'cal');
  // The dialog may have read the settings at the same time, and its answer comes first.
  await page.clock.runFor(500);
  return (await page.locator('#log div', { hasText: /^# A\d trim/ }).allInnerTexts()).slice(-4);
}

testPage('the first connection turns a new UNO into a calibrated robot, and lizard calibrate restore accepts its file', openWithErasedBoard, async (page) => {
  await findDialog(page).getByText('2 of 9: Write the firmware').waitFor();
  await findDialog(page).getByText('The board on USB is a UNO according to its boot loader, without this firmware.').waitFor();
  await pressAndWait(page, 'Write firmware and robot', /^written and verified in [\d.]+ s$/);
  await waitForThisRobot(page);
  await press(page, 'Continue');

  // The servos get power now, so there must be no pulses.
  await pressAndWait(page, 'Let the servos rest', /^The pulses have ended/);
  await page.clock.runFor(200);
  await page.evaluate(() => (window.pulseWidthsUs = {}));
  await page.clock.runFor(500);
  assert.deepEqual(await readPulseWidths(page), [undefined, undefined, undefined, undefined]);

  // Horns: each pin has the pulse width of the middle position.
  await pressAndWait(page, 'Turn all servos to their middle', /1500 µs/);
  assertNear(await readPulseWidths(page), [1500, 1500, 1500, 1500], 0.5, 'pulse widths in the middle position, us');

  // Signs: A2 is mounted upside down, so the user answers no.
  await goToStep(page, 'Signs');
  for (const [servo, isReversed] of [[1, false], [2, true], [3, false], [4, false]]) {
    await pressAndWait(page, `Turn A${servo}`, new RegExp(`^A${servo} received the command to turn by 10° counter-clockwise`));
    assertNear(await readPulseWidths(page), [1, 2, 3, 4].map((n) => (n === servo ? 1600 : 1500)), 0.6, 'pulse widths with one turned servo, us');
    if (isReversed) {
      await pressAndWait(page, 'No, in the other direction', new RegExp(`^The sign of A${servo} is now "-"`));
      await pressAndWait(page, `Turn A${servo}`, new RegExp(`^A${servo} received the command to turn by 10° counter-clockwise`));
      assertNear(await readPulseWidths(page), [1500, 1400, 1500, 1500], 0.6, 'pulse widths after the reversal, us');
    }
    await press(page, 'Yes');
  }
  await waitForMessage(page, /^All four servos turn in the right direction/);
  await findDialog(page).getByText('5 of 9: Straighten the cranks').waitFor();

  await press(page, 'A3 back right');
  await pressAndWait(page, '↻ 0.5°', /^The trim of A3 is -0\.50°/);
  await pressAndWait(page, '↺ 0.1°', /^The trim of A3 is -0\.40°/);

  await goToStep(page, 'Scale');
  await pressAndWait(page, 'Turn A1', /^A1 received the command to turn by 30°/);
  assertNear(await readPulseWidths(page), [1200, 1500, 1496, 1500], 0.6, 'pulse widths after 30 deg in the safe direction, us');
  // 10 us per degree, times 30, divided by 27.75.
  await typeNumber(page, 'Measured angle, degrees', '27.75', /^The scale of A1 is 10\.81 µs per degree/);
  // A new scale does not move the horn, so the trim in degrees changes.
  await press(page, 'A3 back right');
  await pressAndWait(page, 'Turn A3', /^A3 received the command to turn by 30°/);
  await typeNumber(page, 'Measured angle, degrees', '27.75', /^The scale of A3 is 10\.81 µs per degree/);
  await waitForText(page, '#doing', /^stand$/);
  await page.clock.runFor(500);
  assertNear(await readPulseWidths(page), [1500, 1500, 1496, 1500], 0.6, 'pulse widths in the neutral pose, us');

  await goToStep(page, 'Limits');
  await waitForText(page, '#doing', /^stand$/);
  await press(page, 'A4 back left');
  await pressAndWait(page, '↻ 5°', /^A4 points to 216\.41°/);
  await press(page, 'A4 back left');
  await typeNumber(page, 'From, degrees', '150', /^A4 travels from 150\.00° to 311\.41°/);

  await goToStep(page, 'First walk');
  assert.equal(await findDialog(page).getByText('Not checked yet').count(), 0);
  await waitForText(page, '#doing', /^stand$/);
  await pressAndWait(page, 'Walk', /^The robot has started "walk"/);
  const startY = await page.evaluate(() => window.lizard.robot.last.place.y);
  await page.clock.runFor(3000);
  assert.ok((await page.evaluate(() => window.lizard.robot.last.place.y)) - startY > 10, 'the robot walks');
  await pressAndWait(page, 'Stand', /^The robot stands/);

  await findDialog(page).getByRole('button', { name: 'Save first', exact: true }).waitFor();
  await goToStep(page, 'Keep');
  await findDialog(page).getByText('Not saved yet.').waitFor();
  await pressAndWait(page, 'Save in the board', /^Saved: the board starts with it/);
  const { bytes } = await download(page, findDialog(page).getByRole('button', { name: 'Save as a file', exact: true }));

  // The restarted board has the calibration, and the host's program accepts the saved file.
  await page.evaluate(() => window.attachedBoard.reset('external'));
  await page.clock.runFor(5000);
  assert.deepEqual(await readCalibration(page), [
    '# A1 trim 0.00 limit 48.59 228.59 dir + scale 10.81',
    '# A2 trim 0.00 limit 311.41 131.41 dir - scale 10.00',
    '# A3 trim -0.37 limit 228.59 48.59 dir + scale 10.81',
    '# A4 trim 0.00 limit 150.00 311.41 dir + scale 10.00',
  ]);
  const calibrationFile = join(await makeFolder(), 'calibration.toml');
  await writeFile(calibrationFile, bytes);
  const root = new URL('../..', import.meta.url).pathname;
  const robotArgs = ['--sim', '--robot', 'robot.toml'];
  const { stdout } = await promisify(execFile)(process.env.LIZARD, ['calibrate', 'restore', calibrationFile, ...robotArgs], { cwd: root, timeout: TIMEOUT_MS });
  assert.match(stdout, /has accepted and saved the calibration from .*/);
});

testPage('a board with another robot is recognised, and gets only the page\'s robot', () => openWithBoard('large', 5000), async (page) => {
  await findDialog(page).getByText('has this firmware and another robot, large ').waitFor();
  await pressAndWait(page, 'Write this robot alone', /^written and verified in [\d.]+ s$/);
  await waitForThisRobot(page);
});

testPage('the dialog reports a board that does not answer, and every step leads back to the board', openWithDeafBoard, async (page) => {
  await runUntil(page, 'the dialog reports it', () => findDialog(page).getByText('answers neither like this firmware nor like a boot loader').isVisible());
  await pressAndWait(page, 'Write firmware and robot', /^not written: no boot loader answers/);
  await goToStep(page, 'Horns');
  await findDialog(page).getByText('No robot with this firmware answers').waitFor();
  await press(page, 'To the board');
  await press(page, 'Disconnect');
  await waitForText(page, '#where', /simulated UNO/);
});

testPage('the page does not mistake a board that sends random bytes for a robot', () => openWithBoard('robot', 0, { boardSendsGarbage: true }), async (page) => {
  await runUntil(page, 'the page asks about the board', async () => findDialog(page).getByText('answers neither like this firmware nor like a boot loader').isVisible());
  await pressAndWait(page, 'Write firmware and robot', /^not written: /);
  const lengths = await page.locator('#log div').evaluateAll((lines) => lines.map(({ textContent }) => textContent.length));
  assert.ok(Math.max(0, ...lengths) < 1000, 'an endless line is truncated');
});

testPage('the dialog reports an unplugged board at any step, and keeps the step', () => openPage({}, installFakeSerial), async (page) => {
  const names = await page.locator('#setup-steps button').allTextContents();
  assert.equal(names.length, 9);
  for (const name of names) {
    await connect(page, { attachedBoard: undefined });
    await page.clock.runFor(4500);
    await goToStep(page, name, 400);
    // The cable is pulled during the step's action, if it has one.
    const mainButtons = findDialog(page).locator('#setup-content button.main');
    const mainButton = (await mainButtons.count()) > 0 && !['Board', 'Firmware'].includes(name) ? mainButtons.first() : null;
    if (mainButton) await mainButton.click();
    await page.clock.runFor(60);
    await page.evaluate(() => window.unplug());
    await waitForMessage(page, /is no longer connected/);
    assert.match(await readText(page, '#setup-step'), new RegExp(`^${names.indexOf(name) + 1} of 9`), 'the step is kept');
    assert.equal(await findDialog(page).getAttribute('aria-busy'), 'false', 'no action is pending');
  }
});

testPage('a board that was unplugged during writing can be written after it is connected again', openWithErasedBoard, async (page) => {
  await press(page, 'Write firmware and robot');
  await page.clock.runFor(1500);
  await page.evaluate(() => window.unplug());
  await waitForMessage(page, /is no longer connected|not written/);
  await runUntil(page, 'a board can be connected', () => page.locator('#connect').isEnabled());
  await connect(page, { attachedBoard: undefined });
  await page.clock.runFor(8000);
  await pressAndWait(page, 'Write firmware and robot', /^written and verified/);
});

testPage('an action on a board does not continue in the simulation after the board is unplugged', () => openWithBoard('robot', 4500), async (page) => {
  await goToStep(page, 'Trims', 500);
  await page.evaluate(() => window.unplug());
  for (const name of ['Trims', 'Keep', 'Firmware']) {
    await goToStep(page, name, 500);
    await findDialog(page).locator('#setup-content').getByText('The board is no longer connected.').waitFor();
    assert.deepEqual(await findDialog(page).locator('#setup-content button').allInnerTexts(), ['Connect it again…', 'Try this step on the simulated UNO'], name);
  }
  await press(page, 'Try this step on the simulated UNO');
  await findDialog(page).getByText('to the simulated UNO').waitFor();
});

testPage('the robot does not walk while it is being assembled', openWithBoard, async (page) => {
  await runUntil(page, 'the gaits are predicted', async () => (await readText(page, '#gaits button[data-command="walk"] small')) !== '');
  await goToStep(page, 'Trims', 500);
  const previousLength = (await page.evaluate(() => window.receivedText)).length;
  await page.locator('#log').focus();
  await page.evaluate(() => {
    document.activeElement.blur();
    navigator.getGamepads = () => [{ axes: [0, -1], buttons: [] }];
  });
  await page.keyboard.down('w');
  await page.clock.runFor(500);
  await page.keyboard.up('w');
  assert.ok(!(await page.evaluate(() => window.receivedText)).slice(previousLength).includes('walk'));
  await page.evaluate(() => delete navigator.getGamepads);
  await leave(page);
  await findGaitButton(page, 'walk').click();
  await runUntil(page, 'the robot walks', async () => (await readGait(page)) === 'walk');
  await page.locator('#setup-open').click();
  await runUntil(page, 'the robot is stopped', async () => (await readGait(page)) !== 'walk');
});

testPage('the dialog reports a restarted board and the loss of unsaved settings', () => openWithBoard('robot', 4500), async (page) => {
  await findDialog(page).getByText('3 of 9: Fit the horns').waitFor();
  await goToStep(page, 'Trims', 500);
  await pressAndWait(page, '↺ 0.5°', /^The trim of A1 is 0\.50°/);
  await page.evaluate(() => window.attachedBoard.reset('external'));
  await waitForMessage(page, /^The board has restarted\. Unsaved settings are lost\.$/);
  await pressAndWait(page, '↺ 0.5°', /^The trim of A1 is 0\.50°/);
  // The next movement notices a restart whose banner is lost.
  await goToStep(page, 'Signs', 4000);
  await pressAndWait(page, 'Turn A1', /^A1 received the command to turn by 10°/);
  await page.evaluate(() => {
    const board = window.attachedBoard;
    const { onByte } = board;
    board.onByte = () => {};
    board.reset('external');
    setTimeout(() => (board.onByte = onByte), 2000);
  });
  await page.clock.runFor(2100);
  await pressAndWait(page, 'Turn A1 again', /^The board has restarted\. Unsaved settings are lost\.$/);
});

testPage('leaving restores the calibration, and the dialog opens again at the same step', () => openWithBoard('robot', 4500), async (page) => {
  const previousCalibration = await readCalibration(page);
  await goToStep(page, 'Trims', 500);
  await pressAndWait(page, '↺ 0.5°', /^The trim of A1 is 0\.50°/);
  assert.notDeepEqual(await readCalibration(page), previousCalibration);
  await leave(page);
  await page.getByText('the robot has its previous calibration').waitFor();
  assert.deepEqual(await readCalibration(page), previousCalibration);
  await page.locator('#setup-open').click();
  await findDialog(page).getByText('5 of 9: Straighten the cranks').waitFor();
  // A checked sign stays checked when the dialog opens again.
  await goToStep(page, 'Signs');
  await pressAndWait(page, 'Turn A1', /^A1 received the command to turn by 10°/);
  await press(page, 'Yes');
  await leave(page);
  await page.locator('#setup-open').click();
  await goToStep(page, 'First walk');
  await findDialog(page).getByText('Not checked yet: the sign of A2, A3, A4.').waitFor();
});

testPage('a sign that was reversed but not saved has to be checked again after the board was written', () => openWithBoard('robot', 4500), async (page) => {
  await goToStep(page, 'Signs', 1500);
  await pressAndWait(page, 'Turn A1', /^A1 received the command to turn by 10°/);
  await pressAndWait(page, 'No, in the other direction', /^The sign of A1 is now "-"/);
  await pressAndWait(page, 'Turn A1', /^A1 received the command to turn by 10°/);
  await press(page, 'Yes');
  await goToStep(page, 'Firmware');
  await pressAndWait(page, 'Write this robot alone', /^written and verified/);
  await waitForThisRobot(page);
  await goToStep(page, 'First walk', 5000);
  assert.match((await readCalibration(page))[0], / dir \+ /, 'the board has its previous sign');
  await findDialog(page).getByText('Not checked yet: the sign of A1, A2, A3, A4.').waitFor();
});

testPage('leaving while a servo turns drops the next change and restores the calibration', () => openWithBoard('robot', 4500), async (page) => {
  const previousCalibration = await readCalibration(page);
  await goToStep(page, 'Trims', 500);
  await pressAndWait(page, '↺ 0.5°', /^The trim of A1 is 0\.50°/);
  await goToStep(page, 'Signs', 1500);
  await pressAndWait(page, 'Turn A1', /^A1 received the command to turn by 10°/);
  // The servo turns back while both buttons are pressed.
  await goToStep(page, 'Trims');
  await press(page, '↺ 0.1°');
  await leave(page);
  await page.getByText('the robot has its previous calibration').waitFor();
  await page.clock.runFor(3000);
  assert.deepEqual(await readCalibration(page), previousCalibration);
  // After a restart, an action first reads the calibration.
  await page.locator('#setup-open').click();
  await page.evaluate(() => window.attachedBoard.reset('external'));
  await waitForMessage(page, /^The board has restarted/);
  await page.clock.runFor(1000);
  await press(page, '↺ 0.1°');
  await leave(page);
  await page.clock.runFor(3000);
  assert.deepEqual(await readCalibration(page), previousCalibration);
});

testPage('leaving reverts a setting whose answer was lost, and saving stores the shown settings', () => openWithBoard('robot', 4500), async (page) => {
  const previousCalibration = await readCalibration(page);
  const setTrimWithoutAnswer = async () => {
    await goToStep(page, 'Trims', 1500);
    await page.evaluate(() => {
      window.originalOnByte = window.attachedBoard.onByte;
      window.attachedBoard.onByte = () => {};
    });
    await pressAndWait(page, '↺ 0.5°', /^The robot did not answer "trim 1 0\.50"\.$/);
    await page.evaluate(() => (window.attachedBoard.onByte = window.originalOnByte));
  };
  await setTrimWithoutAnswer();
  assert.match((await readCalibration(page))[0], /^# A1 trim 0\.50 /, 'the robot has the new trim');
  await leave(page);
  assert.deepEqual(await readCalibration(page), previousCalibration);

  await page.locator('#setup-open').click();
  await setTrimWithoutAnswer();
  await goToStep(page, 'Keep');
  await pressAndWait(page, 'Save in the board', /^Saved: the board starts with it/);
  await findDialog(page).getByRole('row', { name: /^A1, front left \+ 0\.50°/ }).waitFor();
  assert.match((await readCalibration(page))[0], /^# A1 trim 0\.50 /);
});

testPage('the dialog keeps a setting that the console or the panel Calibrate has changed meanwhile', () => openWithBoard('robot', 4500), async (page) => {
  await goToStep(page, 'Keep', 1500);
  await sendToBoard(page, 'trim 1 5');
  await pressAndWait(page, 'Save in the board', /^Saved: the board starts with it/);
  await findDialog(page).getByRole('row', { name: /^A1, front left \+ 5\.00°/ }).waitFor();
  assert.match((await readCalibration(page))[0], /^# A1 trim 5\.00 /);
  await sendToBoard(page, 'TRIM 1 6');
  await goToStep(page, 'Signs');
  await goToStep(page, 'Keep');
  const isShown = () => findDialog(page).getByRole('row', { name: /^A1, front left \+ 6\.00°/ }).isVisible();
  await runUntil(page, 'the dialog shows the new trim', isShown);
  await leave(page);
  assert.match((await readCalibration(page))[0], /^# A1 trim 6\.00 /);
});

testPage('the dialog quotes a refusal by the robot and keeps the calibration', () => openWithBoard('robot', 4500), async (page) => {
  const previousCalibration = await readCalibration(page);
  await goToStep(page, 'Limits', 1000);
  await typeNumber(page, 'From, degrees', '125', /^The robot refuses "limit 1 125\.00 228\.59": A1's travel must cover the gaits' range/);
  assert.equal(await findDialog(page).getByLabel('From, degrees').inputValue(), '48.59');
  assert.deepEqual(await readCalibration(page), previousCalibration);
});

const SAVED_CALIBRATION = `format = "lizard calibration 1"
boot = "stand"
deadman = 0
${[1, 2, 3, 4].map((n) => `[servo.A${n}]\ntrim = ${n}.25\nlimit = [${[48.59, 311.41, 228.59, 131.41][n - 1]}, ${[228.59, 131.41, 48.59, 311.41][n - 1]}]\ndir = "+"\nscale = 10.0\n`).join('')}`;

testPage('the page sends a valid calibration file to the robot and reports the error in an invalid file', () => openWithBoard('robot', 4500), async (page) => {
  await goToStep(page, 'Keep', 1500);
  const openFile = (name, body) =>
    findDialog(page).getByLabel('Open a saved file').setInputFiles({ name, mimeType: 'text/plain', buffer: Buffer.from(body) });
  await openFile('mine.toml', SAVED_CALIBRATION);
  await waitForMessage(page, /^The robot has the calibration of mine\.toml, which is not saved yet\.$/);
  assert.match((await readCalibration(page))[2], /^# A3 trim 3\.25 /);
  const previousCalibration = await readCalibration(page);
  const wrongFiles = [
    ['<img src=x onerror="window.foreignScriptRan=1">.toml', 'hello', /^<img .*>\.toml:1: `hello` is missing the = /],
    ['a.toml', 'format = "lizard calibration 2"', /^a\.toml:1: format must be "lizard calibration 1"/],
    ['b.toml', SAVED_CALIBRATION.replace('2.25', '400'), /^b\.toml:\d+: servo\.A2\.trim is 400; it must be between -360 and 360 deg/],
    ['c.toml', SAVED_CALIBRATION.replace('"stand"', '"stand\\nsave"'), /^c\.toml:\d+: boot must be the name of a gait or a routine, or "rest"$/],
    ['d.toml', SAVED_CALIBRATION.replace('scale = 10.0', 'scale = 99.0'), /^The robot refuses "scale 1 99\.00": scale must be 5\.\.20/],
  ];
  for (const [name, body, message] of wrongFiles) {
    await openFile(name, body);
    await waitForMessage(page, message);
    assert.deepEqual(await readCalibration(page), previousCalibration, `${name} changes nothing`);
  }
  assert.equal(await page.evaluate(() => window.foreignScriptRan), undefined);
});

testPage('the keyboard alone can try every step without a board', openStanding, async (page) => {
  await page.locator('#setup-open').focus();
  await page.keyboard.press('Enter');
  assert.equal(await page.evaluate(() => document.activeElement.id), 'setup-step');
  /** Presses Tab until a control has the focus. */
  const tabTo = async (name) => {
    for (let n = 0; n < 40; n++) {
      if ((await page.evaluate(() => document.activeElement.textContent)) === name) return;
      await page.keyboard.press('Tab');
    }
    assert.fail(`no tab leads to ${name}`);
  };
  for (const title of ['Write the firmware', 'Fit the horns']) {
    await tabTo('Next step');
    await page.keyboard.press('Enter');
    await findDialog(page).getByText(title).first().waitFor();
  }
  await tabTo('Turn all servos to their middle');
  await page.keyboard.press('Enter');
  // Keys must not drive the robot, since the user's fingers may be in it.
  await page.keyboard.down('ArrowUp');
  for (let n = 0; n < 40 && (await readText(page, '#setup-message')) === ''; n++) await advance(page, 250);
  assert.match(await readText(page, '#setup-message'), /^Every servo now holds its middle position/);
  assert.equal(await page.evaluate(() => document.activeElement.textContent), 'Turn all servos to their middle', 'the focus stays');
  await advance(page, 500);
  await page.keyboard.up('ArrowUp');
  await unfold(page, '#pulses');
  await page.waitForFunction(() => document.querySelector('#widths td:nth-child(3)').textContent !== '–');
  assert.deepEqual(await page.locator('#widths td:nth-child(3)').allInnerTexts(), ['1500.00', '1500.00', '1500.00', '1500.00']);
});

for (const [name, options] of [
  ['a phone', PHONE],
  ['the narrowest screen', { viewport: { width: 320, height: 640 }, hasTouch: true, isMobile: true }],
]) {
  testPage(`every step fits on ${name} without scrolling sideways`, () => openStanding(options), async (page) => {
    await page.locator('#setup-open').tap();
    for (const button of await page.locator('#setup-steps button').all()) {
      await button.tap();
      await advance(page, 1500);
      const outsideTexts = await page.evaluate(() =>
        [...document.querySelectorAll('#setup :not(#setup-steps *):is(button, table, svg)')].filter((node) => node.getBoundingClientRect().right > innerWidth).map(({ textContent }) => textContent),
      );
      assert.equal(await measureOverflow(page), 0, await readText(page, '#setup-step'));
      assert.deepEqual(outsideTexts, []);
      // The row of steps scrolls until the current step's name is visible.
      const currentStep = await page.locator('#setup-steps [aria-current]').evaluate((button) => {
        const { left, right } = button.getBoundingClientRect();
        return { isVisible: left >= 0 && right <= innerWidth, isComplete: button.scrollWidth <= button.clientWidth, size: Number.parseFloat(getComputedStyle(button).fontSize) };
      });
      assert.ok(currentStep.isVisible && currentStep.isComplete && currentStep.size >= 12, JSON.stringify(currentStep));
    }
  });
}
