// Writing to a board: the robot's section alone, or firmware and robot, also after interruptions.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { openWithBoard, openWithDeafBoard, openWithErasedBoard, readFlash, runUntil, reconnect, waitForText } from './board.js';
import { openUnfolded, openPage, readText, unfold, useBrowser, chooseRobot, testPage, readPlace, findGaitButton } from './browser.js';
import { installFakeSerial } from './fake-serial.js';
import { makeImage, SECTION_START } from './flash-image.js';

useBrowser();

const makeSection = async (name) => Buffer.from((await makeImage(name)).subarray(SECTION_START));
/** Waits until a message is shown below the panel's buttons. */
const waitForMessage = (page, pattern) => waitForText(page, '#flash-message', pattern);

/** Presses a button of the panel, and waits until a message is shown. */
async function pressAndWait(page, button, pattern) {
  await page.locator(button).click();
  await waitForMessage(page, pattern);
}

/** Returns the servo pins that had a pulse; the LED's pin does not count. */
const listPulsedPins = (page) => page.evaluate(() => window.lizard.robot.description.servos.map(({ pin }) => pin).filter((pin) => pin in window.pulseWidthsUs));

/** Waits until a write has begun, and then for some pages of the flash, which take 17 ms each. */
async function waitUntilPartIsWritten(page) {
  await waitForText(page, '#flash-message', /^writing/, 20);
  await page.clock.runFor(60);
}

async function assertFlash(page, start, expected) {
  assert.deepEqual(await readFlash(page, start, start + expected.length), expected);
}

testPage('a robot is written within 2.5 s, and firmware and saved settings stay unchanged', () => openWithBoard('large'), async (page) => {
  await page.evaluate(() => window.lizard.board.ask('trim 1 2').then(() => window.lizard.board.ask('save')) && null);
  await page.clock.runFor(1500);
  const firmwareBytes = await readFlash(page, 0, SECTION_START);
  const savedEeprom = await page.evaluate(() => Array.from(window.attachedBoard.eeprom));
  assert.ok(savedEeprom.some((byte) => byte !== 0xff), 'settings are saved');
  await pressAndWait(page, '#flash-robot', /^written and verified in [\d.]+ s$/);
  const seconds = Number(/in ([\d.]+) s/.exec(await readText(page, '#flash-message'))[1]);
  assert.ok(seconds > 0.5 && seconds < 2.5, `${seconds} s`);
  await waitForText(page, '#where', /^on a board on USB, robot paper [0-9a-f]{8}$/);
  await assertFlash(page, SECTION_START, await makeSection('robot'));
  assert.deepEqual(await readFlash(page, 0, SECTION_START), firmwareBytes);
  assert.deepEqual(await page.evaluate(() => Array.from(window.attachedBoard.eeprom)), savedEeprom);
});

testPage('a banner that arrives together with the boot loader\'s last answer is read', () => openWithBoard('large'), async (page) => {
  await page.evaluate(() => {
    const board = window.attachedBoard;
    const deliver = board.onByte;
    const heldBytes = [];
    board.onByte = (byte) => {
      // The last command to the boot loader; the program starts after its answer.
      if (!window.receivedText.endsWith('Q ')) return deliver(byte);
      if (heldBytes.push(byte) > 1) return;
      setTimeout(() => {
        board.onByte = deliver;
        for (const heldByte of heldBytes) deliver(heldByte);
      }, 60);
    };
  });
  await pressAndWait(page, '#flash-robot', /^written and verified in [\d.]+ s$/);
  await page.clock.runFor(3000);
  assert.match(await readText(page, '#where'), /^on a board on USB, robot paper [0-9a-f]{8}$/);
  assert.match(await readText(page, '#flash-message'), /^written and verified in [\d.]+ s$/);
});

testPage('a board is written although the page has not identified it yet', () => openWithBoard(null, 500), async (page) => {
  await page.locator('#flash-write').click();
  // The page's clock stands still until the boot loader uses the line.
  await page.waitForFunction(() => window.lizard.board.dialogue.isClosed);
  await waitForMessage(page, /^(not )?written/);
  assert.match(await readText(page, '#flash-message'), /^written and verified in [\d.]+ s$/);
  await waitForText(page, '#where', /^on a board on USB, robot paper [0-9a-f]{8}$/);
  assert.equal(await page.locator('#problems').isVisible(), false);
});

