// A cable that is pulled at any moment: what the page then says of the board is held to the board's own bytes.
import assert from 'node:assert/strict';
import { after, afterEach, before, test } from 'node:test';

import { openWithBoard, until } from './board.js';
import { close, closePages, complaints, open, text, unfold } from './browser.js';
import { imageOf } from './image.js';

before(open);
afterEach(closePages);
after(close);

/** SEED names other moments. */
let seed = Number(process.env.SEED ?? 1);
const random = () => ((seed = (seed * 1103515245 + 12345) % 2147483648) >> 8) / 8388608;
/** Moments in a time of so many ms, one in each of `count` equal parts. */
const moments = (count, ms) => Array.from({ length: count }, (_, n) => Math.round(((n + random()) / count) * ms));
const START = 0x6e00;
const bytes = async (opened, memory, from, to) => Buffer.from(await opened.evaluate(([memory, from, to]) => Array.from(window.otherBoard[memory].slice(from, to)), [memory, from, to]));
const isConnected = async (opened) => (await text(opened, '#connect')) === 'Back to the simulation';

/** Pulls the cable, which takes the board's power, too. */
async function pull(opened) {
  await opened.evaluate(() => window.unplug());
  await until(opened, 'the board is said to be gone', async () => !(await isConnected(opened)) && opened.locator('#connect').isEnabled());
}

/** Plugs in the same board, or another one with a robot. */
async function plug(opened, robot) {
  await opened.evaluate((robot) => Object.assign(window, { same: robot === undefined, flashed: robot }), robot);
  await opened.locator('#connect').click();
  await until(opened, 'the board greets', async () => /^on a board on USB/.test(await text(opened, '#where')));
}

test('a robot is said to be written only if its bytes are on the board, wherever the cable is pulled', async (t) => {
  const opened = await openWithBoard('large', 8000);
  await unfold(opened, '#flash');
  const whole = (await imageOf('robot')).subarray(START);
  const large = await bytes(opened, 'flash', START, START + whole.length);
  const found = { written: 0, part: 0, untouched: 0 };
  for (const ms of moments(10, 1500)) {
    await opened.locator('#flash-robot').click();
    await opened.clock.runFor(ms);
    await pull(opened);
    await until(opened, 'the page says what became of it', async () => /^(not )?written/.test(await text(opened, '#flash-said')));
    const said = await text(opened, '#flash-said');
    const has = await bytes(opened, 'flash', START, START + whole.length);
    const is = has.equals(whole) ? 'whole' : has.equals(large) ? 'untouched' : 'part';
    t.diagnostic(`pulled after ${ms} ms: the bytes are ${is}, and the page says "${said}"`);
    if (/^written and verified/.test(said)) {
      assert.equal(is, 'whole', said);
      found.written += 1;
    } else {
      assert.match(said, /^not written: (the board (is not connected any more|does not answer)|no boot loader answers)/);
      if (/half a robot now/.test(said)) assert.notEqual(is, 'untouched', said);
      else assert.equal(is, 'untouched', said);
      found[/half a robot now/.test(said) ? 'part' : 'untouched'] += 1;
    }
    await plug(opened, 'large');
    await opened.clock.runFor(1000);
  }
  for (const [which, times] of Object.entries(found)) assert.ok(times > 0, `no cut left it ${which}`);
});

test('a calibration is said to be saved only if the board begins with it, wherever the cable is pulled', async (t) => {
  const opened = await openWithBoard('robot', 8000);
  const setup = opened.locator('#setup');
  const press = (name) => setup.getByRole('button', { name, exact: true }).click();
  const step = (name) => setup.getByRole('list', { name: 'Steps' }).getByRole('button', { name: new RegExp(`${name}$`) }).click();
  const said = () => text(opened, '#setup-said');
  const trim = () => opened.evaluate(async () => (await window.lizard.ask('cal')).notes.find((line) => line.startsWith('# A3 trim')).split(' ')[3]);
  const found = { saved: 0, kept: 0 };
  await setup.scrollIntoViewIfNeeded();
  for (const ms of moments(8, 300)) {
    await step('Trims');
    await press('A3 back right');
    await press('↺ 0.5°');
    await until(opened, 'the trim is set', async () => /^The trim of A3 is/.test(await said()));
    const wanted = Number(/is (-?[\d.]+)°/.exec(await said())[1]);
    await step('Keep');
    await press('Save in the board');
    await opened.clock.runFor(ms);
    const isSaid = /^Saved: /.test(await said());
    await pull(opened);
    assert.equal(/^Saved: /.test(await said()) && !isSaid, false, 'nothing is saved after the cable was pulled');
    await plug(opened);
    await opened.clock.runFor(3000);
    const asked = trim();
    await opened.clock.runFor(500);
    const has = Number(await asked);
    t.diagnostic(`pulled after ${ms} ms: ${isSaid ? 'said to be saved' : 'not said to be saved'}, and the board begins with ${has} deg of ${wanted}`);
    if (isSaid) assert.equal(has, wanted);
    else assert.ok([wanted, wanted - 0.5].some((either) => Math.abs(has - either) < 0.01), `${has} deg is neither the old trim nor the new one`);
    found[isSaid ? 'saved' : 'kept'] += 1;
  }
  for (const [which, times] of Object.entries(found)) assert.ok(times > 0, `no cut left it ${which}`);
});

test('nothing was complained of', () => assert.deepEqual(complaints, []));
