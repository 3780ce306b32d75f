// The page on a phone, with a mouse, in the user's colours, and in browsers that cannot run it.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { after, afterEach, before, test } from 'node:test';

import { address, advance, openBlank, close, complaints, open, page, overflow, openStanding, closePages, unfold, within } from './browser.js';

before(open);
afterEach(closePages);
after(close);

const PORTRAIT = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };
const LANDSCAPE = { viewport: { width: 844, height: 390 }, hasTouch: true, isMobile: true };

/** Screen position of an element, CSS pixels. */
const place = (opened, selector) =>
  opened.evaluate((selector) => document.querySelector(selector).getBoundingClientRect().toJSON(), selector);
const screen = (opened) => opened.evaluate(() => ({ width: innerWidth, height: innerHeight }));

async function isOnScreen(opened, selector) {
  const [{ top, bottom, left, right }, { width, height }] = [await place(opened, selector), await screen(opened)];
  return top >= 0 && left >= 0 && bottom <= height && right <= width;
}

/** Moves a finger from the middle of an element, some pixels right and down. */
async function swipe(opened, selector, right, down) {
  const { left, top, width, height } = await place(opened, selector);
  const session = await within('the touch screen', opened.context().newCDPSession(opened));
  const send = (type, touchPoints) => within('a finger', session.send('Input.dispatchTouchEvent', { type, touchPoints }));
  const at = (share) => [{ x: left + width / 2 + share * right, y: top + height / 2 + share * down }];
  await send('touchStart', at(0));
  for (let step = 1; step <= 20; step++) await send('touchMove', at(step / 20));
  await send('touchEnd', []);
}

for (const [name, options] of [
  ['upright', PORTRAIT],
  ['on its side', LANDSCAPE],
]) {
  test(`stop is on the screen of a phone ${name}, wherever it is scrolled to`, async () => {
    const opened = await openStanding(options);
    for (const panel of ['#world', '#power', '#keep']) await unfold(opened, panel);
    await opened.evaluate(() => scrollTo(0, 0));
    assert.ok(await isOnScreen(opened, '.stop'), 'at the top');
    await opened.evaluate(() => scrollTo(0, document.documentElement.scrollHeight));
    assert.ok((await opened.evaluate(() => scrollY)) > 500);
    assert.ok(await isOnScreen(opened, '.stop'), 'at the bottom');
    await opened.locator('#gaits button[data-command="walk"]').evaluate((button) => button.click());
    await advance(opened, 500);
    await opened.locator('.stop').tap();
    await advance(opened, 300);
    assert.equal(await opened.evaluate(() => window.lizard.gait), 'stop', 'nothing lies over it');
  });

  test(`a phone ${name} shows the robot and its buttons on one screen`, async () => {
    const opened = await openStanding(options);
    await opened.goto(`${address()}#room=drive`);
    for (const selector of ['#floor', '#gaits', '#reset', '#speed']) {
      assert.ok(await isOnScreen(opened, selector), selector);
    }
    const { height } = await place(opened, '#floor');
    assert.ok(height > 280, `${height} pixels of floor`);
  });
}

test('a finger that moves up over the floor scrolls the page', async () => {
  const opened = await openStanding(PORTRAIT);
  await opened.goto(`${address()}#room=gaits`);
  const follow = opened.getByRole('button', { name: 'Follow' });
  await swipe(opened, '#floor', 120, 0);
  assert.equal(await follow.getAttribute('aria-pressed'), 'false', 'a finger aside drags the floor');
  assert.equal(await opened.evaluate(() => scrollY), 0);
  await follow.click();
  // Last, because the page keeps scrolling for a while.
  await swipe(opened, '#floor', 0, -150);
  await opened.waitForFunction(() => scrollY > 100);
  assert.equal(await follow.getAttribute('aria-pressed'), 'true', 'the floor was not dragged');
});

/** Zoom of the floor, CSS pixels per mm. */
const zoom = (opened) => opened.evaluate(() => Number(document.querySelector('#floor').dataset.zoom));