testPage('no write begins while the page identifies a board', openWithDeafBoard, async (page) => {
  await runUntil(page, 'the page calls the boot loader', () => page.evaluate(() => window.lizard.board.dialogue.isClosed));
  await pressAndWait(page, '#flash-write', /^not written/);
  assert.match(await readText(page, '#flash-message'), /^not written: the page is already talking to the boot loader/);
  await waitForText(page, '#problems', /no boot loader answers/);
});

testPage('a foreign program that is replaced at once is not reported', openWithBoard, async (page) => {
  await unfold(page, '#flash');
  // A program that loops forever: rjmp .-2.
  const loopHex = ':02000000FFCF30\n:00000001FF\n';
  await page.getByLabel('HEX file').setInputFiles({ name: 'blink.hex', mimeType: 'text/plain', buffer: Buffer.from(loopHex) });
  await page.locator('#flash-yes').click();
  await waitForMessage(page, /^written and verified/);
  await pressAndWait(page, '#flash-write', /^reading/);
  await waitForMessage(page, /^written and verified/);
  await page.clock.runFor(3000);
  assert.match(await readText(page, '#flash-message'), /^written and verified in [\d.]+ s$/);
});

testPage('a board walks with an edited gait once the gait is written to it', openWithBoard, async (page) => {
  await unfold(page, '#gait-editor');
  await page.waitForFunction(() => /mm$/.test(document.querySelector('#gait-distance').textContent));
  await page.locator('#gait-name').fill('stride');
  await page.waitForFunction(() => document.querySelector('#gait-table').textContent.startsWith('[gait.stride]'));
  await page.locator('#gait-write').click();
  await waitForText(page, '#gait-message', /^written and verified in [\d.]+ s\. The board has restarted; stride has a button in Drive\.$/);
  await page.clock.runFor(3000);
  assert.equal(await readText(page, '#doing'), 'stand', 'a board does not walk by itself');
  await page.evaluate(() => (window.pulseWidthsUs = {}));
  await findGaitButton(page, 'stride').click();
  const { y: startY } = await readPlace(page);
  await runUntil(page, 'the page\'s robot has walked 5 mm', async () => (await readPlace(page)).y - startY > 5);
  assert.ok(await page.evaluate(() => window.receivedText.includes('stride\n')));
});

testPage('one button writes an edited text to the board', openWithBoard, async (page) => {
  await unfold(page, '#robot-editor');
  const toml = (await page.locator('#robot-text').inputValue()).replace('name = "paper"', 'name = "mine"').replace('period = 1.25', 'period = 1.5');
  await page.locator('#robot-text').fill(toml);
  await page.locator('#robot-write').click();
  await waitForText(page, '#robot-message', /^written and verified in [\d.]+ s$/);
  await waitForText(page, '#where', /^on a board on USB, robot mine [0-9a-f]{8}$/);
});

testPage('without a board, Write it to the board asks for a connection', () => openUnfolded('#robot-editor'), async (page) => {
  await page.locator('#robot-write').click();
  await page.locator('#robot-message', { hasText: 'No board is connected. Press “Connect a board…”' }).waitFor();
});

testPage('a robot whose format the firmware does not read is refused, and the firmware keeps running', () => openWithBoard('large'), async (page) => {
  // Changes the format in the mark after the 26 interrupt vectors.
  await page.evaluate(() => (window.attachedBoard.flash[26 * 4 + 4] ^= 0x40));
  const previousFlash = await readFlash(page, 0, 0x7e00);
  await pressAndWait(page, '#flash-robot', /^not written: the board has lizard [\d.]+ robot large [0-9a-f]{8}, which reads robots of format \d+; this robot has format \d+: write the firmware, too\. Nothing was written$/);
  assert.deepEqual(await readFlash(page, 0, 0x7e00), previousFlash);
  await waitForText(page, '#where', /^on a board on USB with another robot/);
});

