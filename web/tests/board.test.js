// A board on USB: the page identifies it, follows it through changes and resets, and stops it before leaving it.
import assert from 'node:assert/strict';

import { readText, unfold, useBrowser, chooseRobot, testPage, readPlace, findGaitButton } from './browser.js';
import { openWithBoard, openWithDeafBoard, openWithErasedBoard, runUntil, waitForText } from './board.js';

useBrowser();

/** Waits until at least `count` lines of the log match `pattern`. */
const waitForLine = (page, pattern, count = 1) =>
  runUntil(page, `${pattern} is logged ${count} times`, async () => (await page.locator('#log div', { hasText: pattern }).count()) >= count);

async function openWithWalkingBoard() {
  const page = await openWithBoard('robot', 4000);
  await findGaitButton(page, 'walk').click();
  await waitForLine(page, /^ok walk$/);
  return page;
}

testPage('the page identifies a new UNO, and one button writes its firmware', openWithErasedBoard, async (page) => {
  await page.locator('#problems', { hasText: 'The board is an Arduino UNO, an ATmega328P according to its boot loader, without this firmware.' }).waitFor();
  assert.equal(await readText(page, '#where'), 'on a board on USB without this firmware');
  await page.getByRole('button', { name: 'Write firmware and robot to it' }).click();
  await page.locator('#flash-message', { hasText: 'calling the boot loader' }).waitFor();
  for (const control of ['#robot', '#connect', '#reset']) {
    assert.ok(await page.locator(control).isDisabled(), `${control} would take the port from the boot loader`);
  }
  await waitForText(page, '#flash-message', /^written and verified in [\d.]+ s$/);
  await page.clock.runFor(8000);
  assert.match(await readText(page, '#where'), /^on a board on USB, robot paper [0-9a-f]{8}$/);
  for (const control of ['#robot', '#connect']) assert.ok(await page.locator(control).isEnabled(), control);
  assert.equal(await page.locator('#problems').isVisible(), false, 'the board sends its banner, so the problem is solved');
  await page.locator('#log div', { hasText: 'ok watch 2' }).first().waitFor();
});

testPage('for a board that does not answer, the page asks whether it is a UNO or a Nano', openWithDeafBoard, async (page) => {
  await waitForText(page, '#problems', /no boot loader answers\. Is it a UNO or a Nano\?/);
  assert.ok(await page.locator('#problems').isVisible());
});

testPage('a port stays closed after the user has left a board that is still being identified', openWithDeafBoard, async (page) => {
  await page.evaluate(() => {
    window.openCount = 0;
    window.onPortOpen = () => (window.openCount += 1);
  });
  const readOpenCount = () => page.evaluate(() => window.openCount);
  await runUntil(page, 'the page tries another baud rate', async () => (await readOpenCount()) > 0);
  await page.locator('#connect').click();
  await waitForText(page, '#where', /simulated UNO/);
  const openCount = await readOpenCount();
  await page.clock.runFor(5000);
  assert.equal(await readOpenCount(), openCount);
});

testPage('the page queries and tracks a board that its port does not reset', () => openWithBoard('robot', 5000, { boardKeepsRunning: true }), async (page) => {
  await page.locator('#log div', { hasText: 'ok watch 2' }).waitFor();
  assert.match(await readText(page, '#where'), /^on a board on USB that has not restarted/);
  assert.equal(await readText(page, '#doing'), 'stand');
  assert.equal(await page.locator('#problems').isVisible(), false);
});

testPage('choosing another robot keeps the board connected', openWithWalkingBoard, async (page) => {
  await chooseRobot(page, 'large');
  assert.match(await readText(page, '#where'), /^on a board on USB with another robot, robot paper [0-9a-f]{8}: choose that robot, or write this robot$/);
  await page.locator('#connect', { hasText: 'Back to the simulation' }).waitFor();
  await chooseRobot(page, 'robot');
  assert.match(await readText(page, '#where'), /^on a board on USB, robot paper [0-9a-f]{8}$/);
  await page.clock.runFor(500);
  assert.ok(await page.evaluate(() => window.lizard.board.isReal && window.lizard.robot.last.place.y > 1), 'the robot is tracked');
});

