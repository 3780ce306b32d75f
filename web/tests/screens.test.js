// The page on a phone, with a mouse, in forced colours, and in browsers that cannot run it; and its lists, words and
// scripts.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { test } from 'node:test';

import { address, advance, openBlankPage, dropBrowserErrors, openPage, measureOverflow, openStanding, readBox, unfold, withTimeout, useBrowser, chooseRobot, testPage, clickAndAdvance, LANDSCAPE, PHONE, findGaitButton, readGait } from './browser.js';

useBrowser();

async function isOnScreen(page, selector) {
  const [{ top, bottom, left, right }, { width, height }] = [await readBox(page, selector), await page.evaluate(() => ({ width: innerWidth, height: innerHeight }))];
  return top >= 0 && left >= 0 && bottom <= height && right <= width;
}

/** Moves a finger from the middle of an element, some pixels to the right and down. */
async function swipe(page, selector, rightPx, downPx) {
  const { left, top, width, height } = await readBox(page, selector);
  const session = await withTimeout('opening the touch session', page.context().newCDPSession(page));
  const sendTouch = (type, touchPoints) => withTimeout('sending a touch event', session.send('Input.dispatchTouchEvent', { type, touchPoints }));
  const makeTouches = (fraction) => [{ x: left + width / 2 + fraction * rightPx, y: top + height / 2 + fraction * downPx }];
  await sendTouch('touchStart', makeTouches(0));
  for (let step = 1; step <= 20; step++) await sendTouch('touchMove', makeTouches(step / 20));
  await sendTouch('touchEnd', []);
}

for (const [name, options] of [['held upright', PHONE], ['held sideways', LANDSCAPE]]) {
  testPage(`Stop stays on the screen of a phone ${name} while the page scrolls`, () => openStanding(options), async (page) => {
    for (const panel of ['#world', '#power', '#keep']) await unfold(page, panel);
    await page.evaluate(() => scrollTo(0, 0));
    assert.ok(await isOnScreen(page, '.stop'), 'at the top');
    await page.evaluate(() => scrollTo(0, document.documentElement.scrollHeight));
    assert.ok((await page.evaluate(() => scrollY)) > 500);
    assert.ok(await isOnScreen(page, '.stop'), 'at the bottom');
    await findGaitButton(page, 'walk').evaluate((button) => button.click());
    await advance(page, 500);
    await page.locator('.stop').tap();
    await advance(page, 300);
    assert.equal(await readGait(page), 'stop', 'Stop is covered');
  });

  testPage(`a phone ${name} shows the robot and its buttons on one screen`, () => openStanding(options), async (page) => {
    await page.goto(`${address()}#room=drive`);
    for (const selector of ['#floor', '#gaits', '#reset', '#speed']) {
      assert.ok(await isOnScreen(page, selector), selector);
    }
    const { height } = await readBox(page, '#floor');
    assert.ok(height > 280, `height of the floor: ${height} pixels`);
  });
}

testPage('a finger that moves up over the floor scrolls the page', () => openStanding(PHONE), async (page) => {
  await page.goto(`${address()}#room=gaits`);
  const follow = page.getByRole('button', { name: 'Follow' });
  await swipe(page, '#floor', 120, 0);
  assert.equal(await follow.getAttribute('aria-pressed'), 'false', 'the sideways swipe did not drag the floor');
  assert.equal(await page.evaluate(() => scrollY), 0);
  await follow.click();
  // Last, because the page keeps scrolling for a while.
  await swipe(page, '#floor', 0, -150);
  await page.waitForFunction(() => scrollY > 100);
  assert.equal(await follow.getAttribute('aria-pressed'), 'true', 'the swipe dragged the floor');
});

/** Returns the zoom of the floor, CSS pixels per mm. */
const readZoom = (page) => page.evaluate(() => Number(document.querySelector('#floor').dataset.zoom));

