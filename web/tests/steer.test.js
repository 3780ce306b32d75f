// Driving by hand: the robot walks as long as a key or the stick is held.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { advance, openPage, startDrag, useBrowser, testPage, findGaitButton } from './browser.js';

useBrowser();

/** Opens the page and waits until all gaits are predicted. */
async function openPredicted(options = {}) {
  const page = await openPage(options);
  await page.waitForFunction(() => {
    const buttons = [...document.querySelectorAll('#gaits button[data-command]')];
    const stationaryGaits = ['stand', 'look'];
    // A line that is sent before the banner is lost.
    return window.lizard.state.bannerCount.value > 0 && buttons.length > 5 && buttons.every((button) => stationaryGaits.includes(button.dataset.command) || button.querySelector('small').textContent);
  });
  return page;
}

/** Sets the state of the gamepads that the page finds, and waits for the animation frame in which the page reads it. */
const setGamepads = (page, ...gamepads) =>
  page.evaluate(async (gamepads) => {
    navigator.getGamepads = () => gamepads;
    for (let frame = 0; frame < 2; frame++) await new Promise(requestAnimationFrame);
  }, gamepads);

const waitForShownGait = (page, gait) => page.waitForFunction((gait) => document.querySelector('#doing').textContent === gait, gait);

/** Presses a key (`down`) or releases it (`up`), and waits until the robot does a gait. */
async function moveKey(page, direction, key, gait) {
  await page.keyboard[direction](key);
  await waitForShownGait(page, gait);
}

/** Sets the state of the gamepads, and waits until the robot does a gait. */
async function steer(page, gait, ...gamepads) {
  await setGamepads(page, ...gamepads);
  await waitForShownGait(page, gait);
}

testPage('arrow keys make the robot walk, bend and turn while they are held, and stop it when released', openPredicted, async (page) => {
  await moveKey(page, 'down', 'ArrowUp', 'walk');
  await moveKey(page, 'down', 'ArrowLeft', 'arc left');
  await moveKey(page, 'up', 'ArrowUp', 'left');
  await moveKey(page, 'up', 'ArrowLeft', 'stop');
  await moveKey(page, 'down', 'ArrowDown', 'back');
  await moveKey(page, 'up', 'ArrowDown', 'stop');
});

testPage('letter keys drive as arrows do, except in a text field', openPredicted, async (page) => {
  await moveKey(page, 'down', 'd', 'right');
  await moveKey(page, 'up', 'd', 'stop');
  const lineInput = page.locator('#typed');
  await lineInput.focus();
  await page.keyboard.press('w');
  await page.keyboard.press('a');
  assert.equal(await lineInput.inputValue(), 'wa');
  assert.equal(await page.locator('#doing').textContent(), 'stop');
});

testPage('the robot walks in the direction of the stick on the screen', openPredicted, async (page) => {
  const stick = page.locator('#stick');
  await stick.scrollIntoViewIfNeeded();
  const { x, y, width, height } = await stick.boundingBox();
  const [middleX, middleY] = [x + width / 2, y + height / 2];
  await startDrag(page, [middleX, middleY], [middleX, y + 2]);
  await waitForShownGait(page, 'walk');
  await page.mouse.move(x + width - 2, middleY);
  await waitForShownGait(page, 'right');
  await page.mouse.up();
  await waitForShownGait(page, 'stop');
});

testPage('a stick held half way halves the pace, and its release restores the pace', openPredicted, async (page) => {
  await page.evaluate(() => window.lizard.board.ask('speed 80').then(() => null));
  const waitForPace = async (percent) => page.waitForFunction((text) => document.querySelector('#speed-out').textContent === text, `${percent} %`);
  const deflectStick = (forward, pressed = false) => setGamepads(page, { axes: [0, -forward], buttons: [{ pressed }] });
  await waitForPace(80);
  await deflectStick(0.5);
  await waitForShownGait(page, 'walk');
  await waitForPace(40);
  // An unsteady thumb must not change the pace in each frame.
  await deflectStick(0.7);
  await advance(page, 500);
  await waitForPace(40);
  await deflectStick(1);
  await waitForPace(80);
  await deflectStick(0.5);
  await waitForPace(40);
  await deflectStick(0);
  await waitForShownGait(page, 'stop');
  await waitForPace(80);
  await deflectStick(0.5);
  await waitForPace(40);
  await deflectStick(0.5, true);
  await waitForShownGait(page, 'stop');
  await waitForPace(80);
  // A pace that the robot has not confirmed yet is halved, too, and not replaced by the previous pace.
  await deflectStick(0);
  await advance(page, 100);
  await page.evaluate(() => {
    const { link } = window.lizard.board;
    const { onBytes } = link;
    const heldBytes = [];
    link.onBytes = (bytes) => heldBytes.push(bytes);
    window.releaseBytes = () => {
      link.onBytes = onBytes;
      heldBytes.forEach(onBytes);
    };
    void window.lizard.board.drive('speed 60');
  });
  await deflectStick(0.5);
  await advance(page, 100);
  await page.evaluate(() => window.releaseBytes());
  await waitForPace(30);
  await deflectStick(0);
  await waitForPace(60);
});

testPage('the robot stops when the window loses the focus', openPredicted, async (page) => {
  await moveKey(page, 'down', 'w', 'walk');
  await page.evaluate(() => void window.dispatchEvent(new Event('blur')));
  await waitForShownGait(page, 'stop');
});