test('the wheel scrolls the page, and zooms with Ctrl as long as the robot stays visible', async () => {
  const opened = await openStanding({ viewport: { width: 1400, height: 700 } });
  await opened.goto(`${address()}#room=gaits`);
  await opened.waitForFunction(() => document.querySelector('#floor').dataset.zoom);
  const first = await zoom(opened);
  const { left, top } = await place(opened, '#floor');
  await opened.mouse.move(left + 200, top + 200);
  await opened.mouse.wheel(0, 300);
  await opened.waitForFunction(() => scrollY > 100);
  assert.equal(await zoom(opened), first);
  await opened.evaluate(() => scrollTo(0, 0));
  await opened.locator('#floor').dispatchEvent('wheel', { deltaY: 5000, ctrlKey: true, offsetX: 200, offsetY: 200 });
  await opened.waitForFunction((first) => Number(document.querySelector('#floor').dataset.zoom) < first, first);
  assert.ok(250 * (await zoom(opened)) > 60, 'pixels for a robot of 250 mm');
  // Back, wherever the view was.
  const follow = opened.getByRole('button', { name: 'Follow' });
  await opened.locator('#floor').press('ArrowLeft');
  assert.equal(await follow.getAttribute('aria-pressed'), 'false');
  await opened.getByRole('button', { name: 'Back to start' }).click();
  assert.equal(await follow.getAttribute('aria-pressed'), 'true');
  await opened.waitForFunction((first) => Number(document.querySelector('#floor').dataset.zoom) === first, first);
});

test('forced colours show which button is pressed and how long a bar is', async () => {
  const opened = await openStanding({ forcedColors: 'active' });
  await opened.locator('#gaits button[data-command="walk"]').click();
  await advance(opened, 300);
  const colour = (selector) =>
    opened.evaluate((selector) => getComputedStyle(document.querySelector(selector)).backgroundColor, selector);
  const [pressed, other] = ['walk', 'trot'].map((name) => colour(`#gaits button[data-command="${name}"]`));
  assert.notEqual(await pressed, await other);
  const bar = await Promise.all(['.bar .track', '.bar .fill', '.bar .limit'].map(colour));
  assert.equal(new Set(bar).size, 3, bar.join());
});

for (const [name, viewport] of [
  ['320 pixels', { width: 320, height: 568 }],
  ['a tablet', { width: 768, height: 1024 }],
  ['a large desk', { width: 3840, height: 2160 }],
]) {
  test(`at a width of ${name} with every panel open, nothing is outside the screen`, async () => {
    const opened = await openStanding({ viewport });
    for (const panel of ['#lengths-panel', '#calibrate', '#flash', '#world', '#gait-editor', '#maps']) {
      await unfold(opened, panel);
      await advance(opened, 500);
      const outside = await opened.evaluate(() =>
        [...document.querySelectorAll('button, input, select, canvas, table')]
          .filter((each) => each.getBoundingClientRect().right > document.documentElement.clientWidth + 0.5)
          .map(({ id, textContent }) => id || textContent),
      );
      assert.equal(await overflow(opened), 0);
      assert.deepEqual(outside, []);
    }
  });
}

test('on a touch screen no keys are mentioned, and the list of robots shows whole names', async () => {
  for (const viewport of [{ width: 360, height: 640 }, { width: 844, height: 390 }, { width: 1024, height: 1366 }]) {
    const opened = await openStanding({ viewport, hasTouch: true, isMobile: true });
    for (const room of ['drive', 'build', 'board']) {
      await opened.goto(`${address()}#room=${room}`);
      const keys = await opened.evaluate(() => [...document.querySelectorAll('button kbd')].filter((key) => key.checkVisibility()).map(({ textContent }) => textContent));
      assert.deepEqual(keys, [], room);
    }
    assert.equal((await opened.locator('.stop').innerText()).trim(), 'Stop');
    const room = await opened.locator('#robot').evaluate((list) => {
      const pen = document.createElement('canvas').getContext('2d');
      pen.font = getComputedStyle(list).font;
      const wide = Math.max(...['robot', 'large', 'paper'].map((name) => pen.measureText(name).width));
      const { paddingLeft, paddingRight } = getComputedStyle(list);
      // An arrow is as wide as a letter is high.
      return list.clientWidth - Number.parseFloat(paddingLeft) - Number.parseFloat(paddingRight) - 18 - wide;
    });
    assert.ok(room >= 0, `${room} pixels of ${viewport.width}`);
  }
});

