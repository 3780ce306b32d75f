// Drawing a gesture: the point of the head or the tail follows the line; a line out of reach is refused, and a valid
// size is offered.
import assert from 'node:assert/strict';

import { advance, measureOverflow, openUnfolded, useBrowser, waitForNewGait, testPage, PHONE } from './browser.js';

useBrowser();

const readPanelText = (page, id) => page.locator(`#gesture-${id}`).innerText();
const waitForValue = (page, id) => page.waitForFunction((id) => document.querySelector(`#gesture-${id}`).textContent !== '–', id);
/** Waits until the table has the circle of 6 mm radius that `drawCircle` has drawn. */
const waitForCircle = (page) => page.waitForFunction(() => /k = 1, amplitude = [56]\./.test(document.querySelector('#gesture-table').textContent));
const waitForTableChange = (page, table) => page.waitForFunction((table) => document.querySelector('#gesture-table').textContent !== table, table);

async function openPanel(options) {
  const page = await openUnfolded('#gesture-editor', options);
  await waitForValue(page, 'margin');
  return page;
}

/** Returns the screen position of a point in the head's own frame, mm. */
const computeScreenPoint = (page, [x, y]) =>
  page.evaluate(([x, y]) => {
    const point = new DOMPoint(x, -y).matrixTransform(document.querySelector('#gesture-plane').getScreenCTM());
    return [point.x, point.y];
  }, [x, y]);

/** Draws a circle around the head's neutral point with the mouse. */
async function drawCircle(page, radiusMm, cornerCount = 40) {
  await page.locator('#gesture-plane').evaluate((plane) => plane.scrollIntoView({ block: 'center' }));
  const [x, y] = await page.evaluate(() => window.lizard.robot.wasm.workspace(0).neutral);
  for (let n = 0; n <= cornerCount; n++) {
    const angle = (2 * Math.PI * n) / cornerCount;
    const corner = [x + radiusMm * Math.cos(angle), y + radiusMm * Math.sin(angle)];
    await page.mouse.move(...(await computeScreenPoint(page, corner)));
    if (n === 0) await page.mouse.down();
  }
  await page.mouse.up();
}

/** Returns the head's point relative to the middle of the chassis, mm, as the page draws it. */
const readHeadPoint = (page) => page.evaluate(() => window.lizard.robot.last.scene.points[0]);

testPage('a drawn circle is added to robot.toml as the path of the head', openPanel, async (page) => {
  await drawCircle(page, 6);
  await waitForCircle(page);
  assert.equal(await page.locator('#gesture-shape').inputValue(), 'own');
  assert.match(await readPanelText(page, 'table'), /^\[gait\.gesture\]\nperiod = 4\.0\n\[gait\.gesture\.head\]\ncentre = /);
  const neutral = await readHeadPoint(page);
  await page.locator('#gesture-try').click();
  await waitForNewGait(page, 'gesture', '[gait.gesture.head]');
  await advance(page, 3000);
  const distances = [];
  for (let n = 0; n < 20; n++) {
    await advance(page, 200);
    const point = await readHeadPoint(page);
    distances.push(Math.hypot(point[0] - neutral[0], point[1] - neutral[1]));
  }
  // At the point of the head, a servo's dead band is a fraction of a mm.
  for (const mm of distances) assert.ok(Math.abs(mm - 6) < 0.8, `${distances.map((mm) => mm.toFixed(2))} mm from the centre of a circle with a radius of 6 mm`);
});

testPage('a line that is too large is refused, and a button offers the largest valid size', openPanel, async (page) => {
  await drawCircle(page, 45);
  const button = page.locator('#gesture-alternatives button', { hasText: 'a size of' });
  await button.waitFor();
  assert.notEqual(await readPanelText(page, 'refusal'), '');
  for (const id of ['try', 'write', 'copy']) assert.ok(await page.locator(`#gesture-${id}`).isDisabled(), id);
  const size = Number(/a size of (\d+) %/.exec(await button.innerText())[1]);
  await button.click();
  await waitForValue(page, 'margin');
  await page.waitForFunction(() => document.querySelector('#gesture-refused').hidden);
  assert.equal(Number(await page.locator('#gesture-size').inputValue()), size);
  await page.locator('#gesture-size').fill(String(size + 1));
  await button.waitFor();
});

testPage('every predefined shape can be chosen, also for the tail', openPanel, async (page) => {
  const previousTable = await readPanelText(page, 'table');
  await page.locator('#gesture-end').selectOption('tail');
  await waitForTableChange(page, previousTable);
  assert.match(await readPanelText(page, 'table'), /\[gait\.gesture\.tail\]/);
  for (const shape of ['circle', 'side', 'nod', 'eight']) {
    const table = await readPanelText(page, 'table');
    await page.locator('#gesture-shape').selectOption(shape);
    await waitForTableChange(page, table);
    assert.ok(await page.locator('#gesture-refused').isHidden(), `${shape}: ${await readPanelText(page, 'refusal')}`);
  }
});

testPage('a tap does not count as a line, and the message says so', openPanel, async (page) => {
  const previousTable = await readPanelText(page, 'table');
  await page.locator('#gesture-plane').evaluate((plane) => plane.scrollIntoView({ block: 'center' }));
  await page.locator('#gesture-plane').click();
  assert.equal(await readPanelText(page, 'message'), 'A tap is not a line: press, hold and draw.');
  assert.equal(await readPanelText(page, 'table'), previousTable);
});

testPage('without a line there are no results, and nothing can be tried, written or copied', openPanel, async (page) => {
  await page.locator('#gesture-shape').selectOption('own');
  assert.deepEqual([await readPanelText(page, 'table'), await readPanelText(page, 'margin')], ['', '–']);
  for (const id of ['try', 'write', 'copy']) assert.ok(await page.locator(`#gesture-${id}`).isDisabled(), id);
});

testPage('a finger draws on a phone, and the page does not scroll meanwhile', () => openPanel(PHONE), async (page) => {
  assert.equal(await page.locator('#gesture-plane').evaluate((plane) => getComputedStyle(plane).touchAction), 'none');
  await drawCircle(page, 6);
  await waitForCircle(page);
  assert.equal(await measureOverflow(page), 0);
});
