// A robot on Web Bluetooth: modules with their default settings, and failures of the link.
import assert from 'node:assert/strict';
import { afterEach, test } from 'node:test';

import { openBrowserWithBluetooth, openPage, readText, unfold, useBrowser, hidePage, testPage, readGait, findGaitButton } from './browser.js';
import { HM10, NORDIC, Radio } from './radio.js';

let radio;

useBrowser(openBrowserWithBluetooth);
afterEach(async () => {
  await radio?.close();
  radio = undefined;
});

const readPageMs = (page) => page.evaluate(() => performance.now());

/** Opens the page and picks a module that is in range. */
async function openPicked(module, options) {
  radio = await Radio.open(module, options);
  await radio.pick();
  return radio.page;
}

async function openWithWalkingRobot(module) {
  const page = await openPicked(module);
  await radio.runUntil('the robot is found', async () => (await readText(page, '#where')).includes(`board at ${module.name} that has not restarted`));
  await radio.runUntil('the robot stands', async () => (await readGait(page)) === 'stand');
  await findGaitButton(page, 'walk').click();
  await radio.runUntil('the robot walks', async () => (await readGait(page)) === 'walk');
  return page;
}

for (const module of [HM10, NORDIC]) {
  testPage(`a robot is driven and stopped through the module ${module.name}`, () => openWithWalkingRobot(module), async (page) => {
    await radio.run(3000);
    assert.equal(await readGait(page), 'walk', 'the page reports the walk');
    assert.ok((await readPageMs(page)) - (await page.evaluate(() => window.lastMoveMs)) < 100, 'its servos move');
    await page.keyboard.press('Escape');
    await radio.runUntil('the robot stops', async () => (await readGait(page)) === 'stop');
    assert.ok(Math.max(...radio.packetLengths) <= 20, 'packets have at most 20 bytes');
    const receivedText = await page.evaluate(() => window.receivedText);
    assert.ok(receivedText.indexOf('deadman 901\n') < receivedText.indexOf('walk\n'), receivedText);
    assert.match(receivedText, /OK\+CONN.*\n/);
    assert.equal(await page.locator('#problems').isVisible(), false);
    assert.equal(await page.locator('#setup').isVisible(), false, 'no dialog offers to write firmware by radio');
    for (const control of ['#flash-write', '#flash-robot', '#flash-file', '#reset']) assert.ok(await page.locator(control).isDisabled(), control);
  });
}

testPage('a robot whose link is cut stops, and the page reconnects by itself', () => openWithWalkingRobot(HM10), async (page) => {
  await radio.run(1000);
  const cutMs = await readPageMs(page);
  await radio.takeOutOfRange();
  await radio.runUntil('the loss of the link is shown', async () => (await readText(page, '#problems')).includes('The board at HMSoft is out of range.'));
  await radio.run(2000);
  assert.match(await readText(page, '#alarm'), /^No answer from the robot\. [23]\.\d s$/);
  const lastMoveMs = await page.evaluate(() => window.lastMoveMs);
  assert.ok(lastMoveMs - cutMs <= 901 + 40, `movement after the cut: ${lastMoveMs - cutMs} ms`);
  await radio.bringIntoRange();
  await radio.runUntil('the robot is stopped', async () => (await readGait(page)) === 'stop');
  await page.locator('#problems', { hasText: 'The robot has stopped by itself, because it received no line for too long.' }).waitFor();
  assert.ok(!(await readText(page, '#problems')).includes('out of range'));
  assert.equal(await page.locator('#alarm').isVisible(), false);
  await findGaitButton(page, 'walk').click();
  await radio.runUntil('the robot walks again', async () => (await readGait(page)) === 'walk');
});

testPage('the alarm remains if the module is back in range but its robot does not answer', () => openWithWalkingRobot(HM10), async (page) => {
  await page.evaluate(() => (window.attachedBoard.onByte = () => {}));
  await radio.run(1500);
  assert.ok(await page.locator('#alarm').isVisible());
  await radio.takeOutOfRange();
  const isOutOfRange = async () => (await readText(page, '#problems')).includes('out of range');
  await radio.runUntil('the loss of the link is shown', isOutOfRange);
  await radio.bringIntoRange();
  await radio.runUntil('the module is connected again', async () => !(await isOutOfRange()));
  assert.ok(await page.locator('#alarm').isVisible(), 'right after the reconnection');
  await radio.run(3000);
  assert.ok(await page.locator('#alarm').isVisible());
});

