// "Make it faster": the search finds the gait of `lizard tune`, can be stopped, and rejects impossible requests.
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { join, resolve } from 'node:path';
import { test } from 'node:test';
import { promisify } from 'node:util';

import { findViolations } from './axe.js';
import { advance, measureOverflow, openUnfolded, readText, withTimeout, useBrowser, typeLength, waitForNewGait, testPage, waitForPrediction, readToml } from './browser.js';

const ROOT = new URL('../../', import.meta.url).pathname;

useBrowser();

/** Opens the gait editor with a gait of the robot, and sets the numbers of a search; `maxServoSpeed` is in deg/s. */
async function openEditor({ gait = 'walk', rounds = 1, seed = 3, maxServoSpeed = '' } = {}, options = {}) {
  const page = await openUnfolded('#gait-editor', options);
  await waitForPrediction(page);
  await page.locator('#gait-from').selectOption({ label: gait });
  await page.getByLabel('Servos at most').fill(String(maxServoSpeed));
  await page.getByLabel('Rounds of 40 gaits').fill(String(rounds));
  await page.getByLabel('Seed of the random numbers').fill(String(seed));
  return page;
}

const startSearch = (page) => page.getByRole('button', { name: 'Make it faster' }).click();
const waitForSearchEnd = (page) => page.waitForFunction(() => document.querySelector('#faster-start').textContent === 'Make it faster' && document.querySelector('#faster-message').textContent !== '');
/** Waits until the search has tried `count` gaits. */
const waitForTriedGaits = (page, count) => page.waitForFunction((count) => document.querySelector('#faster-progress').value >= count, count);

async function stopSearch(page) {
  await page.getByRole('button', { name: 'Stop the search' }).click();
  await waitForSearchEnd(page);
}

/** Searches until `count` gaits have been tried. */
async function searchUntil(page, count) {
  await startSearch(page);
  await waitForTriedGaits(page, count);
  await stopSearch(page);
}

/** Waits until the robot walks with the found gait. */
const waitForFoundGait = (page) => waitForNewGait(page, 'mine', '[gait.mine]');

/** Stops the robots and returns the distances that they have walked. */
async function stopAndReadDistances(page) {
  await page.keyboard.press('Escape');
  await advance(page, 1000);
  return readText(page, '#faster-distances');
}

testPage('the search finds the gait of lizard tune with the same seed, which the user can try and undo', openEditor, async (page) => {
  const loadedPaths = [];
  page.on('request', (request) => loadedPaths.push(new URL(request.url()).pathname));
  const args = ['tune', '--rounds', '1', '--seed', '3', '--name', 'mine', '--json', '--robot', join(ROOT, 'robot.toml')];
  const [{ stdout }] = await Promise.all([
    withTimeout('lizard tune', promisify(execFile)(resolve(ROOT, process.env.LIZARD), args)),
    startSearch(page).then(() => waitForSearchEnd(page)),
  ]);
  assert.equal(loadedPaths.filter((path) => path.endsWith('/files/tune.wasm')).length, 1, 'the search is loaded once, when it is started');
  const tuneResult = JSON.parse(stdout);
  const gainPercent = Math.round(100 * (tuneResult.tuned.speeds[0] / tuneResult.gait.speeds[0] - 1));
  assert.equal(
    await readText(page, '#faster-message'),
    `Faster on ${tuneResult.faster} of 200 random robots and floors; the speed that 95 % of them exceed is ${gainPercent} % higher. No servo turns faster than ${tuneResult.rate.toFixed(0)} °/s.`,
  );
  const previousTable = await readText(page, '#gait-table');
  const distanceText = await readText(page, '#gait-distance');
  const readRows = () => page.locator('#faster-rows tr').allInnerTexts();
  const [, distanceRow] = (await readRows()).map((row) => row.split('\t'));
  assert.deepEqual(distanceRow.slice(0, 2), ['distance per cycle', distanceText]);
  await page.getByRole('button', { name: 'Use this gait' }).click();
  await page.waitForFunction((previousTable) => document.querySelector('#gait-table').textContent !== previousTable, previousTable);
  assert.equal(await readText(page, '#gait-table'), tuneResult.fragment);
  assert.equal(await readText(page, '#gait-distance'), distanceRow[2]);
  // Undoes the change, and makes it again.
  await page.getByRole('button', { name: 'Back to the previous gait' }).click();
  await page.waitForFunction((previousTable) => document.querySelector('#gait-table').textContent === previousTable, previousTable);
  await page.getByRole('button', { name: 'Use this gait' }).click();
  await page.waitForFunction((fragment) => document.querySelector('#gait-table').textContent === fragment, tuneResult.fragment);
  await page.locator('#gait-try').click();
  await waitForFoundGait(page);
  assert.ok((await readToml(page)).includes(tuneResult.fragment));
  await page.locator('#robot-undo').click();
  await page.waitForFunction(() => !window.lizard.robot.toml.includes('[gait.mine]'));
});