testPage('a gamepad drives', openPredicted, async (page) => {
  await steer(page, 'walk', null, { axes: [0, -1], buttons: [] });
  await steer(page, 'arc left', null, { axes: [-0.8, -0.8], buttons: [] });
  await steer(page, 'stop', null, { axes: [0.1, 0], buttons: [] });
});

testPage('a gamepad button stops the robot once, and the stick drives again only after its release', openPredicted, async (page) => {
  await page.evaluate(() => {
    window.sentLines = [];
    const { board } = window.lizard;
    const { ask } = board;
    board.ask = (line, ...args) => (window.sentLines.push(line), ask.call(board, line, ...args));
  });
  await steer(page, 'walk', null, { axes: [0, -1], buttons: [{ pressed: false }] });
  await steer(page, 'stop', null, { axes: [0, -1], buttons: [{ pressed: true }] });
  await page.waitForTimeout(500);
  assert.deepEqual((await page.evaluate(() => window.sentLines)).filter((line) => line !== 'status'), ['walk', 'stop']);
  await setGamepads(page, null, { axes: [0, 0], buttons: [] });
  await page.waitForTimeout(200);
  await steer(page, 'walk', null, { axes: [0, -1], buttons: [] });
});

testPage('a gamepad button stops a gait that a button of the page has started', openPredicted, async (page) => {
  await findGaitButton(page, 'walk').click();
  await waitForShownGait(page, 'walk');
  await steer(page, 'stop', { axes: [0, 0], buttons: [{ pressed: true }] });
});

testPage('a second gamepad and the direction pad drive, too', openPredicted, async (page) => {
  const buttons = Array.from({ length: 16 }, (_, n) => ({ pressed: n === 12 }));
  await steer(page, 'walk', { axes: [0, 0], buttons: [] }, { axes: [0, 0], buttons });
});

testPage('a held gamepad does not keep the robot walking when another window gets the focus', openPredicted, async (page) => {
  await steer(page, 'walk', { axes: [0, -1], buttons: [] });
  await page.evaluate(() => void window.dispatchEvent(new Event('blur')));
  await waitForShownGait(page, 'stop');
  await page.waitForTimeout(500);
  assert.equal(await page.locator('#doing').textContent(), 'stop');
});

test('the page opens with the robot walking slowly, unless reduced motion is preferred', async () => {
  const movingPage = await openPage({ reducedMotion: 'no-preference' });
  await waitForShownGait(movingPage, 'walk');
  await movingPage.waitForFunction(() => document.querySelector('#speed').value === '50');
  const stillPage = await openPredicted();
  await waitForShownGait(stillPage, 'stand');
  // On a page with motion, the robot would have begun to walk within this time.
  await advance(stillPage, 6000);
  assert.equal(await stillPage.locator('#doing').textContent(), 'stand');
});

test('the robot walks at the start even if walk and trot are predicted before the robot\'s banner', async () => {
  const page = await openPage({ reducedMotion: 'no-preference' }, () => {
    // Without the stored predictions, as for a user's own robot.
    const { fetch } = window;
    window.fetch = (address, ...args) => (String(address).includes('predictions') ? Promise.reject(new TypeError('none')) : fetch(address, ...args));
    // Only the first three gaits are predicted.
    window.Worker = class extends Worker {
      addEventListener(type, listener) {
        super.addEventListener(type, (event) => (event.data.gait ?? 0) <= 2 && listener(event));
      }
    };
  });
  await page.waitForFunction(() => document.querySelector('button[data-command="trot"] small').textContent.includes('mm'));
  assert.equal(await page.locator('#where').textContent(), 'waiting for the simulated UNO');
  await advance(page, 2500);
  await page.clock.runFor(1000);
  await waitForShownGait(page, 'walk');
});

testPage('a robot with other gaits is driven by its own gaits', openPredicted, async (page) => {
  await page.locator('#robot').selectOption('own-gaits');
  await page.waitForFunction(() => {
    const buttons = [...document.querySelectorAll('#gaits button[data-command]')];
    return buttons.length > 12 && buttons.filter((button) => button.querySelector('small').textContent.includes('mm')).length > 5;
  });
  await page.keyboard.down('ArrowUp');
  await page.waitForFunction(() => !['stand', 'stop', '–'].includes(document.querySelector('#doing').textContent));
  await moveKey(page, 'up', 'ArrowUp', 'stop');
});

testPage('arrow keys drive after a click on the pace, the list of robots or the floor, but not after Tab', openPredicted, async (page) => {
  const pace = page.locator('#speed');
  for (const selector of ['#speed', '#floor', '#robot']) {
    await page.locator(selector).click();
    if (selector === '#robot') await page.keyboard.press('Escape');
    const previousValues = await page.evaluate(() => [document.querySelector('#speed').value, document.querySelector('#robot').value]);
    await moveKey(page, 'down', 'ArrowUp', 'walk');
    await moveKey(page, 'up', 'ArrowUp', 'stop');
    assert.deepEqual(await page.evaluate(() => [document.querySelector('#speed').value, document.querySelector('#robot').value]), previousValues, selector);
  }
  assert.equal(await page.getByRole('button', { name: 'Follow' }).getAttribute('aria-pressed'), 'true', 'the view stays');
  await page.locator('#reset').focus();
  await page.keyboard.press('Tab');
  const previousPace = await pace.inputValue();
  await page.keyboard.press('ArrowLeft');
  assert.notEqual(await pace.inputValue(), previousPace);
  assert.equal(await page.locator('#doing').textContent(), 'stop');
});
