// The robot alone is written after the firmware that a board has.
import assert from 'node:assert/strict';
import { after, afterEach, before, test } from 'node:test';

import { openWithBoard, until } from './board.js';
import { close, closePages, complaints, open, openStanding, page, text, unfold } from './browser.js';
import { fakeSerial } from './fake-serial.js';
import { imageOf } from './image.js';

before(open);
afterEach(closePages);
after(close);

const START = 0x6e00;
const flash = async (opened, from, to) => Buffer.from(await opened.evaluate(([from, to]) => Array.from(window.otherBoard.flash.subarray(from, to)), [from, to]));
const section = async (name) => Buffer.from((await imageOf(name)).subarray(START));
/** Waits until this message is shown below a panel's buttons. */
const waitForMessage = (opened, what, of = '#flash-said') => until(opened, `${what} is said`, async () => what.test(await text(opened, of)));
const robotAlone = (opened) => opened.locator('#flash-robot').click();

/** Servo pins that had a pulse; the LED's pin does not count. */
const pulsedPins = (opened) => opened.evaluate(() => window.lizard.description.servos.map(({ pin }) => pin).filter((pin) => pin in window.pulses));

async function openPanel(opened) {
  await unfold(opened, '#flash');
  return opened;
}

test('a robot is written in a second or two, and firmware and saved settings stay unchanged', async () => {
  const opened = await openPanel(await openWithBoard('large', 8000));
  await opened.evaluate(() => window.lizard.ask('trim 1 2').then(() => window.lizard.ask('save')) && null);
  await opened.clock.runFor(1500);
  const code = await flash(opened, 0, START);
  const saved = await opened.evaluate(() => Array.from(window.otherBoard.eeprom));
  assert.ok(saved.some((byte) => byte !== 0xff), 'something is saved');
  await robotAlone(opened);
  await waitForMessage(opened, /^written and verified in [\d.]+ s$/);
  const seconds = Number(/in ([\d.]+) s/.exec(await text(opened, '#flash-said'))[1]);
  assert.ok(seconds > 0.5 && seconds < 2.5, `${seconds} s`);
  await until(opened, 'it greets', async () => /^on a board on USB, robot paper [0-9a-f]{8}$/.test(await text(opened, '#where')));
  const wanted = await section('robot');
  assert.deepEqual(await flash(opened, START, START + wanted.length), wanted);
  assert.deepEqual(await flash(opened, 0, START), code);
  assert.deepEqual(await opened.evaluate(() => Array.from(window.otherBoard.eeprom)), saved);
});

test('an edited gait is written to a board, and the board walks it', async () => {
  const opened = await openWithBoard('robot', 8000);
  await unfold(opened, '#gait-editor');
  await opened.waitForFunction(() => /mm$/.test(document.querySelector('#gait-way').textContent));
  await opened.locator('#gait-name').fill('stride');
  await opened.waitForFunction(() => document.querySelector('#gait-table').textContent.startsWith('[gait.stride]'));
  await opened.locator('#gait-write').click();
  await waitForMessage(opened, /^written and verified in [\d.]+ s\. The board has restarted; stride is a button of Drive\.$/, '#gait-said');
  await opened.clock.runFor(3000);
  assert.equal(await text(opened, '#doing'), 'stand', 'a board does not walk by itself');
  await opened.evaluate(() => (window.pulses = {}));
  await opened.locator('#gaits button[data-command="stride"]').click();
  const place = () => opened.evaluate(() => window.lizard.last.place.y);
  const before = await place();
  await until(opened, 'the robot of the page has gone 5 mm', async () => (await place()) - before > 5);
  assert.ok(await opened.evaluate(() => window.heard.includes('stride\n')));
});

test('one button writes an edited text to the board', async () => {
  const opened = await openWithBoard('robot', 8000);
  await unfold(opened, '#robot-editor');
  const toml = (await opened.locator('#robot-text').inputValue()).replace('name = "paper"', 'name = "mine"').replace('period = 1.25', 'period = 1.5');
  await opened.locator('#robot-text').fill(toml);
  await opened.locator('#robot-write').click();
  await waitForMessage(opened, /^written and verified in [\d.]+ s$/, '#robot-said');
  await until(opened, 'it greets', async () => /^on a board on USB, robot mine [0-9a-f]{8}$/.test(await text(opened, '#where')));
});