/** Walks the robot, and waits until the page's drawing of it has moved by 5 mm. */
async function assertFollowed(page) {
  const readForwardMm = () => page.evaluate(() => window.lizard.robot.last?.place.y ?? 0);
  const startMm = await readForwardMm();
  await findGaitButton(page, 'walk').click();
  await radio.runUntil('the drawing has moved by 5 mm', async () => (await readForwardMm()) - startMm > 5);
}

testPage('the page notices a restart whose banner the module has garbled, and follows the robot again', () => openWithWalkingRobot(HM10), async (page) => {
  const readRestartCount = () => page.evaluate(() => window.lizard.state.bannerCount.value);
  const restartCount = await readRestartCount();
  await radio.run(2000);
  await page.evaluate(() => window.attachedBoard.reset('external'));
  await radio.runUntil('the robot stands', async () => (await readGait(page)) === 'stand');
  assert.equal((await readRestartCount()) - restartCount, 1);
  await assertFollowed(page);
});

testPage('a robot that restarts while it walks gets its own deadman back, although the banner was garbled', () => openWithWalkingRobot(HM10), async (page) => {
  await page.evaluate(() => void window.lizard.board.ask('stop'));
  await radio.runUntil('the robot is stopped', async () => (await readGait(page)) === 'stop');
  await page.evaluate(() => void window.lizard.board.ask('deadman 2000'));
  await radio.run(1500);
  await page.evaluate(() => void window.lizard.board.ask('save'));
  await radio.run(1500);
  await findGaitButton(page, 'walk').click();
  await radio.runUntil('the robot walks', async () => (await readGait(page)) === 'walk');
  await radio.run(2000);
  await page.evaluate(() => {
    window.receivedText = '';
    window.attachedBoard.reset('external');
  });
  await radio.runUntil('the robot stands', async () => (await readGait(page)) === 'stand');
  await radio.run(2000);
  const lines = (await page.evaluate(() => window.receivedText)).match(/deadman \d+/g);
  assert.equal(lines?.at(-1), 'deadman 2000');
  assert.ok(!lines?.includes('deadman 0'), `${lines}`);
});

test('the page follows a robot although the first line that requests its poses was lost', async () => {
  radio = await Radio.open(HM10);
  const { page } = radio;
  await page.evaluate(() => {
    const { attachedBoard } = window;
    const { send } = attachedBoard;
    attachedBoard.send = (bytes) => {
      if (!String.fromCharCode(...bytes).includes('watch')) return send.call(attachedBoard, bytes);
      attachedBoard.send = send;
    };
  });
  await radio.pick();
  await radio.runUntil('the robot stands', async () => (await readGait(page)) === 'stand');
  await assertFollowed(page);
});

testPage('the page does not connect again to a module that it has left out of range', () => openWithWalkingRobot(HM10), async (page) => {
  await radio.takeOutOfRange();
  await radio.run(1000);
  await page.locator('#connect').click();
  await radio.runUntil('the board is left', async () => (await readText(page, '#where')).includes('simulated UNO'));
  await radio.bringIntoRange();
  await radio.run(1500);
  assert.equal(await page.evaluate(() => window.notifyingCharacteristic.service.device.gatt.connected), false);
});

testPage('after a failed attempt to reconnect, each byte is received once', () => openWithWalkingRobot(HM10), async (page) => {
  await radio.takeOutOfRange();
  await radio.run(1000);
  await page.evaluate(() => {
    const { prototype } = BluetoothRemoteGATTCharacteristic;
    const { startNotifications } = prototype;
    prototype.startNotifications = async () => {
      prototype.startNotifications = startNotifications;
      throw new Error('GATT operation failed');
    };
  });
  await radio.bringIntoRange();
  // If each byte were received twice, the page could not read any line of the robot.
  await radio.runUntil('the robot is stopped', async () => (await readGait(page)) === 'stop');
});

testPage('a trim that was set out of range returns to the robot\'s value when the robot answers again', () => openPicked(HM10), async (page) => {
  await radio.runUntil('the robot stands', async () => (await readGait(page)) === 'stand');
  await unfold(page, '#calibrate');
  const trim = page.locator('#calibration fieldset').first().getByLabel('trim');
  await radio.runUntil('the trim is read', () => trim.isVisible());
  await radio.takeOutOfRange();
  await trim.fill('5');
  await radio.run(4000);
  await page.locator('#problems', { hasText: 'the board at HMSoft is out of range.' }).waitFor();
  assert.equal(await trim.inputValue(), '5');
  await radio.bringIntoRange();
  await radio.runUntil('the trim is read again', async () => (await trim.inputValue()) === '0');
});

