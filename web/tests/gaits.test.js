// The gait editor: dragged bars make a gait that walks as predicted; a gait that violates a limit is refused with the
// nearest valid value.
import assert from 'node:assert/strict';

import { advance, openUnfolded, reload, unfold, useBrowser, waitForNewGait, testPage, waitForPrediction, readToml } from './browser.js';

useBrowser();

async function openEditor() {
  const page = await openUnfolded('#gait-editor');
  await waitForPrediction(page);
  return page;
}

async function reloadEditor(page) {
  await reload(page);
  await unfold(page, '#gait-editor');
  await waitForPrediction(page);
}

const readEditorText = (page, id) => page.locator(`#gait-${id}`).innerText();
const waitForChange = (page, id, previousText) => page.waitForFunction(([id, previousText]) => document.querySelector(`#gait-${id}`).textContent !== previousText, [id, previousText]);

/** Drags from one phase to another, 0 to 1, on a ring of the circle. Rings count from 0, the outermost, to 3. */
async function drag(page, ring, fromPhase, toPhase) {
  await page.locator('#gait-circle').scrollIntoViewIfNeeded();
  const { x, y, width, height } = await page.locator('#gait-circle').boundingBox();
  const radius = ([104, 82, 60, 38][ring] * Math.min(width, height)) / 240;
  const computePoint = (phase) => [x + width / 2 + radius * Math.sin(2 * Math.PI * phase), y + height / 2 - radius * Math.cos(2 * Math.PI * phase)];
  await page.mouse.move(...computePoint(fromPhase));
  await page.mouse.down();
  const stepPhase = (toPhase - fromPhase) / 10;
  for (let step = 1; step <= 10; step++) await page.mouse.move(...computePoint(fromPhase + stepPhase * step));
  await page.mouse.up();
}

testPage('for an unchanged gait, the editor predicts the distance shown on its button in Drive', openEditor, async (page) => {
  const button = page.locator('#gaits button[data-command="walk"] small');
  await page.waitForFunction(() => document.querySelector('#gaits button[data-command="walk"] small').textContent !== '');
  assert.equal(await readEditorText(page, 'distance'), await button.innerText());
  assert.match(await readEditorText(page, 'table'), /^\[gait\.mine\]\nperiod = 1\.0\nwaveform = "wave"\nduty = 0\.75\namplitude = 20\.0\nstart = /);
});

testPage('the numbers follow a bar and its end while they are dragged', openEditor, async (page) => {
  const previousDistance = await readEditorText(page, 'distance');
  // walk has LF from 0.25 to 0.25 + 0.75.
  await drag(page, 0, 0.5, 0.6);
  assert.ok(Math.abs(Number(await page.getByLabel('LF starts at').inputValue()) - 0.35) < 0.011);
  await waitForChange(page, 'distance', previousDistance);
  await drag(page, 1, 0.5, 0.42);
  assert.ok(Math.abs(Number(await page.locator('#gait-duty').inputValue()) - 0.67) < 0.011);
  // Editing the number fields has the same effect.
  await page.getByLabel('LF starts at').fill('0.25');
  await page.locator('#gait-duty').fill('0.75');
  await page.waitForFunction((distance) => document.querySelector('#gait-distance').textContent === distance, previousDistance);
});

testPage('an edited gait survives a reload, and an invalid stored gait is dropped', openEditor, async (page) => {
  await page.locator('#gait-name').fill('waddle');
  await page.getByLabel('LF starts at').fill('0.35');
  await reloadEditor(page);
  assert.equal(await page.locator('#gait-name').inputValue(), 'waddle');
  assert.equal(await page.getByLabel('LF starts at').inputValue(), '0.35');
  assert.match(await readEditorText(page, 'table'), /^\[gait\.waddle\]/);
  for (const stored of ['{', '3', '{"name":"x","held":false,"period":1,"duty":0.5,"amplitude":20,"start":[0,0,0],"gain":[1,1,1,1]}']) {
    await page.evaluate((stored) => localStorage.setItem(`lizard ${location.pathname} gait`, stored), stored);
    await reloadEditor(page);
    assert.match(await readEditorText(page, 'table'), /^\[gait\.mine\]/);
  }
});

testPage('a value that violates a limit is refused, and a button offers the nearest valid value', openEditor, async (page) => {
  await page.locator('#gait-amplitude').fill('40');
  const button = page.locator('#gait-alternatives button', { hasText: 'amplitude' });
  await button.waitFor();
  assert.match(await readEditorText(page, 'refusal'), /^in "mine" the left front leg would lock: margin leg_lf [0-9.]+ is below 0\.300/);
  assert.ok(await page.locator('#gait-try').isDisabled());
  const value = Number(/amplitude ([0-9.]+)°/.exec(await button.innerText())[1]);
  await button.click();
  await waitForPrediction(page);
  assert.equal(Number(await page.locator('#gait-amplitude').inputValue()), value);
  assert.ok(await page.locator('#gait-refused').isHidden());
  // A tenth of a degree more is refused again, so the offered value is the nearest.
  await page.locator('#gait-amplitude').fill(String(value + 0.1));
  await button.waitFor();
});