test('without a board the buttons say what is missing', async () => {
  const opened = await openStanding();
  await unfold(opened, '#robot-editor');
  await opened.locator('#robot-write').click();
  await opened.locator('#robot-said', { hasText: 'No board is connected: Connect a board…' }).waitFor();
});

test('behind a firmware that reads another format no robot is written, and the firmware goes on', async () => {
  const opened = await openPanel(await openWithBoard('large', 8000));
  // The format in the mark after the 26 interrupt vectors.
  await opened.evaluate(() => (window.otherBoard.flash[26 * 4 + 4] ^= 0x40));
  const before = await flash(opened, 0, 0x7e00);
  await robotAlone(opened);
  await waitForMessage(opened, /^not written: the board has lizard [\d.]+ robot large [0-9a-f]{8}, whose robots are of format \d+; this robot is of format \d+: write the firmware, too\. Nothing was written$/);
  assert.deepEqual(await flash(opened, 0, 0x7e00), before);
  await until(opened, 'it goes on', async () => /^on a board on USB with another robot/.test(await text(opened, '#where')));
});

test('to a board that has not restarted the robot alone is written', async () => {
  const opened = await page({}, fakeSerial);
  await opened.evaluate(() => {
    window.awake = true;
    window.flashed = 'large';
  });
  await opened.locator('#connect').click();
  await opened.waitForFunction(() => window.otherBoard);
  await opened.clock.runFor(5000);
  assert.match(await text(opened, '#where'), /that has not restarted/);
  await opened.evaluate(() => (window.awake = false));
  await openPanel(opened);
  await robotAlone(opened);
  await waitForMessage(opened, /^written and verified in [\d.]+ s$/);
  const wanted = await section('robot');
  assert.deepEqual(await flash(opened, START, START + wanted.length), wanted);
});

test('a board unplugged during a write has no robot, reports that, moves nothing, and can be written again', async () => {
  const opened = await openPanel(await openWithBoard('large', 8000));
  await robotAlone(opened);
  // Some of its twenty pages, which take 17 ms each.
  await until(opened, 'it is written', async () => (await text(opened, '#flash-said')).startsWith('writing'), 20);
  await opened.clock.runFor(60);
  await opened.evaluate(() => window.unplug());
  await waitForMessage(opened, /^not written: .*\. The board has half a robot now: its firmware says fault=robot and moves no servo\. Write it again$/);
  await until(opened, 'it may be connected', () => opened.locator('#connect').isEnabled());
  await opened.evaluate(() => (window.same = true));
  await opened.locator('#connect').click();
  await until(opened, 'it greets', async () => (await text(opened, '#where')) === 'on a board on USB with this firmware and no robot in it: write this one');
  await opened.clock.runFor(5000);
  assert.deepEqual(await pulsedPins(opened), []);
  await opened.locator('#log div', { hasText: '# fault: no robot in the flash, write one' }).first().waitFor();
  await opened.locator('#setup').getByText('has this firmware and no robot, so it moves nothing.').waitFor();
  await robotAlone(opened);
  await waitForMessage(opened, /^written and verified in [\d.]+ s$/);
  await until(opened, 'it stands', async () => (await pulsedPins(opened)).length === 4);
});

test('a board that is written right after its banner is asked nothing', async () => {
  const opened = await openPanel(await openWithBoard('robot', 2000));
  assert.match(await text(opened, '#where'), /^on a board on USB, robot paper /);
  await opened.locator('#flash-write').click();
  await opened.clock.runFor(4000);
  assert.match(await text(opened, '#flash-said'), /^(read|writ|verify)ing/);
  assert.equal(await opened.locator('#trouble').innerText(), '');
});

test('a board unplugged while the firmware is written does nothing, and can be written again', async () => {
  const opened = await openPanel(await openWithBoard('large', 8000));
  assert.equal((await pulsedPins(opened)).length, 4, 'it stands');
  await opened.locator('#flash-write').click();
  await until(opened, 'it is written', async () => (await text(opened, '#flash-said')).startsWith('writing'), 20);
  await opened.clock.runFor(60);
  await opened.evaluate(() => window.unplug());
  await waitForMessage(opened, /^not written: .*\. The board has half a program now, and does nothing\. Its boot loader is still there: write it again$/);
  // Its own behaviour, without the page.
  const pulses = await opened.evaluate(() => {
    window.otherBoard.reset('external');
    window.pulses = {};
    window.otherBoard.run(16_000 * 5000);
    return window.pulses;
  });
  // The boot loader itself blinks its LED.
  assert.deepEqual(Object.keys(pulses).filter((pin) => pin !== '13'), []);
  assert.deepEqual(await flash(opened, 0, 4), Buffer.from([0xff, 0xcf, 0xff, 0xff]));
  await until(opened, 'it may be connected', () => opened.locator('#connect').isEnabled());
  await opened.evaluate(() => (window.same = true));
  await opened.locator('#connect').click();
  await until(opened, 'it is named', async () => /without this firmware$/.test(await text(opened, '#where')));
  await opened.locator('#flash-write').click();
  await waitForMessage(opened, /^written and verified in [\d.]+ s$/);
  const wanted = Buffer.from(await imageOf('robot'));
  assert.deepEqual(await flash(opened, 0, wanted.length), wanted);
});

