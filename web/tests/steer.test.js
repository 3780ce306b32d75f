// Driving by hand: keys and the stick walk for as long as they are held.
import assert from 'node:assert/strict';
import { after, afterEach, before, test } from 'node:test';

import { advance, close, complaints, open, page, closePages } from './browser.js';

before(open);
afterEach(closePages);
after(close);

/** Opens the page and waits until all gaits are predicted. */
async function openReady(options = {}) {
  const opened = await page(options);
  await opened.waitForFunction(() => {
    const notes = [...document.querySelectorAll('#gaits button[data-command]')];
    const still = ['stand', 'look'];
    return notes.length > 5 && notes.every((button) => still.includes(button.dataset.command) || button.querySelector('small').textContent);
  });
  return opened;
}

const waitForGait = (opened, gait) => opened.waitForFunction((gait) => document.querySelector('#doing').textContent === gait, gait);

test('arrow keys make the robot walk, bend and turn while they are held, and stop it when released', async () => {
  const opened = await openReady();
  const { keyboard } = opened;
  await keyboard.down('ArrowUp');
  await waitForGait(opened, 'walk');
  await keyboard.down('ArrowLeft');
  await waitForGait(opened, 'arc left');
  await keyboard.up('ArrowUp');
  await waitForGait(opened, 'left');
  await keyboard.up('ArrowLeft');
  await waitForGait(opened, 'stop');
  await keyboard.down('ArrowDown');
  await waitForGait(opened, 'back');
  await keyboard.up('ArrowDown');
  await waitForGait(opened, 'stop');
});

test('letter keys drive as arrows do, except in a text field', async () => {
  const opened = await openReady();
  await opened.keyboard.down('d');
  await waitForGait(opened, 'right');
  await opened.keyboard.up('d');
  await waitForGait(opened, 'stop');
  const typed = opened.locator('#typed');
  await typed.focus();
  await opened.keyboard.press('w');
  await opened.keyboard.press('a');
  assert.equal(await typed.inputValue(), 'wa');
  assert.equal(await opened.locator('#doing').textContent(), 'stop');
});

test('the stick on the screen walks where it is held', async () => {
  const opened = await openReady();
  const stick = opened.locator('#stick');
  await stick.scrollIntoViewIfNeeded();
  const { x, y, width, height } = await stick.boundingBox();
  const [middle, centre] = [x + width / 2, y + height / 2];
  await opened.mouse.move(middle, centre);
  await opened.mouse.down();
  await opened.mouse.move(middle, y + 2);
  await waitForGait(opened, 'walk');
  await opened.mouse.move(x + width - 2, centre);
  await waitForGait(opened, 'right');
  await opened.mouse.up();
  await waitForGait(opened, 'stop');
});

test('a half deflected stick drives at half the pace, and releasing it restores the pace', async () => {
  const opened = await openReady();
  await opened.evaluate(() => {
    window.pad = { axes: [0, 0], buttons: [{ pressed: false }] };
    navigator.getGamepads = () => [window.pad];
    return window.lizard.ask('speed 80').then(() => null);
  });
  const paces = async (percent) => opened.waitForFunction((text) => document.querySelector('#speed-out').textContent === text, `${percent} %`);
  const push = (ahead, pressed = false) => opened.evaluate(([ahead, pressed]) => (window.pad = { axes: [0, -ahead], buttons: [{ pressed }] }), [ahead, pressed]);
  await paces(80);
  await push(0.5);
  await waitForGait(opened, 'walk');
  await paces(40);
  // A thumb that trembles at the boundary must not change the pace with each picture.
  await push(0.7);
  await advance(opened, 500);
  await paces(40);
  await push(1);
  await paces(80);
  await push(0.5);
  await paces(40);
  await push(0);
  await waitForGait(opened, 'stop');
  await paces(80);
  await push(0.5);
  await paces(40);
  await push(0.5, true);
  await waitForGait(opened, 'stop');
  await paces(80);
});

test('a page that is left does not walk on', async () => {
  const opened = await openReady();
  await opened.keyboard.down('w');
  await waitForGait(opened, 'walk');
  await opened.evaluate(() => void window.dispatchEvent(new Event('blur')));
  await waitForGait(opened, 'stop');
});

test('a gamepad drives', async () => {
  const opened = await openReady();
  await opened.evaluate(() => {
    window.pad = { axes: [0, -1], buttons: [] };
    navigator.getGamepads = () => [null, window.pad];
  });
  await waitForGait(opened, 'walk');
  await opened.evaluate(() => {
    window.pad = { axes: [-0.8, -0.8], buttons: [] };
  });
  await waitForGait(opened, 'arc left');
  await opened.evaluate(() => {
    window.pad = { axes: [0.1, 0], buttons: [] };
  });
  await waitForGait(opened, 'stop');
});