testPage('the page reports a board with another robot, and one press shows that robot', () => openWithBoard('large'), async (page) => {
  const offer = page.locator('#problems').getByRole('button', { name: 'Show large' });
  await offer.waitFor();
  assert.match(await readText(page, '#problems'), /^The board on USB has another robot, large, but the page draws and predicts robot\.toml\./);
  await offer.click();
  await page.waitForFunction(() => window.lizard.robot.file === 'large' && window.lizard.program.hasThisRobot);
  assert.match(await readText(page, '#where'), /^on a board on USB, robot large [0-9a-f]{8}$/);
  await page.locator('#problems', { hasText: 'another robot' }).waitFor({ state: 'detached' });
  assert.equal(await page.evaluate(() => window.lizard.board.isReal), true);
  // From here on, no file of the page has this robot.
  await page.evaluate(() => window.lizard.robot.change(window.lizard.robot.toml.replace('name = "large"', 'name = "longer"').replace('period = 1.25', 'period = 1.3')).then(() => null));
  await page.locator('#problems', { hasText: 'but the page draws and predicts large.toml with your changes' }).waitFor();
  await page.evaluate(() => {
    const { lizard } = window;
    lizard.board.banner.robot.hash = '00000000';
    return lizard.robot.change(lizard.robot.toml.replace('period = 1.3', 'period = 1.35')).then(() => null);
  });
  await page.locator('#problems', { hasText: 'It is not among the page’s robots: open its robot.toml in Build, or write this robot.' }).waitFor();
});

testPage('the alarm for a board that is out of range ends when the board is gone', openWithBoard, async (page) => {
  await page.evaluate(() => {
    const { link } = window.lizard.board;
    link.onRange(false);
    link.onGone('The test has taken it away.');
  });
  await page.waitForFunction(() => !window.lizard.board.isReal);
  assert.equal(await page.locator('#alarm').isHidden(), true);
});

testPage('disconnecting a board stops it', openWithWalkingBoard, async (page) => {
  await page.locator('#connect').click();
  await page.clock.runFor(1500);
  await page.locator('#log div', { hasText: /^ok stop$/ }).waitFor();
  assert.match(await page.evaluate(() => window.receivedText), /\nstop\n(deadman 0\n)?$/, 'the last lines from the page');
  assert.match(await readText(page, '#where'), /simulated UNO/);
});

testPage('a gait that is pressed while the page leaves a board is not sent', openWithWalkingBoard, async (page) => {
  await page.evaluate(() => {
    const { attachedBoard } = window;
    const { send } = attachedBoard;
    window.sentText = '';
    attachedBoard.send = (bytes) => {
      window.sentText += String.fromCharCode(...bytes);
      send.call(attachedBoard, bytes);
    };
    for (const selector of ['#connect', '#gaits button[data-command="left"]']) document.querySelector(selector).click();
  });
  await waitForText(page, '#where', /simulated UNO/);
  assert.match(await page.evaluate(() => window.sentText), /stop\n(deadman 0\n)?$/);
});

testPage('pressing Back to the simulation again while the port is closing has no effect', openWithWalkingBoard, async (page) => {
  await page.evaluate(async () => {
    const port = await navigator.serial.requestPort();
    const { close } = port;
    port.close = async () => {
      document.querySelector('#connect').click();
      await close();
    };
  });
  await page.locator('#connect').click();
  await waitForText(page, '#where', /simulated UNO/);
  await page.clock.runFor(500);
  assert.equal(await page.locator('#problems').isVisible(), false);
});

testPage('the simulated UNO has the robot that was changed while the port was closing', openWithWalkingBoard, async (page) => {
  await page.evaluate(async () => {
    const port = await navigator.serial.requestPort();
    const { close } = port;
    port.close = async () => {
      const { lizard } = window;
      await lizard.robot.change(lizard.robot.toml.replace('name = "paper"', 'name = "mine"'));
      await close();
    };
  });
  await page.locator('#connect').click();
  await waitForText(page, '#where', /^on a simulated UNO/);
  assert.match(await readText(page, '#where'), /^on a simulated UNO, robot mine /);
});

testPage('a trim that is set while the settings are read stays on the screen', openWithBoard, async (page) => {
  await unfold(page, '#calibrate');
  const trim = page.locator('#calibration fieldset').first().getByLabel('trim');
  await runUntil(page, 'the trim is read', () => trim.isVisible());
  await page.locator('#cal-read').click();
  await trim.fill('0.5');
  await page.clock.runFor(3000);
  assert.equal(await trim.inputValue(), '0.5');
});

