// A link that loses lines, a hidden page, and a robot that restarts: a stop reaches the robot, no gait starts by
// itself, and the page shows only the states that the robot has reported.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { openWithBoard, runUntil, waitForText, sendToBoard } from './board.js';
import { advance, openStanding, readText, useBrowser, hidePage, testPage, clickAndAdvance, findGaitButton, readGait } from './browser.js';

useBrowser();

const readTextReceivedByBoard = (page) => page.evaluate(() => window.receivedText);
const isStopping = (page) => page.evaluate(() => document.body.classList.contains('stopping'));

/** Drops the lines from the page to the board that contain one of these words, or all lines if the list is empty. */
const dropLines = (page, words) =>
  page.evaluate((words) => {
    const board = window.attachedBoard;
    window.originalSend ??= board.send;
    window.droppedCount = 0;
    board.send = (bytes) => {
      const text = String.fromCharCode(...bytes);
      if (words.length > 0 && !words.some((word) => text.includes(word))) return window.originalSend.call(board, bytes);
      window.droppedCount += 1;
    };
  }, words);
const restoreLink = (page) => page.evaluate(() => (window.attachedBoard.send = window.originalSend));

async function startWalk(page) {
  await findGaitButton(page, 'walk').click();
  await waitForText(page, '#doing', /^walk$/);
}

/** Presses Esc, and advances the clock by `ms`. */
async function pressEscapeAndAdvance(page, ms) {
  await page.keyboard.press('Escape');
  await page.clock.runFor(ms);
}

async function openWithWalkingRobot() {
  const page = await openWithBoard();
  await startWalk(page);
  return page;
}

testPage('"stop" is sent at once, and drops a line that waits for a lost answer', openWithWalkingRobot, async (page) => {
  await dropLines(page, ['status']);
  await runUntil(page, 'a status request is lost', () => page.evaluate(() => window.droppedCount > 0), 20);
  await findGaitButton(page, 'left').click();
  const receivedLength = (await readTextReceivedByBoard(page)).length;
  await pressEscapeAndAdvance(page, 40);
  assert.ok((await readTextReceivedByBoard(page)).slice(receivedLength).startsWith('stop\n'));
  await page.clock.runFor(4000);
  assert.ok(!(await readTextReceivedByBoard(page)).slice(receivedLength).includes('left'), 'no line is sent after "stop"');
  assert.equal(await readText(page, '#doing'), 'stop');
});

testPage('a lost "stop" is repeated until the robot answers, and the page is red until then', openWithWalkingRobot, async (page) => {
  await dropLines(page, []);
  await pressEscapeAndAdvance(page, 600);
  assert.ok(await isStopping(page));
  assert.equal(await readText(page, '#doing'), 'walk', 'the robot has reported no other gait');
  await page.clock.runFor(700);
  await page.locator('#alarm', { hasText: /^No answer: the robot may still walk\. The page repeats "stop" until the robot answers\. 1\.\d s$/ }).waitFor();
  await restoreLink(page);
  await runUntil(page, 'the stop is answered', async () => (await page.locator('#log div', { hasText: /^ok stop$/ }).count()) > 0);
  await page.clock.runFor(100);
  assert.equal(await readText(page, '#doing'), 'stop');
  assert.equal(await isStopping(page), false);
  assert.equal(await page.locator('#alarm').isVisible(), false);
});

testPage('a robot that rests gets no repeated "stop"', openWithBoard, async (page) => {
  await sendToBoard(page, 'rest');
  const receivedLength = (await readTextReceivedByBoard(page)).length;
  await pressEscapeAndAdvance(page, 1500);
  const sentLines = (await readTextReceivedByBoard(page)).slice(receivedLength).split('\n');
  assert.equal(sentLines.filter((line) => line === 'stop').length, 1);
  assert.equal(await isStopping(page), false);
});

testPage('a refusal that the radio has truncated is not mistaken for the answer to "stop"', openWithWalkingRobot, async (page) => {
  await dropLines(page, ['stop']);
  await page.keyboard.press('Escape');
  await page.evaluate(() => {
    for (const character of 'err 7 the servos are resting; senok walk\r\n') window.attachedBoard.onByte(character.charCodeAt(0));
  });
  await page.clock.runFor(600);
  assert.ok(await isStopping(page));
  await restoreLink(page);
  await runUntil(page, 'the stop is answered', async () => !(await isStopping(page)));
});

