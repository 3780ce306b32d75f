// A board on USB that is new, has another firmware, or is left while it walks.
import assert from 'node:assert/strict';
import { after, afterEach, before, test } from 'node:test';

import { close, closePages, complaints, open, page, text, unfold } from './browser.js';
import { openWithBoard, until } from './board.js';
import { fakeSerial } from './fake-serial.js';

before(open);
afterEach(closePages);
after(close);


/** Waits until the console has `times` lines with this text. */
const waitForLine = (opened, line, times = 1) =>
  until(opened, `${line} is said ${times} times`, async () => (await opened.locator('#log div', { hasText: line }).count()) >= times);

async function openWalking() {
  const opened = await openWithBoard('robot', 4000);
  await opened.locator('#gaits button[data-command="walk"]').click();
  await waitForLine(opened, /^ok walk$/);
  return opened;
}

test('a new UNO is identified after some seconds, and one button writes the firmware', async () => {
  const opened = await openWithBoard(null, 8000);
  await opened.locator('#trouble', { hasText: 'The board is an Arduino UNO, an ATmega328P by its boot loader, and this firmware is not on it.' }).waitFor();
  assert.equal(await text(opened, '#where'), 'on a board on USB without this firmware');
  await opened.getByRole('button', { name: 'Write firmware and robot to it' }).click();
  await opened.locator('#flash-said', { hasText: 'calling the boot loader' }).waitFor();
  for (const control of ['#robot', '#connect']) {
    assert.ok(await opened.locator(control).isDisabled(), `${control} would take the line away from the boot loader`);
  }
  await until(opened, 'it is written', async () => /^written and verified in [\d.]+ s$/.test(await text(opened, '#flash-said')));
  await opened.clock.runFor(8000);
  assert.match(await text(opened, '#where'), /^on a board on USB, robot paper [0-9a-f]{8}$/);
  for (const control of ['#robot', '#connect']) assert.ok(await opened.locator(control).isEnabled(), control);
  assert.equal(await opened.locator('#trouble').isVisible(), false, 'it greets: the trouble is over');
  await opened.locator('#log div', { hasText: 'ok watch 2' }).first().waitFor();
});

test('a board that does not answer leads to a question about it', async () => {
  const opened = await page({}, fakeSerial);
  await opened.evaluate(() => (window.flashed = null));
  await opened.locator('#connect').click();
  await opened.waitForFunction(() => window.otherBoard);
  await opened.evaluate(() => (window.otherBoard.send = () => {}));
  await opened.clock.runFor(9000);
  await opened.locator('#trouble', { hasText: 'no boot loader answers. Is it a UNO or a Nano?' }).waitFor();
});

test('a board that its port does not reset is asked for its state and tracked', async () => {
  const opened = await page({}, fakeSerial);
  await opened.evaluate(() => (window.awake = true));
  await opened.locator('#connect').click();
  await opened.waitForFunction(() => window.otherBoard);
  await opened.clock.runFor(5000);
  await opened.locator('#log div', { hasText: 'ok watch 2' }).waitFor();
  assert.match(await text(opened, '#where'), /^on a board on USB that has not restarted/);
  assert.equal(await text(opened, '#doing'), 'stand');
  assert.equal(await opened.locator('#trouble').isVisible(), false);
});

test('a robot is chosen for a board that is connected, and the board stays', async () => {
  const opened = await openWalking();
  await opened.locator('#robot').selectOption('large');
  await opened.waitForFunction(() => window.lizard.file === 'large');
  assert.match(await text(opened, '#where'), /^on a board on USB with another robot, robot paper [0-9a-f]{8}: choose that one, or write this one$/);
  await opened.locator('#connect', { hasText: 'Back to the simulation' }).waitFor();
  await opened.locator('#robot').selectOption('robot');
  await opened.waitForFunction(() => window.lizard.file === 'robot');
  assert.match(await text(opened, '#where'), /^on a board on USB, robot paper [0-9a-f]{8}$/);
  await opened.clock.runFor(500);
  assert.ok(await opened.evaluate(() => window.lizard.isReal && window.lizard.last.place.y > 1), 'it is still followed');
});

test('a board with another robot of the list is reported, and one press shows its own robot', async () => {
  const opened = await openWithBoard('large', 8000);
  const offer = opened.locator('#trouble').getByRole('button', { name: 'Show large' });
  await offer.waitFor();
  assert.match(await text(opened, '#trouble'), /^The board on USB has another robot, large, and is drawn and predicted here as robot\.toml\./);
  await offer.click();
  await opened.waitForFunction(() => window.lizard.file === 'large' && window.lizard.hasThisRobot);
  assert.match(await text(opened, '#where'), /^on a board on USB, robot large [0-9a-f]{8}$/);
  await opened.locator('#trouble', { hasText: 'another robot' }).waitFor({ state: 'detached' });
  assert.equal(await opened.evaluate(() => window.lizard.isReal), true);
  // No file has its lengths any more.
  await opened.evaluate(() => window.lizard.change(window.lizard.toml.replace('name = "large"', 'name = "longer"').replace('period = 1.25', 'period = 1.3')).then(() => null));
  await opened.locator('#trouble', { hasText: 'is drawn and predicted here as large.toml with your changes' }).waitFor();
  await opened.evaluate(() => {
    const { lizard } = window;
    lizard.boardBanner.robot.hash = '00000000';
    return lizard.change(lizard.toml.replace('period = 1.3', 'period = 1.35')).then(() => null);
  });
  await opened.locator('#trouble', { hasText: 'This page does not know it: open its robot.toml in Build, or write this one.' }).waitFor();
});

