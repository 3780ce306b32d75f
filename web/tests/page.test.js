// The page in a real browser, used as a person would.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { after, afterEach, before, test } from 'node:test';

import { advance, assertStops, close, closePages, complaints, open, openStanding, page, text, type, unfold } from './browser.js';
import { fakeSerial } from './fake-serial.js';
import { hexOf, imageOf } from './image.js';

before(open);
afterEach(closePages);
after(close);

const gait = (opened, name) => opened.locator(`#gaits button[data-command="${name}"]`);

/** Returns the page's prediction for a gait, and the body's displacement in the last cycle. */
const displacements = (opened, name) =>
  opened.evaluate((name) => {
    const { robot, description } = window.lizard;
    const index = description.gaits.findIndex(({ command }) => command === name);
    return { predicted: robot.predict(index), measured: window.lizard.measured() };
  }, name);

function assertNear(value, wanted, share, what) {
  assert.ok(Math.abs(value - wanted) <= share * Math.abs(wanted), `${what}: ${value}, predicted ${wanted}`);
}

async function assertWalks(opened, name) {
  await gait(opened, name).click();
  await advance(opened, 5500);
  const { predicted, measured } = await displacements(opened, name);
  assert.ok(measured, `${name} has gone on for a whole cycle`);
  return { predicted, measured };
}