testPage('after a stop that is pressed out of range, "stop" is the first line that the robot receives', () => openWithWalkingRobot(HM10), async (page) => {
  await radio.takeOutOfRange();
  await radio.run(300);
  await page.keyboard.press('Escape');
  const previousLength = (await page.evaluate(() => window.receivedText)).length;
  await radio.run(1000);
  assert.ok(await page.evaluate(() => document.body.classList.contains('stopping')));
  await radio.bringIntoRange();
  await radio.runUntil('the stop is answered', async () => !(await page.evaluate(() => document.body.classList.contains('stopping'))));
  const lines = (await page.evaluate(() => window.receivedText)).slice(previousLength).split('\n');
  assert.equal(lines.find((line) => line !== '' && !line.startsWith('OK+')), 'stop', lines.join('|'));
});

testPage('the page names a module through which no robot answers', () => openPicked(HM10, { hasRobot: false }), async (page) => {
  await radio.runUntil('the silence is shown', async () => (await readText(page, '#problems')).includes('no robot answers'));
  assert.match(await readText(page, '#problems'), /The module is connected, but no robot answers from the board at HMSoft\. Check that the module's TXD is on D0/);
  assert.equal(await page.getByRole('button', { name: 'Write firmware and robot to it' }).count(), 0);
});

test('cancelling the choice of a Bluetooth module reports no problem', async () => {
  radio = await Radio.open(HM10);
  const { page } = radio;
  await radio.pick(false);
  await radio.run(500);
  assert.equal(await page.locator('#problems').isVisible(), false);
  assert.match(await readText(page, '#where'), /simulated UNO/);
});

test('the page reports a machine without Bluetooth', async () => {
  radio = await Radio.open(HM10, { adapterState: 'absent' });
  await radio.page.locator('#radio').click();
  await radio.page.locator('#problems', { hasText: 'No board is connected: Bluetooth is missing on this machine, or it is switched off.' }).waitFor();
});

test('the page names the setting that allows forbidden Bluetooth', async () => {
  radio = await Radio.open(HM10, { isBluetoothAllowed: false, hasRobot: false });
  const { page } = radio;
  await page.locator('#radio').click();
  await page.locator('#problems', { hasText: 'The browser may not use Bluetooth: allow it in the settings of the browser' }).waitFor();
  assert.match(await readText(page, '#problems'), /disallowed by permissions policy/, 'the browser itself has refused it');
});

testPage('a phone stops its robot when its screen goes off', () => openWithWalkingRobot(HM10), async (page) => {
  await radio.run(1000);
  await hidePage(page);
  const hiddenMs = await page.evaluate(() => window.readBoardMs());
  await radio.run(60);
  await radio.simulatePhoneSleep(3000);
  const [lastMoveMs, receivedText] = await page.evaluate(() => [window.lastMoveBoardMs, window.receivedText]);
  assert.match(receivedText, /stop\n(deadman 0\n)?$/);
  assert.ok(lastMoveMs - hiddenMs < 400, `movement afterwards: ${lastMoveMs - hiddenMs} ms`);
});

testPage('a robot stops when its phone falls asleep without warning, and the page reports the stop afterwards', () => openWithWalkingRobot(HM10), async (page) => {
  const sleepMs = await page.evaluate(() => window.readBoardMs());
  await radio.simulatePhoneSleep(3000);
  const lastMoveMs = await page.evaluate(() => window.lastMoveBoardMs);
  assert.ok(lastMoveMs - sleepMs > 300 && lastMoveMs - sleepMs <= 901 + 40, `movement afterwards: ${lastMoveMs - sleepMs} ms`);
  await page.clock.fastForward(3000);
  await radio.runUntil('the reason is shown', async () => (await readText(page, '#problems')).includes('it received no line for too long'));
  assert.equal(await readGait(page), 'stop');
});

test('on an iPhone, the page names a suitable browser at once', async () => {
  const page = await openPage({ userAgent: 'Mozilla/5.0 (iPhone; CPU iPhone OS 26_0 like Mac OS X) AppleWebKit/605.1.15' }, () => {
    for (const name of ['serial', 'bluetooth']) Object.defineProperty(navigator, name, { value: undefined });
    delete Object.getPrototypeOf(navigator).serial;
  });
  await page.locator('#no-serial', { hasText: 'On an iPhone or iPad, neither Safari nor Chrome can connect to a robot. The browser Bluefy can' }).waitFor();
  assert.equal(await page.locator('#radio').isVisible(), false);
});