test('the wheel scrolls the page, and with Ctrl zooms, but never so far out that the robot vanishes', async () => {
  const page = await openStanding({ viewport: { width: 1400, height: 700 } });
  await page.goto(`${address()}#room=gaits`);
  await page.waitForFunction(() => document.querySelector('#floor').dataset.zoom);
  const firstZoom = await readZoom(page);
  const { left, top } = await readBox(page, '#floor');
  await page.mouse.move(left + 200, top + 200);
  await page.mouse.wheel(0, 300);
  await page.waitForFunction(() => scrollY > 100);
  assert.equal(await readZoom(page), firstZoom);
  await page.evaluate(() => scrollTo(0, 0));
  await page.locator('#floor').dispatchEvent('wheel', { deltaY: 5000, ctrlKey: true, offsetX: 200, offsetY: 200 });
  await page.waitForFunction((firstZoom) => Number(document.querySelector('#floor').dataset.zoom) < firstZoom, firstZoom);
  assert.ok(250 * (await readZoom(page)) > 60, 'a robot of 250 mm is at most 60 pixels long');
  // `Back to start` resets the view, even a moved one.
  const follow = page.getByRole('button', { name: 'Follow' });
  await page.locator('#floor').press('ArrowLeft');
  assert.equal(await follow.getAttribute('aria-pressed'), 'false');
  await page.getByRole('button', { name: 'Back to start' }).click();
  assert.equal(await follow.getAttribute('aria-pressed'), 'true');
  await page.waitForFunction((firstZoom) => Number(document.querySelector('#floor').dataset.zoom) === firstZoom, firstZoom);
});

testPage('in forced colours, the page shows which button is pressed and how long a bar is', () => openStanding({ forcedColors: 'active' }), async (page) => {
  await clickAndAdvance(page, '#gaits button[data-command="walk"]', 300);
  const readColour = (selector) =>
    page.evaluate((selector) => getComputedStyle(document.querySelector(selector)).backgroundColor, selector);
  const [pressedColour, otherColour] = ['walk', 'trot'].map((name) => readColour(`#gaits button[data-command="${name}"]`));
  assert.notEqual(await pressedColour, await otherColour);
  const barColours = await Promise.all(['.bar .track', '.bar .fill', '.bar .limit'].map(readColour));
  assert.equal(new Set(barColours).size, 3, barColours.join());
});

for (const [name, viewport] of [
  ['a narrow phone', { width: 320, height: 568 }],
  ['a tablet', { width: 768, height: 1024 }],
  ['a large desktop', { width: 3840, height: 2160 }],
]) {
  testPage(`with every panel open, everything fits the width of ${name}`, () => openStanding({ viewport }), async (page) => {
    for (const panel of ['#lengths-panel', '#calibrate', '#flash', '#world', '#gait-editor', '#maps']) {
      await unfold(page, panel);
      await advance(page, 500);
      const outsideElements = await page.evaluate(() =>
        [...document.querySelectorAll('button, input, select, canvas, table')]
          .filter((node) => node.getBoundingClientRect().right > document.documentElement.clientWidth + 0.5)
          .map(({ id, textContent }) => id || textContent),
      );
      assert.equal(await measureOverflow(page), 0);
      assert.deepEqual(outsideElements, []);
    }
  });
}

test('a touch screen shows no keyboard shortcuts, and the list of robots shows full names', async () => {
  for (const viewport of [{ width: 360, height: 640 }, { width: 844, height: 390 }, { width: 1024, height: 1366 }]) {
    const page = await openStanding({ viewport, hasTouch: true, isMobile: true });
    for (const room of ['drive', 'build', 'board']) {
      await page.goto(`${address()}#room=${room}`);
      const shownKeys = await page.evaluate(() => [...document.querySelectorAll('button kbd')].filter((key) => key.checkVisibility()).map(({ textContent }) => textContent));
      assert.deepEqual(shownKeys, [], room);
    }
    assert.equal((await page.locator('.stop').innerText()).trim(), 'Stop');
    const sparePixels = await page.locator('#robot').evaluate((list) => {
      const context = document.createElement('canvas').getContext('2d');
      context.font = getComputedStyle(list).font;
      const textWidth = Math.max(...['robot', 'large', 'paper'].map((name) => context.measureText(name).width));
      const { paddingLeft, paddingRight } = getComputedStyle(list);
      // The arrow of the list is about 18 pixels wide.
      return list.clientWidth - Number.parseFloat(paddingLeft) - Number.parseFloat(paddingRight) - 18 - textWidth;
    });
    assert.ok(sparePixels >= 0, `${sparePixels} spare pixels at a width of ${viewport.width}`);
  }
});