test('a button of a gamepad stops the robot, once, and it goes on only when the stick was let go', async () => {
  const opened = await openReady();
  await opened.evaluate(() => {
    window.sent = [];
    const { ask } = window.lizard;
    window.lizard.ask = (line, ...more) => (window.sent.push(line), ask.call(window.lizard, line, ...more));
    window.pad = { axes: [0, -1], buttons: [{ pressed: false }] };
    navigator.getGamepads = () => [null, window.pad];
  });
  await waitForGait(opened, 'walk');
  await opened.evaluate(() => (window.pad.buttons = [{ pressed: true }]));
  await waitForGait(opened, 'stop');
  await opened.waitForTimeout(500);
  assert.deepEqual((await opened.evaluate(() => window.sent)).filter((line) => line !== 'status'), ['walk', 'stop']);
  await opened.evaluate(() => (window.pad = { axes: [0, 0], buttons: [] }));
  await opened.waitForTimeout(200);
  await opened.evaluate(() => (window.pad = { axes: [0, -1], buttons: [] }));
  await waitForGait(opened, 'walk');
});

test('a button of a gamepad stops a gait that the page began', async () => {
  const opened = await openReady();
  await opened.locator('#gaits button[data-command="walk"]').click();
  await waitForGait(opened, 'walk');
  await opened.evaluate(() => (navigator.getGamepads = () => [{ axes: [0, 0], buttons: [{ pressed: true }] }]));
  await waitForGait(opened, 'stop');
});

test('a second gamepad and the direction pad drive, too', async () => {
  const opened = await openReady();
  await opened.evaluate(() => {
    const buttons = Array.from({ length: 16 }, (_, n) => ({ pressed: n === 12 }));
    navigator.getGamepads = () => [{ axes: [0, 0], buttons: [] }, { axes: [0, 0], buttons }];
  });
  await waitForGait(opened, 'walk');
});

test('a gamepad that is held while another window gets the focus does not keep the robot walking', async () => {
  const opened = await openReady();
  await opened.evaluate(() => (navigator.getGamepads = () => [{ axes: [0, -1], buttons: [] }]));
  await waitForGait(opened, 'walk');
  await opened.evaluate(() => void window.dispatchEvent(new Event('blur')));
  await waitForGait(opened, 'stop');
  await opened.waitForTimeout(500);
  assert.equal(await opened.locator('#doing').textContent(), 'stop');
});

test('the page opens with the robot walking slowly, unless reduced motion is preferred', async () => {
  const moving = await page({ reducedMotion: 'no-preference' });
  await waitForGait(moving, 'walk');
  await moving.waitForFunction(() => document.querySelector('#speed').value === '50');
  const still = await openReady();
  assert.equal(await still.locator('#doing').textContent(), 'stand');
});

test('it also opens with walk if walk and trot are predicted before the robot\'s banner', async () => {
  const opened = await page({ reducedMotion: 'no-preference' }, () => {
    // As for a user's own robot, whose predictions do not come with the page.
    const { fetch } = window;
    window.fetch = (address, ...more) => (String(address).includes('predictions') ? Promise.reject(new TypeError('none')) : fetch(address, ...more));
    // The other predictions never come.
    window.Worker = class extends Worker {
      addEventListener(kind, then) {
        super.addEventListener(kind, (event) => (event.data.gait ?? 0) <= 2 && then(event));
      }
    };
  });
  await opened.waitForFunction(() => document.querySelector('button[data-command="trot"] small').textContent.includes('mm'));
  assert.equal(await opened.locator('#where').textContent(), 'waiting for the simulated UNO');
  await advance(opened, 2500);
  await opened.clock.runFor(1000);
  await waitForGait(opened, 'walk');
});

test('a robot with other gaits is driven by its own gaits', async () => {
  const opened = await openReady();
  await opened.locator('#robot').selectOption('own-gaits');
  await opened.waitForFunction(() => {
    const notes = [...document.querySelectorAll('#gaits button[data-command]')];
    return notes.length > 12 && notes.filter((button) => button.querySelector('small').textContent.includes('mm')).length > 5;
  });
  await opened.keyboard.down('ArrowUp');
  await opened.waitForFunction(() => !['stand', 'stop', '–'].includes(document.querySelector('#doing').textContent));
  await opened.keyboard.up('ArrowUp');
  await waitForGait(opened, 'stop');
});

test('after a click on the pace, on the list of robots or on the floor the arrows still drive; after Tab they do not', async () => {
  const opened = await openReady();
  const pace = opened.locator('#speed');
  for (const selector of ['#speed', '#floor', '#robot']) {
    await opened.locator(selector).click();
    if (selector === '#robot') await opened.keyboard.press('Escape');
    const before = await opened.evaluate(() => [document.querySelector('#speed').value, document.querySelector('#robot').value]);
    await opened.keyboard.down('ArrowUp');
    await waitForGait(opened, 'walk');
    await opened.keyboard.up('ArrowUp');
    await waitForGait(opened, 'stop');
    assert.deepEqual(await opened.evaluate(() => [document.querySelector('#speed').value, document.querySelector('#robot').value]), before, selector);
  }
  assert.equal(await opened.getByRole('button', { name: 'Follow' }).getAttribute('aria-pressed'), 'true', 'the view stays');
  await opened.locator('#reset').focus();
  await opened.keyboard.press('Tab');
  const value = await pace.inputValue();
  await opened.keyboard.press('ArrowLeft');
  assert.notEqual(await pace.inputValue(), value);
  assert.equal(await opened.locator('#doing').textContent(), 'stop');
});

test('the browser reported no error or warning', () => assert.deepEqual(complaints, []));