testPage('the panel of the calibration shows the settings of a board after its restart', openWithBoard, async (page) => {
  await unfold(page, '#calibrate');
  const trim = page.locator('#calibration fieldset').first().getByLabel('trim');
  await runUntil(page, 'the trim is read', () => trim.isVisible());
  await trim.fill('5');
  await waitForLine(page, /^ok trim 1 5/);
  await page.evaluate(() => window.attachedBoard.reset('external'));
  await runUntil(page, 'the trim is read again', async () => (await trim.inputValue()) === '0');
});

testPage('the page reports a board that does not confirm the stop', openWithWalkingBoard, async (page) => {
  await page.evaluate(() => (window.attachedBoard.send = () => {}));
  await page.locator('#connect').click();
  await page.clock.runFor(3000);
  await page.locator('#problems', { hasText: 'did not confirm its stop' }).waitFor();
});

testPage('closing the page stops a walking board, and the browser asks for confirmation', openWithWalkingBoard, async (page) => {
  const dialogEvent = page.waitForEvent('dialog');
  // This call returns only after the dialog is answered.
  const reload = page.evaluate(() => location.reload());
  const dialog = await dialogEvent;
  assert.equal(dialog.type(), 'beforeunload');
  await dialog.dismiss();
  await reload;
  await page.clock.runFor(1000);
  await page.locator('#log div', { hasText: /^ok stop$/ }).waitFor();
});

testPage('the page tracks the board again after a reset', openWithWalkingBoard, async (page) => {
  const watchCount = await page.locator('#log div', { hasText: /^ok watch 2$/ }).count();
  await page.locator('#reset').click();
  await waitForLine(page, /^ok watch 2$/, watchCount + 1);
  await findGaitButton(page, 'walk').click();
  await waitForLine(page, /^ok walk$/, 2);
  const { y: startY } = await readPlace(page);
  await runUntil(page, 'the page\'s robot has walked 5 mm', async () => (await readPlace(page)).y - startY > 5);
});

testPage('the page again tracks a board that restarted during an answer', () => openWithBoard('robot', 4000), async (page) => {
  await waitForLine(page, /^ok watch 2$/);
  // The page asks for the status twice a second.
  await page.evaluate(() => {
    const board = window.attachedBoard;
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
  await waitForLine(page, /^ok watch 2$/, 2);
});

testPage('the page shows no pulses for a board that does not report them', () => openWithBoard('robot', 5000), async (page) => {
  await unfold(page, '#pulses');
  await page.clock.runFor(500);
  assert.deepEqual(await page.locator('#widths td:nth-child(3)').allInnerTexts(), ['–', '–', '–', '–']);
  await page.getByText('A real board does not show its pulses here.').waitFor();
});

testPage('a HEX file of another program is written only after the user confirms', openWithBoard, async (page) => {
  await unfold(page, '#flash');
  // A program that loops forever: rjmp .-2.
  const loopHex = ':02000000FFCF30\n:00000001FF\n';
  const chooseFile = () =>
    page.getByLabel('HEX file').setInputFiles({ name: 'blink.hex', mimeType: 'text/plain', buffer: Buffer.from(loopHex) });
  await chooseFile();
  const question = page.locator('#flash-question-text', { hasText: 'blink.hex, 2 bytes. It is not this firmware' });
  await question.waitFor();
  const readFirstByte = () => page.evaluate(() => window.attachedBoard.flash[0]);
  const firstByte = await readFirstByte();
  assert.notEqual(firstByte, 0xff);
  await page.clock.runFor(3000);
  assert.equal(await readFirstByte(), firstByte, 'nothing is written yet');
  await page.locator('#flash-no').click();
  assert.equal(await question.isVisible(), false);
  await chooseFile();
  await page.locator('#flash-yes').click();
  await waitForText(page, '#flash-message', /^(not )?written/);
  await page.clock.runFor(3000);
  await page.locator('#problems', { hasText: 'sends no banner: the written program is not this firmware.' }).waitFor();
  await page.getByRole('button', { name: 'Write firmware and robot to it' }).waitFor();
  await page.locator('#setup-steps button', { hasText: 'Firmware' }).click();
  await page.locator('#setup', { hasText: 'The board on USB is a UNO according to its boot loader, without this firmware.' }).waitFor();
});

testPage('the page clears a board\'s refusal when the board is gone', openWithBoard, async (page) => {
  await page.evaluate(() => void window.lizard.board.drive('pose 0 0 0 0'));
  await waitForText(page, '#drive-message', /^pose 0 0 0 0: /);
  await page.evaluate(() => window.unplug());
  await waitForText(page, '#where', /simulated UNO/);
  assert.equal(await readText(page, '#drive-message'), '');
});
