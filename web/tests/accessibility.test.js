// Accessibility: axe-core finds no violations, no screen scrolls sideways, and arrow keys pan the floor.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { findViolations } from './axe.js';
import { advance, openStanding, startDrag, unfold, useBrowser, testPage } from './browser.js';

useBrowser();

const PHONE = { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, hasTouch: true };

const ROOMS = {
  drive: ['#keep', '#world', '#power'],
  gaits: ['#gait-editor', '#routines', '#gesture-editor'],
  build: ['#lengths-panel', '#parts', '#robot-editor'],
  board: ['#calibrate', '#flash'],
  measure: [],
  learn: ['#maps', '#margins-panel', '#pulses', '#console'],
};

/** Opens the page and calls `check` in each room, with all its panels unfolded. */
async function checkEveryRoom(options, check) {
  // The page's Content Security Policy would block the injected axe-core.
  const page = await openStanding({ ...options, bypassCSP: true });
  for (const [room, panels] of Object.entries(ROOMS)) {
    for (const panel of panels) await unfold(page, panel);
    if (room === 'gaits') {
      // A step with a mistake shows its refusal, which must be accessible, too.
      await page.getByRole('button', { name: 'Add a step' }).click();
      await page.getByLabel('Step 1', { exact: true }).fill('wolk 4');
      await page.keyboard.press('Enter');
      await page.locator('#routine-refusal').waitFor();
    }
    if (room === 'build') await page.getByText('Click a part for its name').waitFor();
    await advance(page, 500);
    if (room === 'board') await page.getByRole('group', { name: 'A4' }).waitFor();
    await check(page, room);
  }
}

for (const [name, options] of [
  ['light', { colorScheme: 'light' }],
  ['dark', { colorScheme: 'dark' }],
  ['on a phone', PHONE],
]) {
  test(`axe-core finds no violations, ${name}`, async () => {
    await checkEveryRoom(options, async (page, room) => {
      assert.deepEqual(await findViolations(page), [], room);
    });
  });
}

for (const [name, options] of [
  ['light', { colorScheme: 'light' }],
  ['dark, on a phone', { ...PHONE, colorScheme: 'dark' }],
  ['in forced colours', { forcedColors: 'active' }],
]) {
  testPage(`axe-core finds no violations in any step of the first connection, ${name}`, () => openStanding({ ...options, bypassCSP: true }), async (page) => {
    await page.locator('#setup-open').click();
    const steps = await page.locator('#setup-steps button').all();
    assert.equal(steps.length, 9);
    for (const step of steps) {
      await step.click();
      await advance(page, 1500);
      assert.deepEqual(await findViolations(page, '#setup'), [], await page.locator('#setup-step').innerText());
    }
  });
}

// Fonts differ from machine to machine; letter spacing imitates wider fonts.
test('no screen scrolls sideways, with narrow or wide fonts', async () => {
  const overflows = [];
  await checkEveryRoom({ ...PHONE, deviceScaleFactor: 1 }, async (page, room) => {
    for (const width of [320, 340, 360, 375, 390, 412, 430, 480, 560, 641, 700, 761, 1001, 1400]) {
      await page.setViewportSize({ width, height: 844 });
      for (const spacing of ['0', '0.05em', '0.1em']) {
        const [shownWidth, overflowPixels] = await page.evaluate((spacing) => {
          document.body.style.letterSpacing = spacing;
          const { clientWidth, scrollWidth } = document.documentElement;
          return [clientWidth, scrollWidth - clientWidth];
        }, spacing);
        assert.equal(shownWidth, width);
        if (overflowPixels > 0) overflows.push(`${room}: ${overflowPixels} pixels wider than the window of ${width}, letter spacing ${spacing}`);
      }
    }
    await page.setViewportSize(PHONE.viewport);
  });
  assert.deepEqual(overflows, []);
});

testPage('arrow keys and dragging pan the floor and switch Follow off, but not arrow keys with Ctrl, Alt or Meta', openStanding, async (page) => {
  const floor = page.locator('#floor');
  const follow = page.getByRole('button', { name: 'Follow' });
  assert.equal(await follow.getAttribute('aria-pressed'), 'true');
  await floor.focus();
  // The browser uses arrow keys with these modifiers itself: Alt and the left arrow go back.
  for (const modifier of ['altKey', 'ctrlKey', 'metaKey']) await floor.dispatchEvent('keydown', { key: 'ArrowLeft', [modifier]: true });
  assert.equal(await follow.getAttribute('aria-pressed'), 'true');
  await floor.press('ArrowLeft');
  assert.equal(await follow.getAttribute('aria-pressed'), 'false');
  await follow.click();
  const { x, y } = await floor.boundingBox();
  await startDrag(page, [x + 300, y + 300], [x + 350, y + 320]);
  await page.mouse.up();
  assert.equal(await follow.getAttribute('aria-pressed'), 'false');
});
