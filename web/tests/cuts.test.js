// A cable that is pulled at any moment: what the page then says of the board is compared with
// the board's own bytes.
import assert from 'node:assert/strict';
import { after, afterEach, before, test } from 'node:test';

import { openWithBoard, until } from './board.js';
import { close, closePages, complaints, open, text, unfold } from './browser.js';
import { imageOf } from './image.js';

before(open);
afterEach(closePages);
after(close);

/** Seed of the random moments; the variable SEED sets another. */
let seed = Number(process.env.SEED ?? 1);
const random = () => ((seed = (seed * 1103515245 + 12345) % 2147483648) >> 8) / 8388608;
/** Returns random moments, ms, one in each of `count` equal parts of a time of `ms`. */
const momentsMs = (count, ms) => Array.from({ length: count }, (_, n) => Math.round(((n + random()) / count) * ms));
const START = 0x6e00;
const readBytes = async (page, memory, from, to) => Buffer.from(await page.evaluate(([memory, from, to]) => Array.from(window.otherBoard[memory].slice(from, to)), [memory, from, to]));
const isConnected = async (page) => (await text(page, '#connect')) === 'Back to the simulation';

/** Pulls the cable, which takes the board's power, too. */
async function pull(page) {
  await page.evaluate(() => window.unplug());
  await until(page, 'the board is said to be gone', async () => !(await isConnected(page)) && page.locator('#connect').isEnabled());
}

/** Plugs in the same board, or another one with a robot. */
async function plug(page, robot) {
  await page.evaluate((robot) => Object.assign(window, { same: robot === undefined, flashed: robot }), robot);
  await page.locator('#connect').click();
  await until(page, 'the board greets', async () => /^on a board on USB/.test(await text(page, '#where')));
}

test('a robot is said to be written only if its bytes are on the board, wherever the cable is pulled', async (t) => {
  const page = await openWithBoard('large', 8000);
  await unfold(page, '#flash');
  const robotBytes = (await imageOf('robot')).subarray(START);
  const largeBytes = await readBytes(page, 'flash', START, START + robotBytes.length);
  const counts = { written: 0, part: 0, untouched: 0 };
  for (const ms of momentsMs(10, 1500)) {
    await page.locator('#flash-robot').click();
    await page.clock.runFor(ms);
    await pull(page);
    await until(page, 'the page says what became of it', async () => /^(not )?written/.test(await text(page, '#flash-said')));
    const message = await text(page, '#flash-said');
    const boardBytes = await readBytes(page, 'flash', START, START + robotBytes.length);
    const outcome = boardBytes.equals(robotBytes) ? 'whole' : boardBytes.equals(largeBytes) ? 'untouched' : 'part';
    t.diagnostic(`pulled after ${ms} ms: the bytes are ${outcome}, and the page says "${message}"`);
    if (/^written and verified/.test(message)) {
      assert.equal(outcome, 'whole', message);
      counts.written += 1;
    } else {
      assert.match(message, /^not written: (the board (is not connected any more|does not answer)|no boot loader answers)/);
      if (/half a robot now/.test(message)) assert.notEqual(outcome, 'untouched', message);
      else assert.equal(outcome, 'untouched', message);
      counts[/half a robot now/.test(message) ? 'part' : 'untouched'] += 1;
    }
    await plug(page, 'large');
    await page.clock.runFor(1000);
  }
  for (const [outcome, count] of Object.entries(counts)) assert.ok(count > 0, `no cut left it ${outcome}`);
});

test('a calibration is said to be saved only if the board begins with it, wherever the cable is pulled', async (t) => {
  const page = await openWithBoard('robot', 8000);
  const setup = page.locator('#setup');
  const press = (name) => setup.getByRole('button', { name, exact: true }).click();
  const openStep = (name) => setup.getByRole('list', { name: 'Steps' }).getByRole('button', { name: new RegExp(`${name}$`) }).click();
  const readMessage = () => text(page, '#setup-said');
  const readTrim = () => page.evaluate(async () => (await window.lizard.ask('cal')).notes.find((line) => line.startsWith('# A3 trim')).split(' ')[3]);
  const counts = { saved: 0, kept: 0 };
  await setup.scrollIntoViewIfNeeded();
  for (const ms of momentsMs(8, 300)) {
    await openStep('Trims');
    await press('A3 back right');
    await press('↺ 0.5°');
    await until(page, 'the trim is set', async () => /^The trim of A3 is/.test(await readMessage()));
    const expectedTrim = Number(/is (-?[\d.]+)°/.exec(await readMessage())[1]);
    await openStep('Keep');
    await press('Save in the board');
    await page.clock.runFor(ms);
    const isSaid = /^Saved: /.test(await readMessage());
    await pull(page);
    assert.equal(/^Saved: /.test(await readMessage()) && !isSaid, false, 'nothing is saved after the cable was pulled');
    await plug(page);
    await page.clock.runFor(3000);
    const pendingTrim = readTrim();
    await page.clock.runFor(500);
    const boardTrim = Number(await pendingTrim);
    t.diagnostic(`pulled after ${ms} ms: ${isSaid ? 'said to be saved' : 'not said to be saved'}, and the board begins with ${boardTrim} deg of ${expectedTrim}`);
    if (isSaid) assert.equal(boardTrim, expectedTrim);
    else assert.ok([expectedTrim, expectedTrim - 0.5].some((possibleTrim) => Math.abs(boardTrim - possibleTrim) < 0.01), `${boardTrim} deg is neither the old trim nor the new one`);
    counts[isSaid ? 'saved' : 'kept'] += 1;
  }
  for (const [outcome, count] of Object.entries(counts)) assert.ok(count > 0, `no cut left it ${outcome}`);
});

test('nothing was complained of', () => assert.deepEqual(complaints, []));