testPage('without JavaScript the page states its requirements', () => openBlankPage({ javaScriptEnabled: false }), async (page) => {
  await page.goto(address());
  const message = page.locator('noscript p');
  await message.waitFor();
  assert.match(await message.innerText(), /which are switched off here/);
});

testPage('a page that was opened as a file states its requirement', openBlankPage, async (page) => {
  await page.goto(new URL('../dist/index.html', import.meta.url).href);
  await page.locator('#where', { hasText: 'it needs a web server' }).waitFor();
});

test('long names of gaits fit on their buttons', async () => {
  for (const options of [PHONE, { viewport: { width: 1400, height: 1000 } }]) {
    const page = await openStanding(options);
    await chooseRobot(page, 'own-gaits');
    const buttons = await page.locator('#gaits button').evaluateAll((buttons) =>
      buttons.map((button) => ({ name: button.dataset.command, height: button.offsetHeight, excessPixels: button.scrollWidth - button.clientWidth })),
    );
    assert.ok(buttons.some(({ name }) => name.length > 40));
    for (const { name, height, excessPixels } of buttons) {
      assert.ok(height <= 90, `${name}: ${height} pixels high`);
      assert.ok(excessPixels <= 0, `${name}: ${excessPixels} pixels too wide`);
    }
  }
});

testPage('the list of robots ends with the robots for tests, under a heading', openPage, async (page) => {
  const [plainNames, testNames] = await page.evaluate(() =>
    ['#robot > option', '#robot > optgroup[label="for tests"] > option'].map((selector) =>
      [...document.querySelectorAll(selector)].map(({ value }) => value),
    ),
  );
  assert.deepEqual(plainNames, ['robot', 'grain', 'large', 'paper']);
  assert.deepEqual(testNames, ['own-gaits', 'unequal']);
});

testPage('the page reports a word that the core does not have', openBlankPage, async (page) => {
  const wasm = await readFile(new URL('../dist/files/lizard.wasm', import.meta.url), 'latin1');
  assert.ok(wasm.includes('factory'));
  const body = Buffer.from(wasm.replaceAll('factory', 'faktory'), 'latin1');
  await page.route('**/lizard.wasm', (route) => route.fulfill({ body, contentType: 'application/wasm' }));
  await page.goto(address());
  await page.locator('#problems', { hasText: 'The page sends words that the core does not have: factory.' }).waitFor();
});

testPage('the core has every word that a button sends', openStanding, async (page) => {
  assert.equal(await page.locator('#problems').isVisible(), false);
  const sentWords = await page.locator('[data-command]').evaluateAll((buttons) => buttons.map(({ dataset }) => dataset.command));
  const { words, gaits } = await page.evaluate(() => window.lizard.robot.description);
  const knownWords = [...words, ...gaits.map(({ command }) => command)];
  assert.deepEqual(sentWords.filter((command) => !knownWords.includes(command)), []);
  assert.ok(sentWords.length >= 10);
});

testPage('a script that is not the page\'s own does not run', openPage, async (page) => {
  const blockedMessage = page.waitForEvent('console', (message) => /Content Security Policy/.test(message.text()));
  await page.evaluate(() => {
    const script = document.createElement('script');
    script.textContent = 'window.foreignScriptRan = true';
    document.body.append(script);
  });
  await blockedMessage;
  assert.equal(await page.evaluate(() => window.foreignScriptRan), undefined);
  dropBrowserErrors(/Content Security Policy/);
});