testPage('the robot alone is written to a board that has not restarted', () => openWithBoard('large', 5000, { boardKeepsRunning: true }), async (page) => {
  assert.match(await readText(page, '#where'), /that has not restarted/);
  await page.evaluate(() => {
    window.boardKeepsRunning = false;
    window.attachedBoard.reset = () => {};
  });
  await pressAndWait(page, '#flash-robot', /^not written: no boot loader answers/);
  await waitForText(page, '#where', /that has not restarted/);
  await page.evaluate(() => delete window.attachedBoard.reset);
  await pressAndWait(page, '#flash-robot', /^written and verified in [\d.]+ s$/);
  await assertFlash(page, SECTION_START, await makeSection('robot'));
});

testPage('a board unplugged while its robot is written reports no robot, moves nothing, and can be written again', () => openWithBoard('large'), async (page) => {
  await page.locator('#flash-robot').click();
  await waitUntilPartIsWritten(page);
  await page.evaluate(() => window.unplug());
  await waitForMessage(page, /^not written: .*\. The board now has an incomplete robot: its firmware reports fault=robot and moves no servo\. Write the robot again$/);
  await reconnect(page);
  await runUntil(page, 'the board sends its banner', async () => (await readText(page, '#where')) === 'on a board on USB with this firmware but no robot: write this robot');
  await page.clock.runFor(5000);
  assert.deepEqual(await listPulsedPins(page), []);
  await page.locator('#log div', { hasText: '# fault: no robot in the flash; write one' }).first().waitFor();
  await page.locator('#setup').getByText('has this firmware but no robot; it moves nothing.').waitFor();
  await pressAndWait(page, '#flash-robot', /^written and verified in [\d.]+ s$/);
  await runUntil(page, 'the robot stands', async () => (await listPulsedPins(page)).length === 4);
});

testPage('the page does not disturb a write right after the banner', () => openWithBoard('robot', 2000), async (page) => {
  assert.match(await readText(page, '#where'), /^on a board on USB, robot paper /);
  await page.locator('#flash-write').click();
  await page.clock.runFor(4000);
  assert.match(await readText(page, '#flash-message'), /^(read|writ|verify)ing/);
  assert.equal(await page.locator('#problems').innerText(), '');
});

testPage('a board unplugged while the firmware is written does nothing, and can be written again', () => openWithBoard('large'), async (page) => {
  assert.equal((await listPulsedPins(page)).length, 4, 'the robot stands');
  await page.locator('#flash-write').click();
  await waitUntilPartIsWritten(page);
  await page.evaluate(() => window.unplug());
  await waitForMessage(page, /^not written: .*\. The board now has an incomplete program, which does nothing\. Its boot loader is intact: write the program again$/);
  // The board runs without the page.
  const pulses = await page.evaluate(() => {
    window.attachedBoard.reset('external');
    window.pulseWidthsUs = {};
    window.attachedBoard.run(16_000 * 5000);
    return window.pulseWidthsUs;
  });
  // The boot loader itself blinks its LED.
  assert.deepEqual(Object.keys(pulses).filter((pin) => pin !== '13'), []);
  assert.deepEqual(await readFlash(page, 0, 4), Buffer.from([0xff, 0xcf, 0xff, 0xff]));
  await reconnect(page);
  await waitForText(page, '#where', /without this firmware$/);
  await pressAndWait(page, '#flash-write', /^written and verified in [\d.]+ s$/);
  await assertFlash(page, 0, Buffer.from(await makeImage('robot')));
});

testPage('a robot alone is refused for a board without this firmware', openWithErasedBoard, async (page) => {
  await pressAndWait(page, '#flash-robot', /^not written: the board has no program, and a robot alone moves nothing: write the firmware, too\. Nothing was written$/);
});