testPage('a search stopped midway returns the best gait so far, and the page can search again', () => openEditor({ rounds: 200 }), async (page) => {
  await searchUntil(page, 21);
  const message = await readText(page, '#faster-message');
  const [, triedCount] = /^Stopped after (\d+) of 8040 gaits\. Faster on \d+ of 200 random robots/.exec(message) ?? assert.fail(message);
  assert.ok(Number(triedCount) >= 21 && Number(triedCount) < 8040, message);
  assert.ok(await page.locator('#faster-progress').isHidden());
  await page.getByRole('button', { name: 'Use this gait' }).click();
  await page.waitForFunction(() => Number(document.querySelector('#gait-amplitude').value) > 20);
  // The next search starts from the gait in use.
  await startSearch(page);
  await waitForTriedGaits(page, 1);
  assert.ok(await page.locator('#faster-result').isHidden());
  await stopSearch(page);
});

testPage('the found gait walks beside the previous gait, and is faster by the predicted ratio', () => openEditor({ rounds: 200 }), async (page) => {
  await page.locator('#button-3d').click();
  await searchUntil(page, 21);
  const rows = await page.locator('#faster-rows tr').allInnerTexts();
  const [, previousSpeed, foundSpeed] = rows.map((row) => row.split('\t')).find(([name]) => name === 'speed').map(Number.parseFloat);
  assert.ok(foundSpeed > previousSpeed, rows.join());
  await page.getByRole('button', { name: 'See both walk' }).click();
  assert.ok(await page.locator('#canvas-3d').isHidden(), 'the drawing from above shows both robots');
  await waitForFoundGait(page);
  await advance(page, 8000);
  await page.waitForFunction(() => /^Found: [0-9.]+ mm.*\. Before: [0-9.]+ mm/.test(document.querySelector('#faster-distances').textContent));
  const comparison = await stopAndReadDistances(page);
  const [, foundDistance, previousDistance] = /^Found: ([0-9.]+) mm.*\. Before: ([0-9.]+) mm/.exec(comparison) ?? assert.fail(comparison);
  assert.ok(Math.abs(foundDistance / previousDistance / (foundSpeed / previousSpeed) - 1) < 0.1, `${comparison} Predicted: ${foundSpeed} mm/s, before ${previousSpeed} mm/s`);
  assert.ok(await page.locator('#faster-result').isVisible(), 'the result stays visible');
  assert.equal((await readToml(page)).match(/\[gait\.mine\]/g).length, 1);
});

