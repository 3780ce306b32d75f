// The layout of the page stays as it is from the first picture on, with narrow and with wide letters, and the view of the floor
// follows the floor's size.
import assert from 'node:assert/strict';
import { after, afterEach, before, test } from 'node:test';

import { address, advance, openBlank, close, open, openStanding, closePages } from './browser.js';

before(open);
afterEach(closePages);
after(close);

/** Left, top, width and height of everything that has a border, CSS pixels. */
const places = (opened) =>
  opened.evaluate(() =>
    [...document.querySelectorAll('header, section, details, canvas, button, select, input')].map((each) => {
      const { left, top, width, height } = each.getBoundingClientRect();
      return [each.id || each.dataset.command || each.className, left, top + scrollY, width, height];
    }),
  );

/** Gives all letters a height relative to the font's size; their width goes with it. */
function setLetters(height) {
  const sheet = new CSSStyleSheet();
  sheet.replaceSync(`* { font-size-adjust: ${height} }`);
  document.adoptedStyleSheets = [sheet];
}

for (const [letters, height] of [
  ['narrow', 0.45],
  ['wide', 0.62],
]) {
  for (const [width, pixels] of [
    [1400, 700],
    [1280, 800],
    [390, 844],
  ]) {
    test(`nothing moves after the first picture: ${letters} letters, ${width} x ${pixels} pixels`, async () => {
      const opened = await openBlank({ viewport: { width, height: pixels } });
      await opened.addInitScript(setLetters, height);
      // Without the predictions that come with the page, as for a user's own robot.
      await opened.route(/predictions/, (route) => route.fulfill({ status: 404 }));
      let predict;
      const asked = new Promise((done) => (predict = done));
      await opened.route(/robot-worker/, (route) => asked.then(() => route.continue()));
      await opened.goto(`${address()}#room=drive`);
      await opened.waitForFunction(() => document.querySelector('#floor').dataset.zoom);
      const first = await places(opened);
      assert.ok(first.length > 100);
      await advance(opened, 2500);
      await opened.waitForFunction(() => /^on a simulated UNO/.test(document.querySelector('#where').textContent));
      assert.deepEqual(await places(opened), first, 'the robot has started');
      predict();
      await opened.waitForFunction(() => {
        const way = (gait) => document.querySelector(`#gaits button[data-command="${gait.command}"] small`).textContent;
        return window.lizard.description.gaits.filter(({ moves }) => moves).every(way);
      });
      assert.deepEqual(await places(opened), first, 'the predictions are there');
    });
  }
}

/** The view's zoom, CSS pixels per mm, and the zoom at which 420 mm of the floor fit. */
const zooms = (opened) =>
  opened.evaluate(async () => {
    // The next picture is drawn with the current size.
    for (let n = 0; n < 3; n++) await new Promise(requestAnimationFrame);
    const { dataset, clientWidth, clientHeight } = document.querySelector('#floor');
    return [dataset.zoom, (Math.min(clientWidth, clientHeight) / 420).toFixed(4)];
  });

test('the view follows the size of the floor until the user zooms, and again from the start', async () => {
  const [large, small] = [{ width: 1400, height: 700 }, { width: 390, height: 568 }];
  const opened = await openStanding({ viewport: large });
  const [first, fitting] = await zooms(opened);
  assert.equal(first, fitting);
  await opened.setViewportSize(small);
  const [followed, less] = await zooms(opened);
  assert.equal(followed, less);
  assert.notEqual(less, fitting);
  await opened.getByRole('button', { name: 'Zoom in' }).click();
  const [chosen] = await zooms(opened);
  assert.equal((chosen / less).toFixed(2), '1.25');
  await opened.setViewportSize(large);
  assert.deepEqual(await zooms(opened), [chosen, fitting], 'what the user has chosen stays');
  await opened.getByRole('button', { name: 'Back to start' }).click();
  await opened.setViewportSize(small);
  assert.deepEqual(await zooms(opened), [less, less]);
});