test('a page without JavaScript says what it needs', async () => {
  const opened = await openBlank({ javaScriptEnabled: false });
  await opened.goto(address());
  const said = opened.locator('noscript p');
  await said.waitFor();
  assert.match(await said.innerText(), /which are switched off here/);
});

test('a page that was opened as a file says what it needs', async () => {
  const opened = await openBlank();
  await opened.goto(new URL('../dist/index.html', import.meta.url).href);
  await opened.locator('#where', { hasText: 'it needs a web server' }).waitFor();
});

test('long names of gaits fit on their buttons', async () => {
  for (const options of [PORTRAIT, { viewport: { width: 1400, height: 1000 } }]) {
    const opened = await openStanding(options);
    await opened.locator('#robot').selectOption('own-gaits');
    await opened.waitForFunction(() => window.lizard.file === 'own-gaits');
    const buttons = await opened.locator('#gaits button').evaluateAll((buttons) =>
      buttons.map((button) => ({
        name: button.dataset.command,
        height: button.offsetHeight,
        outside: button.scrollWidth - button.clientWidth,
      })),
    );
    assert.ok(buttons.some(({ name }) => name.length > 40));
    for (const { name, height, outside } of buttons) {
      assert.ok(height <= 90, `${name}: ${height} pixels high`);
      assert.ok(outside <= 0, `${name}: ${outside} pixels too wide`);
    }
  }
});

test('robots that are for the tests are listed last, under a heading', async () => {
  const opened = await page();
  const [plain, tests] = await opened.evaluate(() =>
    ['#robot > option', '#robot > optgroup[label="for tests"] > option'].map((selector) =>
      [...document.querySelectorAll(selector)].map(({ value }) => value),
    ),
  );
  assert.deepEqual(plain, ['robot', 'grain', 'large', 'paper']);
  assert.deepEqual(tests, ['own-gaits', 'unequal']);
});

test('a word that the core spells differently is reported as unknown', async () => {
  const opened = await openBlank();
  const wasm = await readFile(new URL('../dist/files/lizard.wasm', import.meta.url), 'latin1');
  assert.ok(wasm.includes('factory'));
  const body = Buffer.from(wasm.replaceAll('factory', 'faktory'), 'latin1');
  await opened.route('**/lizard.wasm', (route) => route.fulfill({ body, contentType: 'application/wasm' }));
  await opened.goto(address());
  await opened.locator('#trouble', { hasText: 'The core does not know these words of the page: factory.' }).waitFor();
});

test('the core knows every word that a button sends', async () => {
  const opened = await openStanding();
  assert.equal(await opened.locator('#trouble').isVisible(), false);
  const sent = await opened.locator('[data-command]').evaluateAll((buttons) => buttons.map(({ dataset }) => dataset.command));
  const { words, gaits } = await opened.evaluate(() => window.lizard.description);
  const known = [...words, ...gaits.map(({ command }) => command)];
  assert.deepEqual(sent.filter((command) => !known.includes(command)), []);
  assert.ok(sent.length >= 10);
});

test('a script that is not the page\'s own does not run', async () => {
  const opened = await page();
  const blocked = opened.waitForEvent('console', (message) => /Content Security Policy/.test(message.text()));
  await opened.evaluate(() => {
    const script = document.createElement('script');
    script.textContent = 'window.strange = true';
    document.body.append(script);
  });
  await blocked;
  assert.equal(await opened.evaluate(() => window.strange), undefined);
  complaints.splice(0, complaints.length, ...complaints.filter((said) => !/Content Security Policy/.test(said)));
});

test('the browser reported no error or warning', () => assert.deepEqual(complaints, []));
