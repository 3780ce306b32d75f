// A link that loses lines: the robot stops when it is told to, and the page shows only what the robot has reported.
import assert from 'node:assert/strict';
import { after, afterEach, before, test } from 'node:test';

import { openWithBoard, until } from './board.js';
import { advance, close, closePages, complaints, open, openStanding, page, text } from './browser.js';
import { fakeSerial } from './fake-serial.js';

before(open);
afterEach(closePages);
after(close);

const receivedText = (opened) => opened.evaluate(() => window.heard);
const isStopping = (opened) => opened.evaluate(() => document.body.classList.contains('stopping'));

/** Drops lines of the page that contain one of these words; all lines for an empty list. */
const dropLines = (opened, words) =>
  opened.evaluate((words) => {
    const board = window.otherBoard;
    window.send ??= board.send;
    window.lost = 0;
    board.send = (bytes) => {
      const text = String.fromCharCode(...bytes);
      if (words.length > 0 && !words.some((word) => text.includes(word))) return window.send.call(board, bytes);
      window.lost += 1;
    };
  }, words);
const dropNothing = (opened) => opened.evaluate(() => (window.otherBoard.send = window.send));

async function type(opened, line) {
  const answers = () => opened.locator('#log div', { hasText: `ok ${line}` }).count();
  const before = await answers();
  await opened.locator('#typed').fill(line);
  await opened.getByRole('button', { name: 'Send' }).click();
  await until(opened, `${line} is answered`, async () => (await answers()) > before);
  await opened.locator('#log').focus();
}

async function openWalking() {
  const opened = await openWithBoard('robot', 8000);
  await opened.locator('#gaits button[data-command="walk"]').click();
  await until(opened, 'it walks', async () => (await text(opened, '#doing')) === 'walk');
  return opened;
}

test('stop goes out at once, and a line that waits behind a lost answer is not sent after it', async () => {
  const opened = await openWalking();
  await dropLines(opened, ['status']);
  await until(opened, 'a question has no answer', async () => (await opened.evaluate(() => window.lost)) > 0, 20);
  await opened.locator('#gaits button[data-command="left"]').click();
  const before = (await receivedText(opened)).length;
  await opened.keyboard.press('Escape');
  await opened.clock.runFor(40);
  assert.ok((await receivedText(opened)).slice(before).startsWith('stop\n'));
  await opened.clock.runFor(4000);
  assert.ok(!(await receivedText(opened)).slice(before).includes('left'), 'it does not go on after stop');
  assert.equal(await text(opened, '#doing'), 'stop');
});

test('a lost stop is sent again until it is answered, and the page is red until then', async () => {
  const opened = await openWalking();
  await dropLines(opened, []);
  await opened.keyboard.press('Escape');
  await opened.clock.runFor(600);
  assert.ok(await isStopping(opened));
  assert.equal(await text(opened, '#doing'), 'walk', 'the robot has not said anything else');
  await opened.clock.runFor(700);
  await opened.locator('#alarm', { hasText: /^No answer: it may walk on\. "stop" is sent until it answers\. 1\.\d s$/ }).waitFor();
  await dropNothing(opened);
  await until(opened, 'it is answered', async () => (await opened.locator('#log div', { hasText: /^ok stop$/ }).count()) > 0);
  await opened.clock.runFor(100);
  assert.equal(await text(opened, '#doing'), 'stop');
  assert.equal(await isStopping(opened), false);
  assert.equal(await opened.locator('#alarm').isVisible(), false);
});

test('a robot that rests is not asked to stop again', async () => {
  const opened = await openWithBoard('robot', 8000);
  await type(opened, 'rest');
  const before = (await receivedText(opened)).length;
  await opened.keyboard.press('Escape');
  await opened.clock.runFor(1500);
  const sent = (await receivedText(opened)).slice(before).split('\n');
  assert.equal(sent.filter((line) => line === 'stop').length, 1);
  assert.equal(await isStopping(opened), false);
});