testPage('a number out of range, or none, is marked and ignored, and the box restores its value when it loses the focus', openEditor, async (page) => {
  const table = await readEditorText(page, 'table');
  for (const [input, wrongValue, validValue] of [
    [page.locator('#gait-amplitude'), '91', '20'],
    [page.locator('#gait-amplitude'), '', '20'],
    [page.locator('#gait-period'), '0.05', '1'],
    [page.getByLabel('LF starts at'), '1.5', '0.25'],
    [page.getByLabel('RH gain'), '-5', '1'],
  ]) {
    await input.fill(wrongValue);
    assert.equal(await input.getAttribute('aria-invalid'), 'true', wrongValue);
    await page.keyboard.press('Tab');
    assert.deepEqual([await input.inputValue(), await input.getAttribute('aria-invalid')], [validValue, null]);
  }
  // The worker answers in order; after this answer, it has therefore answered all earlier changes.
  await page.locator('#gait-name').fill('other');
  await page.waitForFunction(() => document.querySelector('#gait-table').textContent.startsWith('[gait.other]'));
  assert.equal(await readEditorText(page, 'table'), table.replace('mine', 'other'));
});

testPage('an edited gait is added to robot.toml and walks as far as predicted', openEditor, async (page) => {
  const previousDistance = await readEditorText(page, 'distance');
  await page.locator('#gait-name').fill('stride');
  await page.locator('#gait-amplitude').fill('16');
  await waitForChange(page, 'distance', previousDistance);
  const predictedMm = Number(/^([0-9.]+) mm$/.exec(await readEditorText(page, 'distance'))[1]);
  await page.locator('#gait-try').click();
  await waitForNewGait(page, 'stride', '[gait.stride]');
  await advance(page, 5000);
  const walkedMm = await page.evaluate(() => window.lizard.robot.measureCycle().forward);
  assert.ok(Math.abs(walkedMm - predictedMm) < 0.03 * predictedMm, `distance per cycle: ${walkedMm} mm, predicted ${predictedMm} mm`);
  const toml = await readToml(page);
  assert.ok(toml.includes(await readEditorText(page, 'table')), toml.slice(-400));
  // The reset button of the lengths restores the previous robot.
  await page.locator('#lengths-reset').click();
  await page.waitForFunction(() => !window.lizard.robot.toml.includes('[gait.stride]'));
});

testPage('a backward gait can be edited, and any gait can be reversed', openEditor, async (page) => {
  const forwardMm = Number.parseFloat(await readEditorText(page, 'distance'));
  await page.getByRole('button', { name: 'Reverse' }).click();
  await page.waitForFunction(() => Number.parseFloat(document.querySelector('#gait-distance').textContent) < -1);
  assert.ok(Math.abs(forwardMm + Number.parseFloat(await readEditorText(page, 'distance'))) < 0.3);
  assert.equal(await page.locator('#gait-circle .bar.against').count(), 4);
  assert.equal(await page.getByLabel('LF gain').inputValue(), '-1');
  // `back` of robot.toml is walk in reverse.
  await page.getByRole('button', { name: 'Reverse' }).click();
  await page.waitForFunction(() => Number.parseFloat(document.querySelector('#gait-distance').textContent) > 1);
  await page.locator('#gait-from').selectOption({ label: 'back' });
  await page.waitForFunction(() => Number.parseFloat(document.querySelector('#gait-distance').textContent) < -1);
  const backMm = Number.parseFloat(await page.locator('#gaits button[data-command="back"] small').innerText());
  assert.ok(Math.abs(backMm - Number.parseFloat(await readEditorText(page, 'distance'))) < 0.3);
});

testPage('Swap left and right mirrors a gait', openEditor, async (page) => {
  await page.locator('#gait-from').selectOption({ label: 'arc-left' });
  await page.waitForFunction(() => Number.parseFloat(document.querySelector('#gait-turn').textContent) > 1);
  const turn = Number.parseFloat(await readEditorText(page, 'turn'));
  await page.getByRole('button', { name: 'Swap left and right' }).click();
  await page.waitForFunction(() => Number.parseFloat(document.querySelector('#gait-turn').textContent) < -1);
  assert.ok(Math.abs(turn + Number.parseFloat(await readEditorText(page, 'turn'))) < 0.2);
});