test('disconnecting a board stops it', async () => {
  const opened = await openWalking();
  await opened.locator('#connect').click();
  await opened.clock.runFor(1500);
  await opened.locator('#log div', { hasText: /^ok stop$/ }).waitFor();
  assert.match(await opened.evaluate(() => window.heard), /\nstop\n(deadman 0\n)?$/, 'the last that the board has heard');
  assert.match(await text(opened, '#where'), /simulated UNO/);
});

test('a board that does not confirm the stop is reported', async () => {
  const opened = await openWalking();
  await opened.evaluate(() => (window.otherBoard.send = () => {}));
  await opened.locator('#connect').click();
  await opened.clock.runFor(3000);
  await opened.locator('#trouble', { hasText: 'did not say that it stops' }).waitFor();
});

test('a page that is closed while a board walks stops it, and the browser asks', async () => {
  const opened = await openWalking();
  const asked = opened.waitForEvent('dialog');
  // The browser's answer belongs to the dialog and comes after it.
  const left = opened.evaluate(() => location.reload());
  const dialog = await asked;
  assert.equal(dialog.type(), 'beforeunload');
  await dialog.dismiss();
  await left;
  await opened.clock.runFor(1000);
  await opened.locator('#log div', { hasText: /^ok stop$/ }).waitFor();
});

test('after a reset the board is tracked again', async () => {
  const opened = await openWalking();
  const followed = await opened.locator('#log div', { hasText: /^ok watch 2$/ }).count();
  await opened.locator('#reset').click();
  await waitForLine(opened, /^ok watch 2$/, followed + 1);
  const place = () => opened.evaluate(() => window.lizard.last.place.y);
  await opened.locator('#gaits button[data-command="walk"]').click();
  await waitForLine(opened, /^ok walk$/, 2);
  const before = await place();
  await until(opened, 'the robot of the page has gone 5 mm', async () => (await place()) - before > 5);
});

test('a board that restarts in the middle of an answer is tracked again', async () => {
  const opened = await openWithBoard('robot', 4000);
  await waitForLine(opened, /^ok watch 2$/);
  // The page asks for the status twice a second.
  await opened.evaluate(() => {
    const board = window.otherBoard;
    const { onByte } = board;
    let answer = '';
    board.onByte = (byte) => {
      onByte(byte);
      answer += String.fromCharCode(byte);
      if (!answer.endsWith('ok gait=')) return;
      board.onByte = onByte;
      setTimeout(() => board.reset('external'));
    };
  });
  await waitForLine(opened, /^ok watch 2$/, 2);
});

test('pulses are not invented for a board that does not show them', async () => {
  const opened = await openWithBoard('robot', 5000);
  await unfold(opened, '#pulses');
  await opened.clock.runFor(500);
  const cells = await opened.locator('#widths td:nth-child(3)').allInnerTexts();
  assert.deepEqual(cells, ['–', '–', '–', '–']);
  await opened.getByText('A board on USB does not show its pulses here.').waitFor();
});

test('a HEX file of another program is identified, and written only when the user confirms', async () => {
  const opened = await openWithBoard('robot', 8000);
  await unfold(opened, '#flash');
  // A program that loops forever: rjmp .-2.
  const blink = ':02000000FFCF30\n:00000001FF\n';
  const choose = () =>
    opened.getByLabel('HEX file').setInputFiles({ name: 'blink.hex', mimeType: 'text/plain', buffer: Buffer.from(blink) });
  await choose();
  const question = opened.locator('#flash-what', { hasText: 'blink.hex, 2 bytes. It is not this firmware' });
  await question.waitFor();
  const flash = () => opened.evaluate(() => window.otherBoard.flash[0]);
  const first = await flash();
  assert.notEqual(first, 0xff);
  await opened.clock.runFor(3000);
  assert.equal(await flash(), first, 'nothing is written yet');
  await opened.locator('#flash-no').click();
  assert.equal(await question.isVisible(), false);
  await choose();
  await opened.locator('#flash-yes').click();
  await until(opened, 'it is written', async () => /^(not )?written/.test(await text(opened, '#flash-said')));
  await opened.clock.runFor(3000);
  await opened.locator('#trouble', { hasText: 'is not this firmware: it sends no banner.' }).waitFor();
  await opened.getByRole('button', { name: 'Write firmware and robot to it' }).waitFor();
});

test('the browser reported no error or warning', () => assert.deepEqual(complaints, []));