test('a refusal that a radio has cut off is no answer to stop', async () => {
  const opened = await openWalking();
  await dropLines(opened, ['stop']);
  await opened.keyboard.press('Escape');
  await opened.evaluate(() => {
    for (const letter of 'err 7 servos are resting, senok walk\r\n') window.otherBoard.onByte(letter.charCodeAt(0));
  });
  await opened.clock.runFor(600);
  assert.ok(await isStopping(opened));
  await dropNothing(opened);
  await until(opened, 'it is answered', async () => !(await isStopping(opened)));
});

test('answers to repeated stops are not taken for answers to the next lines', async () => {
  const opened = await openWalking();
  await opened.evaluate(() => {
    const board = window.otherBoard;
    const { onByte } = board;
    // The robot's lines arrive a second late.
    board.onByte = (byte) => setTimeout(() => onByte(byte), 1000);
  });
  await opened.keyboard.press('Escape');
  await opened.clock.runFor(1100);
  assert.ok((await receivedText(opened)).split('stop').length > 4, 'it was sent again');
  await opened.locator('#gaits button[data-command="left"]').click();
  await until(opened, 'it turns', async () => (await text(opened, '#doing')) === 'left');
  await opened.keyboard.press('Escape');
  await opened.clock.runFor(3000);
  assert.equal(await text(opened, '#doing'), 'stop');
});

test('a robot that is silent for 0.8 s is reported, with the time', async () => {
  const opened = await openWalking();
  await dropLines(opened, []);
  await opened.evaluate(() => (window.otherBoard.onByte = () => {}));
  await opened.clock.runFor(700);
  await opened.clock.runFor(1600);
  await opened.locator('#alarm', { hasText: /^No answer from the robot\. [12]\.\d s$/ }).waitFor();
  await opened.locator('#age', { hasText: /^[12]\.\d s ago$/ }).waitFor();
});

test('a gait that ended during a silence is shown as ended', async () => {
  const opened = await openWalking();
  await opened.evaluate(() => {
    const board = window.otherBoard;
    const { onByte } = board;
    board.onByte = () => {};
    board.send([...'stop\n'].map((letter) => letter.charCodeAt(0)));
    setTimeout(() => (board.onByte = onByte), 2000);
  });
  await opened.clock.runFor(4000);
  assert.equal(await text(opened, '#doing'), 'stop');
});

test('the simulated UNO is stopped in the same way', async () => {
  const opened = await openStanding();
  await opened.locator('#gaits button[data-command="walk"]').click();
  await advance(opened, 400);
  await opened.evaluate(() => {
    const { board } = window.lizard.link;
    const { send } = board;
    let lost = 0;
    board.send = (bytes) => (++lost > 5 ? send.call(board, bytes) : undefined);
  });
  await opened.keyboard.press('Escape');
  await advance(opened, 2500);
  assert.equal(await text(opened, '#doing'), 'stop');
});

/** Times between the ends of lines that the board received, ms of page time. */
const recordGaps = (opened) =>
  opened.evaluate(() => {
    const at = [];
    const { onReceived } = window.otherBoard;
    window.otherBoard.onReceived = (byte, cycle) => {
      onReceived(byte, cycle);
      if (byte === 10) at.push(performance.now());
    };
    window.gaps = () => at.slice(1).map((time, n) => time - at[n]);
  });

/** True if a servo turns within some ms, that is, if a pulse changes by more than 1 us. */
async function isMoving(opened, ms) {
  const seen = [];
  for (let left = ms; left > 0; left -= 20) {
    // The LED's pin belongs to no servo.
    seen.push(await opened.evaluate(() => window.lizard.description.servos.map(({ pin }) => window.pulses[pin])));
    await opened.clock.runFor(20);
  }
  return seen.some((widths) => widths.some((width, servo) => Math.abs(width - seen[0][servo]) > 1));
}

test('while a user drives, deadman is set, and a line is sent within every third of it', async () => {
  const opened = await openWalking();
  const lines = (await receivedText(opened)).split('\n');
  assert.ok(lines.indexOf('deadman 901') > 0 && lines.indexOf('deadman 901') < lines.indexOf('walk'), 'before it walks');
  await recordGaps(opened);
  await opened.clock.runFor(5000);
  const longest = Math.max(...(await opened.evaluate(() => window.gaps())));
  assert.ok(longest <= 310, `${longest} ms without a line`);
  assert.equal(await text(opened, '#doing'), 'walk');
  assert.ok(!(await text(opened, '#log')).includes('deadman 901'), 'it is not shown');
});