test('an older Nano, whose boot loader has another baud rate, is found, written and started', async () => {
  const page = await openWithBoard(null, 0, { loaderBaud: 57_600, usbVendor: 0x1a86 });
  await runUntil(page, 'the board is identified', async () => (await readText(page, '#problems')).startsWith('The board is an Arduino Nano, an ATmega328P according to its boot loader'));
  await pressAndWait(page, '#flash-write', /^no answer; calling the boot loader again/);
  await waitForMessage(page, /^written and verified in [\d.]+ s$/);
  await assertFlash(page, 0, Buffer.from(await makeImage('robot')));
  await waitForText(page, '#where', /^on a board on USB, robot paper [0-9a-f]{8}$/);
});

testPage('the page reports an older Nano that is unplugged while its baud rate is set', () => openPage({}, installFakeSerial), async (page) => {
  await page.evaluate(() => {
    let openCount = 0;
    const onPortOpen = () => {
      if (openCount++ > 0) throw new Error('The device has been lost.');
    };
    Object.assign(window, { flashedRobot: null, loaderBaud: 57_600, onPortOpen });
  });
  await page.locator('#connect').click();
  await runUntil(page, 'the loss of the board is shown', async () => (await readText(page, '#problems')).startsWith('The board is gone: The device has been lost. The simulation continues.'));
  await runUntil(page, 'a board can be connected', () => page.locator('#connect').isEnabled());
  assert.match(await readText(page, '#where'), /simulated UNO/);
});

testPage('a write to the simulated UNO fails if the robot is changed meanwhile', () => openUnfolded('#flash'), async (page) => {
  const findMessage = (pattern) => page.locator('#flash-message', { hasText: pattern });
  await page.locator('#flash-write').click();
  await findMessage(/^reading/).waitFor();
  await page.evaluate(() => window.lizard.robot.change(window.lizard.robot.toml.replace('name = "paper"', 'name = "mine"')) && null);
  await findMessage(/^not written: the board is no longer connected\./).waitFor();
  assert.ok(await page.locator('#flash-write').isEnabled());
});

testPage('flash pages that already have the right bytes are not written', openWithBoard, async (page) => {
  const measureWrite = async () => {
    await pressAndWait(page, '#flash-write', /^reading/);
    await waitForMessage(page, /^written and verified in [\d.]+ s$/);
    await page.clock.runFor(3000);
    return Number(/in ([\d.]+) s/.exec(await readText(page, '#flash-message'))[1]);
  };
  const unchangedSeconds = await measureWrite();
  await page.evaluate(() => window.attachedBoard.flash.fill(0x12, 0, 0x7e00));
  const fullSeconds = await measureWrite();
  assert.ok(unchangedSeconds < 6 && fullSeconds > unchangedSeconds + 5, `unchanged: ${unchangedSeconds} s, full: ${fullSeconds} s`);
});

testPage('an image that would overwrite a Nano\'s boot loader is written only after the user confirms a UNO', openWithBoard, async (page) => {
  await page.evaluate(() => (window.usbVendor = 0x1a86));
  await chooseRobot(page, 'own-gaits');
  const previousFlash = await readFlash(page, 0, 0x7e00);
  const dialogMessages = [];
  let reply = 'dismiss';
  page.on('dialog', (dialog) => {
    dialogMessages.push(dialog.message());
    void dialog[reply]();
  });
  await pressAndWait(page, '#flash-robot', /^not written: 3\d{4} bytes of flash are needed, but a Nano has only 30720 before its boot section\. Remove gaits from robot/);
  assert.match(dialogMessages[0], /^Is this board an Arduino UNO\? Its USB chip is also used on the Nano/);
  assert.deepEqual(await readFlash(page, 0, 0x7e00), previousFlash, 'nothing was written');
  reply = 'accept';
  await pressAndWait(page, '#flash-robot', /^written and verified in [\d.]+ s$/);
  await assertFlash(page, SECTION_START, await makeSection('own-gaits'));
  assert.equal(dialogMessages.length, 2);
  // The section of a small robot ends below the Nano's boot loader, so no dialog opens.
  await chooseRobot(page, 'robot');
  await page.clock.runFor(3000);
  await pressAndWait(page, '#flash-robot', /^written and verified in [\d.]+ s$/);
  assert.equal(dialogMessages.length, 2);
});