testPage('the found turn is faster by the predicted ratio, and the page shows both angles', () => openEditor({ gait: 'left', rounds: 200 }), async (page) => {
  // The robot's own turn cannot be made faster, so the search starts with half the stroke of the front legs.
  for (const [leg, gain] of [['LF', '-0.5'], ['RF', '0.5']]) {
    await page.getByLabel(`${leg} gain`).fill(gain);
    await page.keyboard.press('Tab');
  }
  await searchUntil(page, 41);
  const rows = (await page.locator('#faster-rows tr').allInnerTexts()).map((row) => row.split('\t'));
  const [, previousSpeed, foundSpeed] = rows.find(([name]) => name === 'speed');
  assert.ok([previousSpeed, foundSpeed].every((speed) => /^[0-9.]+ °\/s$/.test(speed)), `${previousSpeed} and ${foundSpeed}`);
  const predictedRatio = Number.parseFloat(foundSpeed) / Number.parseFloat(previousSpeed);
  assert.ok(predictedRatio > 1.2, `${previousSpeed} and ${foundSpeed}`);
  await page.getByRole('button', { name: 'See both walk' }).click();
  await waitForFoundGait(page);
  await advance(page, 40_000);
  const comparison = await stopAndReadDistances(page);
  const [, foundAngle, previousAngle] = /^Found: .*?(-?[0-9.]+)°\. Before: .*?(-?[0-9.]+)°\.$/.exec(comparison) ?? assert.fail(comparison);
  assert.ok(Math.abs(foundAngle / previousAngle / predictedRatio - 1) < 0.1, `${comparison} Predicted: ${foundSpeed}, before ${previousSpeed}`);
  assert.ok(Number(foundAngle) > 360, `${foundAngle} is not more than a full turn`);
});

testPage('changing the robot ends the search for the previous robot', () => openEditor({ rounds: 200 }), async (page) => {
  await startSearch(page);
  await waitForTriedGaits(page, 1);
  await typeLength(page, 'links.l12', 46);
  await page.waitForFunction(() => window.lizard.robot.toml !== window.lizard.robot.original);
  await waitForSearchEnd(page);
  assert.equal(await readText(page, '#faster-message'), 'The robot has changed; the search for the previous robot has ended.');
  assert.ok((await page.locator('#faster-progress').isHidden()) && (await page.locator('#faster-result').isHidden()));
});

// With servos this slow, no stride is better than that of `left`.
testPage('the page reports a gait that cannot be made faster', () => openEditor({ gait: 'left', maxServoSpeed: 200, seed: 1 }), async (page) => {
  await startSearch(page);
  await waitForSearchEnd(page);
  assert.equal(await readText(page, '#faster-message'), 'No gait was found that is faster both on most of the random robots and floors and on the slowest of them. More rounds or another seed may find one.');
  assert.ok(await page.locator('#faster-result').isHidden());
});

testPage('an impossible search is refused with a message, and a number out of range is ignored', () => openEditor({ gait: 'arc-left' }), async (page) => {
  await startSearch(page);
  await waitForSearchEnd(page);
  assert.match(await readText(page, '#faster-message'), /^This gait cannot be made faster: the gait `mine` walks along a curve; /);
  await page.locator('#gait-from').selectOption({ label: 'walk' });
  const speedInput = page.getByLabel('Servos at most');
  await speedInput.fill('900');
  await startSearch(page);
  await page.waitForFunction(() => document.querySelector('#faster-message').textContent.includes('900'));
  assert.equal(await readText(page, '#faster-message'), 'This gait cannot be made faster: servo speed 900: must be between 10 and 310 deg/s (limits.gait_slew in robot.toml).');
  await speedInput.fill('5');
  assert.equal(await speedInput.getAttribute('aria-invalid'), 'true');
  await page.keyboard.press('Tab');
  assert.equal(await speedInput.inputValue(), '900', 'the input shows the last number in range');
});

test('the search works by keyboard alone, fits a phone, and passes axe-core', async () => {
  const page = await openEditor({ rounds: 200 }, { viewport: { width: 320, height: 640 }, bypassCSP: true });
  await page.getByLabel('Seed of the random numbers').focus();
  await page.keyboard.press('Tab');
  assert.equal(await page.evaluate(() => document.activeElement.id), 'faster-start');
  await page.keyboard.press('Enter');
  await page.locator('#faster-result').waitFor();
  assert.equal(await measureOverflow(page), 0);
  assert.deepEqual(await findViolations(page, '.faster'), []);
  await page.keyboard.press('Enter');
  await waitForSearchEnd(page);
  assert.match(await readText(page, '#faster-message'), /^Stopped after /);
  assert.equal(await page.evaluate(() => document.activeElement.id), 'faster-start', 'the focus stays');
});