testPage('answers to repeated stops are not mistaken for answers to the next lines', openWithWalkingRobot, async (page) => {
  await delayReceivedLines(page, 1000);
  await pressEscapeAndAdvance(page, 1100);
  assert.ok((await readTextReceivedByBoard(page)).split('stop').length > 4, '"stop" was sent again');
  await findGaitButton(page, 'left').click();
  await waitForText(page, '#doing', /^left$/);
  await pressEscapeAndAdvance(page, 3000);
  assert.equal(await readText(page, '#doing'), 'stop');
});

testPage('the page reports a silence of 0.8 s with its duration', openWithWalkingRobot, async (page) => {
  await dropLines(page, []);
  await page.evaluate(() => (window.attachedBoard.onByte = () => {}));
  await page.clock.runFor(600);
  assert.equal(await page.locator('#alarm').isVisible(), false);
  await page.clock.runFor(1700);
  await page.locator('#alarm', { hasText: /^No answer from the robot\. [12]\.\d s$/ }).waitFor();
  await page.locator('#age', { hasText: /^[12]\.\d s ago$/ }).waitFor();
});

testPage('a gait that ended during a silence is shown as ended', openWithWalkingRobot, async (page) => {
  await page.evaluate(() => {
    const board = window.attachedBoard;
    const { onByte } = board;
    board.onByte = () => {};
    board.send([...'stop\n'].map((character) => character.charCodeAt(0)));
    setTimeout(() => (board.onByte = onByte), 2000);
  });
  await page.clock.runFor(4000);
  assert.equal(await readText(page, '#doing'), 'stop');
});

testPage('"stop" is repeated for the simulated UNO, too', openStanding, async (page) => {
  await clickAndAdvance(page, '#gaits button[data-command="walk"]', 400);
  await page.evaluate(() => {
    const { board } = window.lizard.board.link;
    const { send } = board;
    let sendCount = 0;
    board.send = (bytes) => (++sendCount > 5 ? send.call(board, bytes) : undefined);
  });
  await page.keyboard.press('Escape');
  await advance(page, 2500);
  assert.equal(await readText(page, '#doing'), 'stop');
});

/** Records the times between the lines that the board receives, ms of page time. */
const recordLineGaps = (page) =>
  page.evaluate(() => {
    const arrivalTimesMs = [];
    const { onReceived } = window.attachedBoard;
    window.attachedBoard.onReceived = (byte, cycle) => {
      onReceived(byte, cycle);
      if (byte === 10) arrivalTimesMs.push(performance.now());
    };
    window.readLineGapsMs = () => arrivalTimesMs.slice(1).map((time, n) => time - arrivalTimesMs[n]);
  });

/** Advances the clock by `ms`; returns true if a servo turns meanwhile: if a pulse width changes by more than 1 us. */
async function runAndDetectMovement(page, ms) {
  const observedWidths = [];
  for (let remainingMs = ms; remainingMs > 0; remainingMs -= 20) {
    // The LED's pin belongs to no servo.
    observedWidths.push(await page.evaluate(() => window.lizard.robot.description.servos.map(({ pin }) => window.pulseWidthsUs[pin])));
    await page.clock.runFor(20);
  }
  return observedWidths.some((widths) => widths.some((width, servo) => Math.abs(width - observedWidths[0][servo]) > 1));
}

testPage('while a user drives, the page sets deadman to 901 ms and sends at least three lines in that time', openWithWalkingRobot, async (page) => {
  const lines = (await readTextReceivedByBoard(page)).split('\n');
  assert.ok(lines.indexOf('deadman 901') > 0 && lines.indexOf('deadman 901') < lines.indexOf('walk'), 'deadman is set before the walk');
  await recordLineGaps(page);
  await page.clock.runFor(5000);
  const longestGap = Math.max(...(await page.evaluate(() => window.readLineGapsMs())));
  assert.ok(longestGap <= 310, `longest time without a line: ${longestGap} ms`);
  assert.equal(await readText(page, '#doing'), 'walk');
  assert.ok(!(await readText(page, '#log')).includes('deadman 901'), 'the log does not show the page\'s own lines');
});

testPage('a robot out of range stops, and reports the reason when it is in range again', openWithWalkingRobot, async (page) => {
  assert.ok(await runAndDetectMovement(page, 500));
  await dropLines(page, []);
  await page.clock.runFor(901 + 40);
  assert.equal(await runAndDetectMovement(page, 500), false);
  await restoreLink(page);
  await page.clock.runFor(3000);
  assert.equal(await readText(page, '#doing'), 'stop');
  await page.locator('#log div', { hasText: '# fault: no command within the deadman time' }).waitFor();
  await page.locator('#problems', { hasText: 'The robot has stopped by itself' }).getByRole('button', { name: 'Dismiss' }).click();
  await page.clock.runFor(2000);
  assert.equal(await page.locator('#problems').isVisible(), false, 'a fault is reported once');
});