test('a robot out of reach stands still, and reports why when it is in reach again', async () => {
  const opened = await openWalking();
  assert.ok(await isMoving(opened, 500));
  await dropLines(opened, []);
  await opened.clock.runFor(901 + 40);
  assert.equal(await isMoving(opened, 500), false);
  await dropNothing(opened);
  await opened.clock.runFor(3000);
  assert.equal(await text(opened, '#doing'), 'stop');
  await opened.locator('#log div', { hasText: '# fault: no line for as long as deadman says' }).waitFor();
});

test('stopping the robot restores its own deadman', async () => {
  const opened = await openWithBoard('robot', 8000);
  await type(opened, 'deadman 5000');
  await opened.locator('#gaits button[data-command="walk"]').click();
  await opened.clock.runFor(1500);
  // The robot's own setting is saved.
  await type(opened, 'save');
  await type(opened, 'cal');
  await opened.locator('#log div', { hasText: /^# deadman 5000$/ }).waitFor();
  assert.equal(await text(opened, '#doing'), 'walk');
  await opened.keyboard.press('Escape');
  await opened.clock.runFor(1500);
  assert.match(await receivedText(opened), /deadman 901\n[^]*save\n[^]*deadman 901\n[^]*stop\n[^]*deadman 5000\n(status\n)*$/);
});

test('a deadman left behind by a page is not taken for the robot\'s own', async () => {
  const opened = await openWithBoard('robot', 8000);
  await opened.evaluate(() => window.otherBoard.send([...'deadman 901\n'].map((letter) => letter.charCodeAt(0))));
  await opened.clock.runFor(500);
  await opened.locator('#gaits button[data-command="walk"]').click();
  await opened.clock.runFor(1000);
  await opened.keyboard.press('Escape');
  await opened.clock.runFor(1000);
  assert.match(await receivedText(opened), /stop\n[^]*deadman 0\n(status\n)*$/);
});

test('an HC-05 at 9600 baud, which the system knows as a serial port, is driven as a radio', async () => {
  const opened = await page({}, fakeSerial);
  const serialProfile = '00001101-0000-1000-8000-00805f9b34fb';
  await opened.evaluate((profile) => Object.assign(window, { awake: true, baud: 9600, profile }), serialProfile);
  await opened.locator('#connect').click();
  await opened.waitForFunction(() => window.otherBoard);
  await until(opened, 'it is found', async () => (await text(opened, '#where')).startsWith('on a board on Bluetooth that has not restarted'));
  assert.deepEqual(await opened.evaluate(() => window.wanted.allowedBluetoothServiceClassIds), [serialProfile]);
  assert.match(await receivedText(opened), /^(status\n)+watch 10\n/, 'it is not waited for a reset');
  const rate = await opened.evaluate(() => window.otherBoard.uno.usart.baudRate);
  assert.ok(Math.abs(rate / 9600 - 1) < 0.03, `the chip has found the rate: ${rate} baud`);
  assert.ok(await opened.locator('#flash-write').isDisabled());
  await opened.locator('#gaits button[data-command="walk"]').click();
  await until(opened, 'it walks', async () => (await text(opened, '#doing')) === 'walk');
  await opened.keyboard.press('Escape');
  await until(opened, 'it stops', async () => (await text(opened, '#doing')) === 'stop');
});

test('a hidden page releases the robot', async () => {
  const opened = await openWalking();
  await opened.evaluate(() => {
    Object.defineProperty(document, 'hidden', { value: true });
    document.dispatchEvent(new Event('visibilitychange'));
  });
  await opened.clock.runFor(500);
  assert.equal(await opened.evaluate(() => window.lizard.gait), 'stop');
});

test('a hidden page stops sending the lines that keep a robot walking', async () => {
  const opened = await openWalking();
  await dropLines(opened, ['stop']);
  await opened.evaluate(() => {
    Object.defineProperty(document, 'hidden', { value: true });
    document.dispatchEvent(new Event('visibilitychange'));
  });
  await opened.clock.runFor(3000);
  assert.equal(await isMoving(opened, 500), false);
});

test('the browser reported no error or warning', () => assert.deepEqual(complaints, []));