test('the browser reported no error or warning', () => assert.deepEqual(complaints, []));

test('a board without this firmware is refused a robot alone, and what it has is named', async () => {
  const opened = await page({}, fakeSerial);
  await opened.evaluate(() => (window.flashed = null));
  await opened.locator('#connect').click();
  await until(opened, 'it is named', async () => /without this firmware$/.test(await text(opened, '#where')));
  await openPanel(opened);
  await robotAlone(opened);
  await waitForMessage(opened, /^not written: the board has no program, and a robot alone moves nothing: write the firmware, too\. Nothing was written$/);
});

test('an older Nano, whose boot loader has another baud rate, is found, written and started', async () => {
  const opened = await page({}, fakeSerial);
  await opened.evaluate(() => Object.assign(window, { flashed: null, loaderBaud: 57_600, vendor: 0x1a86 }));
  await opened.locator('#connect').click();
  await until(opened, 'it is named', async () => (await text(opened, '#trouble')).startsWith('The board is an Arduino Nano, an ATmega328P by its boot loader'));
  await openPanel(opened);
  await opened.locator('#flash-write').click();
  await waitForMessage(opened, /^no answer; the board is called again/);
  await waitForMessage(opened, /^written and verified in [\d.]+ s$/);
  const wanted = Buffer.from(await imageOf('robot'));
  assert.deepEqual(await flash(opened, 0, wanted.length), wanted);
  await until(opened, 'it greets', async () => /^on a board on USB, robot paper [0-9a-f]{8}$/.test(await text(opened, '#where')));
});

test('pages that the board has already are not written', async () => {
  const opened = await openPanel(await openWithBoard('robot', 8000));
  const seconds = async () => {
    await opened.locator('#flash-write').click();
    await waitForMessage(opened, /^reading/);
    await waitForMessage(opened, /^written and verified in [\d.]+ s$/);
    await opened.clock.runFor(3000);
    return Number(/in ([\d.]+) s/.exec(await text(opened, '#flash-said'))[1]);
  };
  const same = await seconds();
  await opened.evaluate(() => window.otherBoard.flash.fill(0x12, 0, 0x7e00));
  const whole = await seconds();
  assert.ok(same < 6 && whole > same + 5, `${same} s and ${whole} s`);
});

test('an image that would overwrite a Nano\'s boot loader is written only after the user confirms a UNO', async () => {
  const opened = await openWithBoard('robot', 8000);
  await opened.evaluate(() => (window.vendor = 0x1a86));
  await opened.locator('#robot').selectOption('own-gaits');
  await openPanel(opened);
  const before = await flash(opened, 0, 0x7e00);
  const asked = [];
  let says = 'dismiss';
  opened.on('dialog', (dialog) => {
    asked.push(dialog.message());
    void dialog[says]();
  });
  await robotAlone(opened);
  await waitForMessage(opened, /^not written: 3\d{4} bytes of flash are needed, and a Nano has 30720 before its boot section\. Gaits can be left out/);
  assert.match(asked[0], /^Is this board an Arduino UNO\? By its USB chip it may also be a Nano/);
  assert.deepEqual(await flash(opened, 0, 0x7e00), before, 'nothing was written');
  says = 'accept';
  await robotAlone(opened);
  await waitForMessage(opened, /^written and verified in [\d.]+ s$/);
  const wanted = await section('own-gaits');
  assert.deepEqual(await flash(opened, START, START + wanted.length), wanted);
  assert.equal(asked.length, 2);
  // A small robot does not reach so far, so nobody is asked.
  await opened.locator('#robot').selectOption('robot');
  await opened.clock.runFor(3000);
  await robotAlone(opened);
  await waitForMessage(opened, /^written and verified in [\d.]+ s$/);
  assert.equal(asked.length, 2);
});
