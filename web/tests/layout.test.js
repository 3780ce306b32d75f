// The layout of the page does not change after the first frame, with narrow and with wide letters, and the zoom of the
// floor follows the size of its canvas.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { address, advance, openBlankPage, openStanding, useBrowser } from './browser.js';

useBrowser();

/** Returns the name, left, top, width and height of each main element, CSS pixels. */
const readBounds = (page) =>
  page.evaluate(() =>
    [...document.querySelectorAll('header, section, details, canvas, button, select, input')].map((node) => {
      const { left, top, width, height } = node.getBoundingClientRect();
      return [node.id || node.dataset.command || node.className, left, top + scrollY, width, height];
    }),
  );

/** Sets the height of the lower-case letters as a fraction of the font size; all letters scale with it. */
function setXHeight(height) {
  const sheet = new CSSStyleSheet();
  sheet.replaceSync(`* { font-size-adjust: ${height} }`);
  document.adoptedStyleSheets = [sheet];
}

for (const [letters, xHeight] of [['narrow', 0.45], ['wide', 0.62]]) {
  for (const [width, height] of [[1400, 700], [1280, 800], [390, 844]]) {
    test(`the layout does not change after the first frame: ${letters} letters, ${width} x ${height} pixels`, async () => {
      const page = await openBlankPage({ viewport: { width, height } });
      await page.addInitScript(setXHeight, xHeight);
      // Without the stored predictions, as for a user's own robot.
      await page.route(/predictions/, (route) => route.fulfill({ status: 404 }));
      // The worker that predicts is held back until the robot has started.
      let releaseWorker;
      const workerReleased = new Promise((resolve) => (releaseWorker = resolve));
      await page.route(/robot-worker/, (route) => workerReleased.then(() => route.continue()));
      await page.goto(`${address()}#room=drive`);
      await page.waitForFunction(() => document.querySelector('#floor').dataset.zoom);
      const firstBounds = await readBounds(page);
      assert.ok(firstBounds.length > 100);
      await advance(page, 2500);
      await page.waitForFunction(() => /^on a simulated UNO/.test(document.querySelector('#where').textContent));
      assert.deepEqual(await readBounds(page), firstBounds, 'the layout changed when the robot started');
      releaseWorker();
      await page.waitForFunction(() => {
        const getDistanceText = (gait) => document.querySelector(`#gaits button[data-command="${gait.command}"] small`).textContent;
        return window.lizard.robot.description.gaits.filter(({ moves }) => moves).every(getDistanceText);
      });
      assert.deepEqual(await readBounds(page), firstBounds, 'the layout changed when the predictions appeared');
    });
  }
}

/** Returns the view's zoom, CSS pixels per mm, and the zoom at which 420 mm of the floor fit. */
const readZooms = (page) =>
  page.evaluate(async () => {
    // Waits until a frame has been drawn with the current size.
    for (let n = 0; n < 3; n++) await new Promise(requestAnimationFrame);
    const { dataset, clientWidth, clientHeight } = document.querySelector('#floor');
    return [dataset.zoom, (Math.min(clientWidth, clientHeight) / 420).toFixed(4)];
  });

test('the zoom follows the size of the canvas until the user zooms, and again after Back to start', async () => {
  const [large, small] = [{ width: 1400, height: 700 }, { width: 390, height: 568 }];
  const page = await openStanding({ viewport: large });
  const [firstZoom, largeFit] = await readZooms(page);
  assert.equal(firstZoom, largeFit);
  await page.setViewportSize(small);
  const [smallZoom, smallFit] = await readZooms(page);
  assert.equal(smallZoom, smallFit);
  assert.notEqual(smallFit, largeFit);
  await page.getByRole('button', { name: 'Zoom in' }).click();
  const [chosenZoom] = await readZooms(page);
  assert.equal((chosenZoom / smallFit).toFixed(2), '1.25');
  await page.setViewportSize(large);
  assert.deepEqual(await readZooms(page), [chosenZoom, largeFit], 'the zoom that the user has chosen stays');
  await page.getByRole('button', { name: 'Back to start' }).click();
  await page.setViewportSize(small);
  assert.deepEqual(await readZooms(page), [smallFit, smallFit]);
});
