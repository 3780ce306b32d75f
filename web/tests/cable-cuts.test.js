// The cable is pulled at random moments: the page's message about the board is compared with the board's memory.
import assert from 'node:assert/strict';

import { openWithBoard, runUntil, connect, readFlash, waitForText } from './board.js';
import { readText, useBrowser, testPage } from './browser.js';
import { makeImage, SECTION_START } from './flash-image.js';

useBrowser();

/** Seed of the random moments; the environment variable SEED sets another. */
let seed = Number(process.env.SEED ?? 1);
const random = () => ((seed = (seed * 1103515245 + 12345) % 2147483648) >> 8) / 8388608;
/** Returns random moments, ms, one in each of `count` equal parts of a duration of `ms`. */
const makeRandomMomentsMs = (count, ms) => Array.from({ length: count }, (_, n) => Math.round(((n + random()) / count) * ms));
const isConnected = async (page) => (await readText(page, '#connect')) === 'Back to the simulation';

/** Pulls the cable; the board also loses its power. */
async function pullCable(page) {
  await page.evaluate(() => window.unplug());
  await runUntil(page, 'the page shows that the board is gone', async () => !(await isConnected(page)) && page.locator('#connect').isEnabled());
}

/** Plugs in the same board, or another board with the named robot. */
async function plugIn(page, robotName) {
  await connect(page, { isSameBoard: robotName === undefined, flashedRobot: robotName });
  await waitForText(page, '#where', /^on a board on USB/);
}

testPage('after any cut, the page reports a robot as written only if its bytes are on the board', () => openWithBoard('large'), async (page, t) => {
  const robotBytes = (await makeImage('robot')).subarray(SECTION_START);
  const largeBytes = await readFlash(page, SECTION_START, SECTION_START + robotBytes.length);
  const counts = { written: 0, partial: 0, untouched: 0 };
  for (const ms of makeRandomMomentsMs(10, 1500)) {
    await page.locator('#flash-robot').click();
    await page.clock.runFor(ms);
    await pullCable(page);
    await waitForText(page, '#flash-message', /^(not )?written/);
    const message = await readText(page, '#flash-message');
    const boardBytes = await readFlash(page, SECTION_START, SECTION_START + robotBytes.length);
    const outcome = boardBytes.equals(robotBytes) ? 'complete' : boardBytes.equals(largeBytes) ? 'untouched' : 'partial';
    t.diagnostic(`pulled after ${ms} ms: the bytes are ${outcome}, and the page reports "${message}"`);
    if (/^written and verified/.test(message)) {
      assert.equal(outcome, 'complete', message);
      counts.written += 1;
    } else {
      assert.match(message, /^not written: (the board (is no longer connected|does not answer)|no boot loader answers)/);
      if (/an incomplete robot/.test(message)) assert.notEqual(outcome, 'untouched', message);
      else assert.equal(outcome, 'untouched', message);
      counts[/an incomplete robot/.test(message) ? 'partial' : 'untouched'] += 1;
    }
    await plugIn(page, 'large');
    await page.clock.runFor(1000);
  }
  for (const [outcome, count] of Object.entries(counts)) assert.ok(count > 0, `no trial had the outcome ${outcome}`);
});

testPage('after any cut, the page reports a calibration as saved only if the board starts with it', openWithBoard, async (page, t) => {
  const setup = page.locator('#setup');
  const press = (name) => setup.getByRole('button', { name, exact: true }).click();
  const openStep = (name) => setup.getByRole('list', { name: 'Steps' }).getByRole('button', { name: new RegExp(`${name}$`) }).click();
  const readMessage = () => readText(page, '#setup-message');
  const readTrim = () => page.evaluate(async () => (await window.lizard.board.ask('cal')).notes.find((line) => line.startsWith('# A3 trim')).split(' ')[3]);
  const counts = { saved: 0, kept: 0 };
  await setup.scrollIntoViewIfNeeded();
  for (const ms of makeRandomMomentsMs(8, 300)) {
    await openStep('Trims');
    await press('A3 back right');
    await press('↺ 0.5°');
    await waitForText(page, '#setup-message', /^The trim of A3 is/);
    const expectedTrim = Number(/is (-?[\d.]+)°/.exec(await readMessage())[1]);
    await openStep('Keep');
    await press('Save in the board');
    await page.clock.runFor(ms);
    const isReportedSaved = /^Saved: /.test(await readMessage());
    await pullCable(page);
    assert.equal(/^Saved: /.test(await readMessage()) && !isReportedSaved, false, 'no report after the cut');
    await plugIn(page);
    await page.clock.runFor(3000);
    const pendingTrim = readTrim();
    await page.clock.runFor(500);
    const boardTrim = Number(await pendingTrim);
    t.diagnostic(`pulled after ${ms} ms: ${isReportedSaved ? 'reported as saved' : 'not reported as saved'}, and the board starts with a trim of ${boardTrim} deg, set to ${expectedTrim} deg`);
    if (isReportedSaved) assert.equal(boardTrim, expectedTrim);
    else assert.ok([expectedTrim, expectedTrim - 0.5].some((possibleTrim) => Math.abs(boardTrim - possibleTrim) < 0.01), `${boardTrim} deg is neither the old trim nor the new trim`);
    counts[isReportedSaved ? 'saved' : 'kept'] += 1;
  }
  for (const [outcome, count] of Object.entries(counts)) assert.ok(count > 0, `no trial had the outcome ${outcome}`);
});