testPage('stopping the robot restores its own deadman', openWithBoard, async (page) => {
  await sendToBoard(page, 'deadman 5000');
  await findGaitButton(page, 'walk').click();
  await page.clock.runFor(1500);
  // The robot's own setting is saved, not the page's.
  await sendToBoard(page, 'save');
  await sendToBoard(page, 'cal');
  await page.locator('#log div', { hasText: /^# deadman 5000$/ }).waitFor();
  assert.equal(await readText(page, '#doing'), 'walk');
  await pressEscapeAndAdvance(page, 1500);
  assert.match(await readTextReceivedByBoard(page), /deadman 901\n[^]*save\n[^]*deadman 901\n[^]*stop\n[^]*deadman 5000\n(status\n)*$/);
});

testPage('a board gets its own deadman back after a walk in which its settings were replaced', openWithWalkingRobot, async (page) => {
  await sendToBoard(page, 'factory');
  await page.clock.runFor(1000);
  await pressEscapeAndAdvance(page, 1000);
  assert.match(await readTextReceivedByBoard(page), /\nfactory\n[^]*\ndeadman 0\n/);
});

testPage('the page sets deadman again if it reads the settings before a walk is answered', openWithBoard, async (page) => {
  await page.evaluate(() => {
    const { attachedBoard, lizard } = window;
    const { send } = attachedBoard;
    attachedBoard.send = (bytes) => {
      send.call(attachedBoard, bytes);
      if (String.fromCharCode(...bytes) === 'walk\n') void lizard.board.ask('cal', true);
    };
  });
  await startWalk(page);
  await page.clock.runFor(1000);
  assert.match(await readTextReceivedByBoard(page), /\nwalk\n[^]*deadman 0\ncal\n[^]*deadman 901\n/);
});

/** Drops the robot's lines that begin with `start`. */
const dropReceivedLines = (page, start) =>
  page.evaluate((start) => {
    const { attachedBoard } = window;
    const { onByte } = attachedBoard;
    window.originalOnByte ??= onByte;
    let line = [];
    attachedBoard.onByte = (byte) => {
      line.push(byte);
      if (byte !== 10) return;
      if (!String.fromCharCode(...line).startsWith(start)) line.forEach(onByte);
      line = [];
    };
  }, start);

/** Delays the robot's lines by `ms`. */
const delayReceivedLines = (page, ms) =>
  page.evaluate((ms) => {
    const { attachedBoard } = window;
    const { onByte } = attachedBoard;
    // The port may be closed meanwhile.
    attachedBoard.onByte = (byte) => void new Promise((resolve) => setTimeout(resolve, ms, byte)).then(onByte).catch(() => {});
  }, ms);

testPage('a walk whose answer is lost keeps its deadman until it ends', openWithBoard, async (page) => {
  await dropReceivedLines(page, 'ok walk');
  await findGaitButton(page, 'walk').click();
  await waitForText(page, '#problems', /no answer to "walk"/);
  await waitForText(page, '#doing', /^walk$/);
  await page.clock.runFor(1000);
  assert.doesNotMatch(await readTextReceivedByBoard(page), /\nwalk\n[^]*deadman 0\n/);
  await pressEscapeAndAdvance(page, 1000);
  assert.match(await readTextReceivedByBoard(page), /\nstop\n[^]*deadman 0\n/);
});

testPage('a gait that only the board\'s robot has keeps the page\'s deadman', () => openWithBoard('own-gaits'), async (page) => {
  await sendToBoard(page, 'stride');
  await page.clock.runFor(2000);
  assert.equal(await readGait(page), 'stride');
  assert.doesNotMatch(await readTextReceivedByBoard(page), /\nstride\n[^]*deadman 0\n/);
  await dropLines(page, []);
  await page.clock.runFor(901 + 40);
  assert.equal(await runAndDetectMovement(page, 500), false);
});

testPage('a walking robot gets the page\'s deadman again if the link lost it after the settings were read', openWithWalkingRobot, async (page) => {
  await dropLines(page, ['deadman 901']);
  await page.evaluate(() => void window.lizard.board.ask('cal', true));
  await page.clock.runFor(3500);
  await restoreLink(page);
  // A line without an answer is sent again after three seconds.
  await page.clock.runFor(5000);
  assert.ok(await runAndDetectMovement(page, 500));
  await dropLines(page, []);
  await page.clock.runFor(901 + 40);
  assert.equal(await runAndDetectMovement(page, 500), false);
});

const BLUETOOTH_SERVICE = '00001101-0000-1000-8000-00805f9b34fb';
/** Opens the page with a board whose settings the page has not read, because no set-up opens for a radio. */
const openWithUnreadBoard = () => openWithBoard('robot', 4000, { boardKeepsRunning: true, bluetoothService: BLUETOOTH_SERVICE });

/** Opens the page with such a board, in which a page that was closed during a walk has left its `deadman`. */
async function openWithLeftBoard() {
  const page = await openWithUnreadBoard();
  await page.evaluate(() => window.attachedBoard.send([...'deadman 901\n'].map((character) => character.charCodeAt(0))));
  await page.clock.runFor(500);
  return page;
}

testPage('a deadman left behind by a page is not mistaken for the robot\'s own', openWithLeftBoard, async (page) => {
  await findGaitButton(page, 'walk').click();
  await page.clock.runFor(1000);
  await pressEscapeAndAdvance(page, 1000);
  assert.match(await readTextReceivedByBoard(page), /stop\n[^]*deadman 0\n(status\n)*$/);
});

testPage('a deadman left behind by a page is not saved', openWithLeftBoard, async (page) => {
  await sendToBoard(page, 'save');
  assert.match(await readTextReceivedByBoard(page), /deadman 901\n[^]*deadman 0\n(status\n)*save\n/);
});

testPage('no gait starts while the robot\'s own deadman is unknown, because it could not be restored', openWithUnreadBoard, async (page) => {
  await dropReceivedLines(page, '# deadman');
  await findGaitButton(page, 'walk').click();
  await waitForText(page, '#problems', /"walk" was not sent, because the robot did not confirm its deadman setting/);
  assert.doesNotMatch(await readTextReceivedByBoard(page), /deadman|walk/);
});

testPage('a lost line that restores the robot\'s own deadman is sent again', openWithWalkingRobot, async (page) => {
  await dropLines(page, ['deadman 0']);
  await pressEscapeAndAdvance(page, 4500);
  await restoreLink(page);
  await page.clock.runFor(4000);
  assert.match(await readTextReceivedByBoard(page), /stop\n[^]*deadman 0\n/);
});

testPage('the robot gets its own deadman back after a second stop', openWithWalkingRobot, async (page) => {
  await delayReceivedLines(page, 600);
  await pressEscapeAndAdvance(page, 700);
  await pressEscapeAndAdvance(page, 5000);
  assert.match(await readTextReceivedByBoard(page), /stop\n[^]*deadman 0\n/);
});

testPage('a second stop does not drop the pace that a released stick restores', openWithBoard, async (page) => {
  await sendToBoard(page, 'speed 50');
  await page.evaluate(() => ['stop', 'speed 100', 'stop'].forEach((line) => void window.lizard.board.drive(line)));
  await page.clock.runFor(2000);
  assert.match(await readTextReceivedByBoard(page), /stop\n[^]*speed 100\n/);
});

testPage('nothing is saved until the robot has confirmed its own deadman', openWithWalkingRobot, async (page) => {
  // The answer to the last repetition of the page's own line arrives after the lost line.
  await delayReceivedLines(page, 400);
  await runUntil(page, 'the page repeats its line after a status', async () => (await readTextReceivedByBoard(page)).endsWith('status\ndeadman 901\n'), 20);
  await dropLines(page, ['deadman 0']);
  await page.evaluate(() => void window.lizard.board.ask('save'));
  await page.clock.runFor(4500);
  assert.doesNotMatch(await readTextReceivedByBoard(page), /save/);
  assert.match(await readText(page, '#problems'), /"save" was not sent, because the robot did not confirm its own deadman setting\./);
  await restoreLink(page);
  await page.clock.runFor(4000);
  await page.evaluate(() => void window.lizard.board.ask('save'));
  await page.clock.runFor(2000);
  assert.match(await readTextReceivedByBoard(page), /deadman 0\n(status\n)*save\n/);
});

testPage('a deadman that the user has set is restored even if its answer was lost', openWithWalkingRobot, async (page) => {
  await pressEscapeAndAdvance(page, 1500);
  await dropReceivedLines(page, 'ok deadman 5000');
  await page.evaluate(() => void window.lizard.board.ask('deadman 5000'));
  await waitForText(page, '#problems', /no answer to "deadman 5000"/);
  await page.evaluate(() => (window.attachedBoard.onByte = window.originalOnByte));
  await startWalk(page);
  await pressEscapeAndAdvance(page, 1500);
  assert.match(await readTextReceivedByBoard(page), /deadman 901\n[^]*stop\n[^]*deadman 5000\n(status\n)*$/);
});

testPage('a robot that the page leaves over a slow link gets its own deadman back', openWithWalkingRobot, async (page) => {
  await delayReceivedLines(page, 300);
  await page.locator('#connect').click();
  await waitForText(page, '#where', /simulated UNO/);
  assert.match(await readTextReceivedByBoard(page), /stop\n[^]*deadman 0\n$/);
});

test('the page treats an HC-05 at a serial port with 9600 baud as a radio', async () => {
  const page = await openWithBoard('robot', 0, { boardKeepsRunning: true, moduleBaud: 9600, bluetoothService: BLUETOOTH_SERVICE });
  await waitForText(page, '#where', /^on a board on Bluetooth that has not restarted/);
  assert.deepEqual(await page.evaluate(() => window.portRequest.allowedBluetoothServiceClassIds), [BLUETOOTH_SERVICE]);
  assert.match(await readTextReceivedByBoard(page), /^(status\n)+watch 10\n/, 'the page does not wait for a reset');
  const baudRate = await page.evaluate(() => window.attachedBoard.uno.usart.baudRate);
  assert.ok(Math.abs(baudRate / 9600 - 1) < 0.03, `the chip has not found the baud rate: ${baudRate} baud`);
  assert.ok(await page.locator('#flash-write').isDisabled());
  await startWalk(page);
  await page.keyboard.press('Escape');
  await waitForText(page, '#doing', /^stop$/);
});

testPage('a hidden page stops the robot', openWithWalkingRobot, async (page) => {
  await hidePage(page);
  await page.clock.runFor(500);
  assert.equal(await readGait(page), 'stop');
});

testPage('a gait that waits for the confirmation of deadman does not start on a hidden page', openWithBoard, async (page) => {
  await findGaitButton(page, 'walk').click();
  await hidePage(page);
  await page.clock.runFor(3000);
  assert.doesNotMatch(await readTextReceivedByBoard(page), /^walk$/m);
  assert.equal(await readGait(page), 'stop');
});

testPage('no gait starts on a hidden page', openWithBoard, async (page) => {
  await hidePage(page);
  await page.evaluate(() => void window.lizard.board.drive('walk'));
  await page.clock.runFor(3000);
  assert.doesNotMatch(await readTextReceivedByBoard(page), /^walk$/m);
  assert.match(await readText(page, '#problems'), /"walk" was not sent, because the page is hidden\./);
});

/** Resets the board as a power failure does: the boot loader starts the program at once. */
const cutSupply = (page) => page.evaluate(() => window.attachedBoard.reset('power'));

testPage('a gait that waits for an answer does not start after a restart of the robot', openWithWalkingRobot, async (page) => {
  await dropLines(page, ['trim']);
  await page.evaluate(() => void window.lizard.board.ask('trim 1 1'));
  await findGaitButton(page, 'left').click();
  await cutSupply(page);
  await page.clock.runFor(3500);
  assert.doesNotMatch(await readTextReceivedByBoard(page), /^left$/m);
  assert.equal(await readGait(page), 'stand');
});

testPage('after a restart of a walking robot, the page sends no line that would cancel its boot action', openWithWalkingRobot, async (page) => {
  await cutSupply(page);
  await page.clock.runFor(3500);
  assert.equal(await readGait(page), 'stand');
  assert.doesNotMatch(await readTextReceivedByBoard(page), /^deadman 0$/m);
});

testPage('a gait that waits for the confirmation of deadman does not start after a restart of the robot', openWithBoard, async (page) => {
  await dropLines(page, ['cal']);
  await findGaitButton(page, 'walk').click();
  await cutSupply(page);
  await page.clock.runFor(4500);
  assert.doesNotMatch(await readTextReceivedByBoard(page), /^walk$/m);
  assert.equal(await readGait(page), 'stand');
});

testPage('after a lost confirmation of deadman, the next press of a gait starts it', openWithBoard, async (page) => {
  // Another sender has started the robot.
  await page.evaluate(() => window.attachedBoard.send([...'walk\n'].map((character) => character.charCodeAt(0))));
  await waitForText(page, '#doing', /^walk$/);
  await dropLines(page, ['deadman']);
  await findGaitButton(page, 'left').click();
  await waitForText(page, '#problems', /"left" was not sent, because the robot did not confirm its deadman setting/);
  await restoreLink(page);
  await findGaitButton(page, 'left').click();
  await page.clock.runFor(5000);
  assert.equal(await readText(page, '#doing'), 'left');
});

testPage('a hidden page stops sending the lines that keep a robot walking', openWithWalkingRobot, async (page) => {
  await dropLines(page, ['stop']);
  await hidePage(page);
  await page.clock.runFor(3000);
  assert.equal(await runAndDetectMovement(page, 500), false);
});
