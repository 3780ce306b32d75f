// Dragging joints on the drawing of the robot: its lengths follow, and a robot that cannot walk is refused during the
// drag.
import assert from 'node:assert/strict';

import { advance, measureOverflow, openUnfolded, startDrag, useBrowser, readLength, waitForLength, testPage, clickAndAdvance, PHONE, readToml } from './browser.js';

useBrowser();

async function openSketch(options) {
  const page = await openUnfolded('#lengths-panel', options);
  await page.locator('#sketch circle').first().waitFor();
  await page.locator('#sketch').evaluate((sketch) => sketch.scrollIntoView({ block: 'center' }));
  return page;
}

const findJoint = (page, name) => page.locator(`#sketch circle[data-joint="${name}"]`);

/** Grabs a joint and moves it to the right and forward in ten steps, without releasing it. */
async function drag(page, name, [rightMm, forwardMm]) {
  // Both positions come from one call, because the page replaces its joints with each response.
  const [from, to] = await page.evaluate(
    ({ name, rightMm, forwardMm }) => {
      const mark = document.querySelector(`#sketch circle[data-joint="${name}"]`);
      const [x, y] = ['cx', 'cy'].map((axis) => Number(mark.getAttribute(axis)));
      return [new DOMPoint(x, y), new DOMPoint(x + rightMm, y - forwardMm)].map((point) => {
        const position = point.matrixTransform(mark.getScreenCTM());
        return [position.x, position.y];
      });
    },
    { name, rightMm, forwardMm },
  );
  await startDrag(page, from, to, 10);
}

const readMessage = (page) => page.locator('#sketch-message').innerText();
const waitForMessage = (page, pattern) => page.waitForFunction((pattern) => new RegExp(pattern).test(document.querySelector('#sketch-message').textContent), pattern.source);

testPage('both couplers follow the dragged point of the head', openSketch, async (page) => {
  const previousLengths = [await readLength(page, 'links.l2'), await readLength(page, 'links.l3')];
  assert.deepEqual(previousLengths, [50, 50]);
  // From the tip of a crank the coupler leads inward and ahead.
  const readPosition = (name) => findJoint(page, name).evaluate((mark) => [Number(mark.getAttribute('cx')), -Number(mark.getAttribute('cy'))]);
  const [tip, point] = [await readPosition("end of the head's left crank"), await readPosition('point of the head')];
  const expectedMm = Math.round(2 * Math.hypot(point[0] - tip[0], point[1] - 4 - tip[1])) / 2;
  await drag(page, 'point of the head', [0, -4]);
  await waitForMessage(page, new RegExp(`^l2 = l3 = ${expectedMm} mm\\.$`));
  assert.equal(await readLength(page, 'links.l2'), 50, 'the length changes only at the release');
  await page.mouse.up();
  await waitForLength(page, 'links.l2', expectedMm);
  assert.equal(await readLength(page, 'links.l3'), expectedMm);
  assert.equal(await page.locator('#lengths input[name="links.l2"]').inputValue(), String(expectedMm));
  // The simulated UNO walks with the new robot.
  await advance(page, 3000);
  await clickAndAdvance(page, '#gaits button[data-command="walk"]', 2000);
  assert.equal(await page.locator('#doing').innerText(), 'walk');
  await page.locator('#robot-undo').click();
  await waitForLength(page, 'links.l2', 50);
});

testPage('a joint released at an invalid place goes to the nearest valid place', openSketch, async (page) => {
  await drag(page, 'point of the head', [0, -40]);
  await waitForMessage(page, /^l2 = l3 = [0-9.]+ mm is too short: /);
  await page.mouse.up();
  await waitForMessage(page, /(The nearest valid value is used: .*|The length stays unchanged)\.$/);
  const expectedMm = Number(/The nearest valid value is used: l2 = l3 = ([0-9.]+) mm\.$/.exec(await readMessage(page))[1]);
  await waitForLength(page, 'links.l2', expectedMm);
});

testPage('a crank becomes longer only on its own side if the sides need not be equal', openSketch, async (page) => {
  await page.locator('#alike').uncheck();
  const [from, to] = await page.evaluate(() => {
    const bar = document.querySelector('#sketch line[data-key="links.l1"]');
    return [['x1', 'y1'], ['x2', 'y2']].map((names) => names.map((name) => Number(bar.getAttribute(name))));
  });
  const barLength = Math.hypot(to[0] - from[0], to[1] - from[1]);
  await drag(page, "end of the head's left crank", [to[0] - from[0], from[1] - to[1]].map((component) => (5 * component) / barLength));
  await waitForMessage(page, /^l1 = 35 mm\.$/);
  await page.mouse.up();
  await waitForLength(page, 'links.l1', 35);
  assert.equal(await readLength(page, 'links.l4'), 30);
});

testPage('lengths that are still being tried do not replace a robot that is loaded meanwhile', openSketch, async (page) => {
  const newToml = await page.evaluate(async () => {
    const slider = document.querySelector('#length-slide');
    slider.valueAsNumber += 1;
    slider.dispatchEvent(new Event('change'));
    await window.lizard.robot.change(window.lizard.robot.toml.replace('amplitude = 15.0', 'amplitude = 14.0'));
    slider.removeAttribute('max');
    return window.lizard.robot.toml;
  });
  // The last response has the slider's range.
  await page.waitForFunction(() => document.querySelector('#length-slide').max !== '');
  assert.equal(await readToml(page), newToml);
});

testPage('a length that is still being tried changes the robot even if another length is chosen meanwhile', openSketch, async (page) => {
  const mm = await page.evaluate(() => {
    const slider = document.querySelector('#length-slide');
    slider.valueAsNumber -= 1;
    const { valueAsNumber } = slider;
    for (const type of ['input', 'change']) slider.dispatchEvent(new Event(type));
    document.querySelector('#lengths input[name="links.l2"]').focus();
    return valueAsNumber;
  });
  await waitForLength(page, 'leg.crank', mm);
});

testPage('a pressed bar selects its number', openSketch, async (page) => {
  await page.locator('#sketch line[data-key="links.l2"]').click({ force: true });
  assert.equal(await page.evaluate(() => document.activeElement.name), 'links.l2');
});

testPage('the drawing has every joint and bar, also on a phone, and a tap changes nothing', () => openSketch(PHONE), async (page) => {
  assert.equal(await page.locator('#sketch circle').count(), 18);
  assert.equal(await page.locator('#sketch line').count(), 36);
  const toml = await readToml(page);
  await findJoint(page, 'point of the tail').tap();
  assert.equal(await readToml(page), toml);
  assert.equal(await measureOverflow(page), 0);
});