test('the banner of the image is seen', async () => {
  const opened = await openStanding();
  assert.match(await text(opened, '#log'), /# lizard \d.* robot [a-z-]+ [0-9a-f]{8}, send help/);
  assert.match(await text(opened, '#where'), /simulated UNO/);
});

test('walk moves the body as predicted', async () => {
  const opened = await openStanding();
  const { predicted, measured } = await assertWalks(opened, 'walk');
  assertNear(measured.forward, predicted.forward, 0.03, 'mm ahead in a cycle');
  assert.ok(Math.abs(measured.turn) < 0.3, `it goes straight: ${measured.turn} deg`);
  await opened.waitForFunction(() => / mm$/.test(document.querySelector('#cycle').textContent));
  assert.equal(await gait(opened, 'walk').getAttribute('aria-pressed'), 'true');
  await assertStops(opened);
});

test('a gait started while a status is pending is not reverted', async () => {
  const opened = await openStanding();
  await opened.evaluate(() => {
    const { lizard } = window;
    const { listener } = lizard;
    const doing = listener.doing.bind(listener);
    window.done = [];
    listener.doing = (gait) => {
      window.done.push(gait);
      doing(gait);
    };
    void lizard.status();
    void lizard.ask('walk');
  });
  await advance(opened, 500);
  assert.deepEqual(await opened.evaluate(() => window.done), ['walk']);
});

test('a pace set while a status is pending is not reverted', async () => {
  const opened = await openStanding();
  await opened.evaluate(() => {
    const { lizard } = window;
    const { listener } = lizard;
    const speed = listener.speed.bind(listener);
    window.paces = [];
    listener.speed = (percent) => {
      window.paces.push(percent);
      speed(percent);
    };
    // All lines arrive at once, as from a port that was busy.
    const { link } = lizard;
    const { onBytes } = link;
    const came = [];
    link.onBytes = (bytes) => came.push(...bytes);
    void lizard.status();
    lizard.advance(30);
    link.board.send([...'speed 60\n'].map((letter) => letter.charCodeAt(0)));
    lizard.advance(60);
    onBytes(Uint8Array.from(came));
    link.onBytes = onBytes;
  });
  await advance(opened, 100);
  assert.deepEqual(await opened.evaluate(() => window.paces), [100, 60]);
  assert.equal(await opened.locator('#speed').inputValue(), '60');
});

test('left turns left', async () => {
  const opened = await openStanding();
  const { predicted, measured } = await assertWalks(opened, 'left');
  assert.ok(predicted.turn > 10);
  assertNear(measured.turn, predicted.turn, 0.03, 'deg in a cycle');
});

test('a singular pose shows its refusal', async () => {
  const opened = await openStanding();
  const answer = await type(opened, 'pose 75 105 318.59 221.41', 'err 4');
  assert.match(answer, /^err 4 type-2 margin of the head/);
});

test('changed lengths make other gaits', async () => {
  const opened = await openStanding();
  const before = (await displacements(opened, 'walk')).predicted;
  const hash = await opened.evaluate(() => window.lizard.description.hash);
  await unfold(opened, '#lengths-panel');
  // Shorter legs make shorter steps.
  const crank = opened.locator('input[name="leg.crank"]');
  await crank.fill('35');
  await crank.press('Enter');
  const has = (value) => opened.waitForFunction((value) => window.lizard.description.lengths.find(({ key }) => key === 'leg.crank').value === value, value);
  await has(35);
  assert.equal(await opened.locator('input[name="leg.follower"]').inputValue(), '35', 'its twin follows');
  await advance(opened, 2500);
  const { predicted, measured } = await assertWalks(opened, 'walk');
  assertNear(predicted.forward, (before.forward * 35) / 45, 0.1, 'shorter steps');
  assertNear(measured.forward, predicted.forward, 0.03, 'mm ahead in a cycle');

  const base = opened.locator('input[name="links.l2"]');
  await base.fill('15');
  await base.press('Enter');
  const refusal = opened.locator('#lengths-refusal');
  await refusal.waitFor();
  assert.match(await refusal.innerText(), /^15 mm is too short: head coupler, (left|right) is 15 mm, which is short beside the rest of its loop/);
  assert.equal(await base.getAttribute('aria-invalid'), 'true');
  assert.equal(await base.inputValue(), '50', 'the box has what the file has');
  assert.equal((await displacements(opened, 'walk')).predicted.forward, predicted.forward, 'the robot of before stays');

  await opened.locator('#lengths-reset').click();
  await has(45);
  assert.equal(await opened.evaluate(() => window.lizard.description.hash), hash);
  assert.equal(await crank.inputValue(), '45');
});

test('every robot of robots/ can be chosen, and is in the image that runs', async () => {
  const opened = await page();
  const names = await opened.locator('#robot option').allInnerTexts();
  assert.ok(names.length >= 5, names.join());
  for (const name of names) {
    await opened.locator('#robot').selectOption({ label: name });
    await opened.waitForFunction((name) => `${window.lizard.file}.toml` === name, name);
    await advance(opened, 2500);
    const { name: called, hash } = await opened.evaluate(() => window.lizard.description);
    assert.equal(await text(opened, '#where'), `on a simulated UNO, robot ${called} ${hash}`);
    await opened.locator('#log div', { hasText: ` ${hash}, send help` }).last().waitFor();
  }
});

/** Moves the trim of A1 by the keyboard, saves, and resets the board. */
async function calibrate(opened, forward) {
  await unfold(opened, '#calibrate');
  await forward(500);
  const trim = opened.locator('#calibration fieldset').first().getByLabel('trim');
  await trim.focus();
  for (let n = 0; n < 8; n++) await trim.press('ArrowRight');
  await forward(1500);
  await opened.locator('#log div', { hasText: /^ok trim 1 2$|^ok trim 1 2\.00$/ }).first().waitFor();
  await opened.locator('#cal-save').click();
  await forward(2500);
  await opened.locator('#log div', { hasText: /^ok save$/ }).waitFor();
  await opened.locator('#reset').click();
  await forward(4000);
  await opened.locator('#cal-factory').click();
  await forward(500);
  await opened.locator('#cal-read').click();
  await forward(500);
  assert.equal(await trim.inputValue(), '0', 'factory takes it back');
  await opened.locator('#cal-load').click();
  await forward(500);
  await opened.locator('#cal-read').click();
  await forward(500);
  assert.equal(await trim.inputValue(), '2', 'it is kept over a reset');
}

test('a calibration is set, saved and kept', async () => {
  const opened = await openStanding();
  await calibrate(opened, (ms) => advance(opened, ms));
});

test('the boot action runs after a reset', async () => {
  const opened = await openStanding();
  await type(opened, 'boot walk', 'ok boot walk');
  await type(opened, 'save', '> save');
  await advance(opened, 2000);
  await opened.locator('#reset').click();
  await advance(opened, 7000);
  await opened.locator('#log div', { hasText: '# boot: walk' }).waitFor();
  assert.ok((await displacements(opened, 'walk')).measured.forward > 20, 'the page knows that it walks');
});

test('a refused setting shows why and takes the slider back', async () => {
  const opened = await openStanding();
  await unfold(opened, '#calibrate');
  await advance(opened, 500);
  const least = opened.locator('#calibration fieldset').first().getByLabel('from, deg');
  await least.fill('125');
  await least.press('Enter');
  await advance(opened, 1000);
  await opened.locator('#cal-said', { hasText: /^err 3 A1 would not reach/ }).waitFor();
  assert.equal(await least.inputValue(), '48.59');
});

/** Chooses the image of another robot, and waits until it is written and has started. */
async function writeImage(opened, forward, where = '') {
  await unfold(opened, '#flash');
  const buffer = Buffer.from(hexOf(await imageOf('large')));
  await opened.getByLabel('HEX file').setInputFiles({ name: 'large.hex', mimeType: 'text/plain', buffer });
  await opened.locator('#flash-what', { hasText: /^large\.hex, \d+ bytes\. It is lizard firmware\./ }).waitFor();
  await opened.locator('#flash-yes').click();
  const said = opened.locator('#flash-said');
  for (let n = 0; n < 400; n++) {
    await forward(100);
    if (/written/.test(await said.innerText())) break;
  }
  assert.match(await said.innerText(), new RegExp(`^written${where} and verified in [\\d.]+ s$`));
  await forward(2500);
  const banners = await opened.locator('#log div', { hasText: '# lizard' }).allInnerTexts();
  return banners.at(-1);
}

test('an image is flashed by the real boot loader', async () => {
  const opened = await openStanding();
  const before = await text(opened, '#log');
  const banner = await writeImage(opened, (ms) => advance(opened, ms), ' to the simulated UNO');
  assert.ok(!before.includes(banner), banner);
  assert.match(await text(opened, '#where'), /with another robot, robot large [0-9a-f]{8}:/);
  const image = await imageOf('large');
  const written = await opened.evaluate((length) => Array.from(window.lizard.link.board.flash.subarray(0, length)), image.length);
  assert.deepEqual(written, Array.from(image));
});

test('an invalid HEX file is refused before anything is written', async () => {
  const opened = await openStanding();
  await unfold(opened, '#flash');
  const input = opened.getByLabel('HEX file');
  await input.setInputFiles({ name: 'x.hex', mimeType: 'text/plain', buffer: Buffer.from('hello\n') });
  await opened.locator('#flash-said', { hasText: "not written: line 1 is not Intel HEX: missing start code ':'" }).waitFor();
  assert.equal((await type(opened, 'status', 'ok gait=')).slice(0, 8), 'ok gait=', 'the robot goes on');
});

test('a board by Web Serial is driven, mirrored, calibrated and flashed', async () => {
  const opened = await page({}, fakeSerial);
  const forward = (ms) => opened.clock.runFor(ms);
  await opened.locator('#connect').click();
  await opened.waitForFunction(() => window.otherBoard);
  await forward(4000);
  assert.match(await text(opened, '#where'), /^on a board on USB, robot paper/);
  await opened.locator('#log div', { hasText: 'ok watch 2' }).waitFor();
  await gait(opened, 'walk').click();
  await forward(5000);
  const { predicted, measured } = await displacements(opened, 'walk');
  assertNear(measured.forward, predicted.forward, 0.05, 'mm ahead in a cycle, from poses of every second frame');
  await opened.keyboard.press('Escape');
  await forward(200);
  await calibrate(opened, forward);
  assert.match(await writeImage(opened, forward), / robot large /);
  assert.match(await text(opened, '#where'), /with another robot, robot large [0-9a-f]{8}:/);
  await opened.locator('#connect').click();
  await forward(2000);
  assert.match(await text(opened, '#where'), /^on a simulated UNO, robot paper/);
});

test('unplugging the board is reported, and the simulation continues', async () => {
  const opened = await page({}, fakeSerial);
  await opened.locator('#connect').click();
  await opened.waitForFunction(() => window.otherBoard);
  await opened.clock.runFor(4000);
  await opened.evaluate(() => window.unplug());
  await opened.locator('#trouble', { hasText: 'The board is gone: The device has been lost.' }).waitFor();
  await opened.clock.runFor(2000);
  assert.match(await text(opened, '#where'), /^on a simulated UNO, robot paper [0-9a-f]{8}$/);
});

test('a supply that sinks stops the robot, and its fault is shown', async () => {
  const opened = await openStanding();
  await assertWalks(opened, 'walk');
  await opened.locator('#supply').fill('3.9');
  await advance(opened, 2000);
  // First, while its room is open, since a hidden panel shows no status; the console is in another room.
  await opened.locator('#health dd', { hasText: 'supply' }).waitFor();
  await opened.locator('#log div', { hasText: '# supply: ' }).first().waitFor();
});

test('pads that grip more in one direction change the prediction', async () => {
  const opened = await openStanding();
  const before = (await displacements(opened, 'back')).predicted.forward;
  await opened.getByLabel('Friction back : ahead').fill('1.5');
  const { predicted, measured } = await assertWalks(opened, 'back');
  assert.notEqual(predicted.forward, before);
  assert.ok(Math.abs(measured.forward - predicted.forward) < 1.5, `${measured.forward} ${predicted.forward}`);
});

/** Sets a slider by the keyboard to a number of steps from its right end. */
async function setFromRight(opened, label, steps) {
  const slider = opened.getByLabel(label);
  await slider.focus();
  await slider.press('End');
  for (let n = 0; n < steps; n++) await slider.press('ArrowLeft');
  return slider.getAttribute('aria-valuetext');
}

test('weak springs shorten the walk as the contact model predicts', async () => {
  const opened = await openStanding();
  // The contact model's own answer, without the loss by a dead band.
  await opened.locator('#servos').selectOption('ideal');
  await opened.locator('#robot').selectOption('paper');
  await opened.waitForFunction(() => window.lizard.file === 'paper');
  await advance(opened, 2500);
  const rigid = (await assertWalks(opened, 'walk')).measured.forward;
  assert.equal(await opened.locator('.sprung').first().isVisible(), false, 'rigid legs do not lag');
  // The table of docs/twin.md: mm per cycle of the paper's robot, and the lag in deg.
  const twin = await readFile(new URL('../../docs/twin.md', import.meta.url), 'utf8');
  const row = (name) => twin.split('\n').find((line) => line.startsWith(`| ${name}`)).split('|').slice(2).map(Number);
  const [pulls, walked, lags] = ['pull in a slotted strut', '`walk`', 'lag in `walk`'].map(row);
  await opened.getByLabel('Driven by').selectOption('strut');
  const slider = opened.getByLabel('Pull in the strut');
  for (const pull of [0.5, 1]) {
    const [mm, lag] = [walked, lags].map((values) => values[pulls.indexOf(pull)]);
    await slider.fill(`${pull}`);
    await slider.dispatchEvent('change');
    await advance(opened, 4000);
    const { predicted, measured } = await displacements(opened, 'walk');
    assertNear(predicted.forward, mm, 0.01, 'mm predicted, as the docs have it');
    // The servos cut the corners of the waveforms, which matters over so short a distance.
    assertNear(measured.forward, predicted.forward, 0.04, 'mm ahead in a cycle');
    assertNear(measured.lag, lag, 0.15, 'deg of lag');
    assertNear(predicted.share, predicted.forward / rigid, 0.03, 'share of rigid legs');
    await opened.locator('#share', { hasText: `${(100 * predicted.share).toFixed(0)} %` }).waitFor();
    await opened.waitForFunction((lag) => document.querySelector('#lag').textContent === lag, `${measured.lag.toFixed(1)}°`);
    const hooked = await opened.evaluate(() => window.lizard.last.scene.legs.every(({ sprung }) => sprung));
    assert.ok(hooked, 'each leg shows its spring');
  }
  // The legs of a heavy robot lag more.
  const light = (await displacements(opened, 'walk')).predicted;
  await setFromRight(opened, 'Mass', 0);
  const heavy = (await displacements(opened, 'walk')).predicted;
  assert.ok(heavy.lag > 1.2 * light.lag, `${heavy.lag} deg with 1 kg, ${light.lag} deg`);
  await opened.locator('#floor-reset').click();
  await advance(opened, 2500);
  const again = await displacements(opened, 'walk');
  assertNear(again.predicted.forward, rigid, 0.03, 'rigid again');
  assertNear(again.measured.forward, rigid, 0.03, 'rigid again');
  assert.deepEqual([again.predicted.lag, again.measured.lag], [null, 0]);
});

test('a foot that is too long shortens the walk as the contact model predicts, and on soft feet not at all', async () => {
  const opened = await openStanding();
  await opened.locator('#servos').selectOption('ideal');
  await advance(opened, 2500);
  const level = (await assertWalks(opened, 'walk')).measured.forward;
  const set = async (label, value) => {
    const slider = opened.getByLabel(label);
    await slider.fill(`${value}`);
    await slider.dispatchEvent('change');
  };
  await set('Front left foot too long', 1);
  await advance(opened, 4000);
  const soft = await displacements(opened, 'walk');
  assertNear(soft.measured.forward, soft.predicted.forward, 0.03, 'mm ahead on soft feet');
  assert.ok(soft.measured.forward > 0.9 * level, `${soft.measured.forward} of ${level} mm`);
  await set('Stiffness of a foot', 3.3);
  await advance(opened, 4000);
  const stiff = await displacements(opened, 'walk');
  assert.ok(Math.abs(stiff.measured.forward - stiff.predicted.forward) < 1.5, JSON.stringify(stiff));
  assert.ok(stiff.measured.forward < 0.3 * level, `${stiff.measured.forward} of ${level} mm`);
  assert.equal(await opened.locator('.sprung').first().isVisible(), false, 'rigid legs do not lag');
});

test('a dead band costs its share of the stroke, as predicted', async () => {
  const opened = await openStanding();
  const went = [];
  for (const servos of ['ideal', 'own']) {
    await opened.locator('#servos').selectOption(servos);
    const { predicted, measured } = await assertWalks(opened, 'walk');
    assertNear(measured.forward, predicted.forward, 0.01, `mm ahead in a cycle, ${servos}`);
    went.push(measured.forward);
  }
  assertNear(went[1] / went[0], 39 / 40, 0.01, 'a degree of 40');
});

test('at half the pace the last cycle is as long as predicted', async () => {
  const opened = await openStanding();
  await type(opened, 'speed 50', 'ok speed 50');
  await type(opened, 'walk', 'ok walk');
  await advance(opened, 8000);
  const number = async (id) => Number.parseFloat(await opened.locator(id).textContent());
  await opened.waitForFunction(() => ['#cycle', '#predicted'].every((id) => document.querySelector(id).textContent.endsWith('mm')));
  const [cycle, predicted] = [await number('#cycle'), await number('#predicted')];
  assert.ok(Math.abs(cycle / predicted - 1) < 0.05, `${cycle} mm, predicted ${predicted}`);
});

test('the browser reported no error or warning', () => {
  assert.deepEqual(complaints, []);
});
