// The page in a real browser, used as a user would use it.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';

import { openWithBoard } from './board.js';
import { advance, assertStops, openStanding, openUnfolded, openPage, readText, sendLine, unfold, useBrowser, chooseRobot, waitForLength, typeLength, testPage, findGaitButton, readDisplacements, repeatUntil, clickAndAdvance } from './browser.js';
import { formatHex, makeImage } from './flash-image.js';

useBrowser();

/** Asserts that a value is near the expected value; `tolerance` is relative to the expected value. */
function assertNear(value, expected, tolerance, quantity) {
  assert.ok(Math.abs(value - expected) <= tolerance * Math.abs(expected), `${quantity}: ${value}, not ${expected}`);
}

/** Starts a gait, lets it run for some cycles, and returns its predicted and its measured displacement in a cycle. */
async function runGait(page, name) {
  await findGaitButton(page, name).click();
  await advance(page, 5500);
  const displacements = await readDisplacements(page, name);
  assert.ok(displacements.measured, `${name} has completed a cycle`);
  return displacements;
}

testPage('the log shows the banner of the image', openStanding, async (page) => {
  assert.match(await readText(page, '#log'), /# lizard \d.* robot [a-z-]+ [0-9a-f]{8}, send help/);
  assert.match(await readText(page, '#where'), /simulated UNO/);
});

testPage('the console shows the latest lines when it is opened', openStanding, async (page) => {
  await page.evaluate(() => {
    for (let n = 0; n < 16; n++) void window.lizard.board.ask('speed 100');
  });
  await advance(page, 2000);
  await unfold(page, '#console');
  await page.waitForFunction(() => {
    const { scrollHeight, scrollTop, clientHeight } = document.querySelector('#log');
    return scrollHeight > 2 * clientHeight && scrollHeight - scrollTop - clientHeight < 2;
  });
});

testPage('walk moves the body as predicted', openStanding, async (page) => {
  const { predicted, measured } = await runGait(page, 'walk');
  assertNear(measured.forward, predicted.forward, 0.03, 'mm ahead in a cycle');
  assert.ok(Math.abs(measured.turn) < 0.3, `walk turns by ${measured.turn} deg per cycle`);
  await page.waitForFunction(() => / mm$/.test(document.querySelector('#cycle').textContent));
  assert.equal(await findGaitButton(page, 'walk').getAttribute('aria-pressed'), 'true');
  await assertStops(page);
});

testPage('a gait started while a status is pending is not reverted', openStanding, async (page) => {
  await page.evaluate(() => {
    const { lizard } = window;
    window.reportedGaits = [];
    lizard.state.gait.subscribe((gait) => window.reportedGaits.push(gait));
    void lizard.board.status();
    void lizard.board.ask('walk');
  });
  await advance(page, 500);
  assert.deepEqual(await page.evaluate(() => window.reportedGaits), ['stand', 'walk']);
});

testPage('a pace set while a status is pending is not reverted', openStanding, async (page) => {
  await page.evaluate(() => {
    const { lizard } = window;
    window.reportedPaces = [];
    lizard.state.pace.subscribe((percent) => window.reportedPaces.push(percent));
    // All lines arrive at once, as from a port that was busy.
    const { link } = lizard.board;
    const { onBytes } = link;
    const receivedBytes = [];
    link.onBytes = (bytes) => receivedBytes.push(...bytes);
    void lizard.board.status();
    lizard.advance(30);
    link.board.send([...'speed 60\n'].map((letter) => letter.charCodeAt(0)));
    lizard.advance(60);
    onBytes(Uint8Array.from(receivedBytes));
    link.onBytes = onBytes;
  });
  await advance(page, 100);
  assert.deepEqual(await page.evaluate(() => window.reportedPaces), [100, 60]);
  assert.equal(await page.locator('#speed').inputValue(), '60');
});

testPage('a pace that the robot has not confirmed does not stay on the slider', openStanding, async (page) => {
  await page.evaluate(() => {
    window.lizard.board.link.write = async () => {};
    const slider = document.querySelector('#speed');
    slider.value = '50';
    for (const name of ['input', 'change']) slider.dispatchEvent(new Event(name));
  });
  assert.equal(await page.locator('#speed-out').textContent(), '50 %');
  await advance(page, 4000);
  await page.locator('#speed-out', { hasText: '100 %' }).waitFor();
  assert.equal(await page.locator('#speed').inputValue(), '100');
});

testPage('left turns left', openStanding, async (page) => {
  const { predicted, measured } = await runGait(page, 'left');
  assert.ok(predicted.turn > 10);
  assertNear(measured.turn, predicted.turn, 0.03, 'deg in a cycle');
});

testPage('a singular pose shows its refusal', openStanding, async (page) => {
  assert.match(await sendLine(page, 'pose 75 105 318.59 221.41', 'err 4'), /^err 4 type-2 margin of the head/);
});

testPage('changed lengths change the gaits', openStanding, async (page) => {
  const previousPrediction = (await readDisplacements(page, 'walk')).predicted;
  const hash = await page.evaluate(() => window.lizard.robot.description.hash);
  // Shorter legs make shorter steps.
  const crank = await typeLength(page, 'leg.crank', 35);
  await waitForLength(page, 'leg.crank', 35);
  assert.equal(await page.locator('input[name="leg.follower"]').inputValue(), '35', 'the paired length follows');
  await advance(page, 2500);
  const { predicted, measured } = await runGait(page, 'walk');
  assertNear(predicted.forward, (previousPrediction.forward * 35) / 45, 0.1, 'shorter steps');
  assertNear(measured.forward, predicted.forward, 0.03, 'mm ahead in a cycle');

  const coupler = await typeLength(page, 'links.l2', 15);
  const refusal = page.locator('#lengths-refusal');
  await refusal.waitFor();
  assert.match(await refusal.innerText(), /^15 mm is too short: head coupler, (left|right) is 15 mm, which is too short relative to the rest of its loop/);
  assert.equal(await coupler.getAttribute('aria-invalid'), 'true');
  assert.equal(await coupler.inputValue(), '50', 'the box shows the value of the file');
  assert.equal((await readDisplacements(page, 'walk')).predicted.forward, predicted.forward, 'the previous robot stays');

  await page.locator('#lengths-reset').click();
  await waitForLength(page, 'leg.crank', 45);
  assert.equal(await page.evaluate(() => window.lizard.robot.description.hash), hash);
  assert.equal(await crank.inputValue(), '45');
});

testPage('every robot of robots/ can be chosen, and the running image contains it', openPage, async (page) => {
  const names = await page.locator('#robot option').allInnerTexts();
  assert.ok(names.length >= 5, names.join());
  for (const name of names) {
    await page.locator('#robot').selectOption({ label: name });
    await page.waitForFunction((name) => `${window.lizard.robot.file}.toml` === name, name);
    await advance(page, 2500);
    const { name: robotName, hash } = await page.evaluate(() => window.lizard.robot.description);
    assert.equal(await readText(page, '#where'), `on a simulated UNO, robot ${robotName} ${hash}`);
    await page.locator('#log div', { hasText: ` ${hash}, send help` }).last().waitFor();
  }
});

/** Sets the trim of A1 by the keyboard and saves it; asserts that the saved trim survives a reset. */
async function calibrate(page, runFor) {
  await unfold(page, '#calibrate');
  await runFor(500);
  const trim = page.locator('#calibration fieldset').first().getByLabel('trim');
  await trim.focus();
  for (let n = 0; n < 8; n++) await trim.press('ArrowRight');
  await runFor(1500);
  await page.locator('#log div', { hasText: /^ok trim 1 2$|^ok trim 1 2\.00$/ }).first().waitFor();
  const press = async (id, ms) => {
    await page.locator(id).click();
    await runFor(ms);
  };
  await press('#cal-save', 2500);
  await page.locator('#log div', { hasText: /^ok save$/ }).waitFor();
  await press('#reset', 4000);
  await press('#cal-factory', 500);
  await press('#cal-read', 500);
  assert.equal(await trim.inputValue(), '0', '"factory" restores the default');
  await press('#cal-load', 500);
  await press('#cal-read', 500);
  assert.equal(await trim.inputValue(), '2', 'the trim survives a reset');
}

testPage('a saved calibration survives a reset', openStanding, async (page) => {
  await calibrate(page, (ms) => advance(page, ms));
});

testPage('the boot action runs after a reset', openStanding, async (page) => {
  await sendLine(page, 'boot walk', 'ok boot walk');
  await sendLine(page, 'save', '> save');
  await advance(page, 2000);
  await clickAndAdvance(page, '#reset', 7000);
  await page.locator('#log div', { hasText: '# boot: walk' }).waitFor();
  assert.ok((await readDisplacements(page, 'walk')).measured.forward > 20, 'the page reports the walk');
});

testPage('a refused setting shows the reason, and its box shows the previous value', () => openUnfolded('#calibrate'), async (page) => {
  await advance(page, 500);
  const fromInput = page.locator('#calibration fieldset').first().getByLabel('from, deg');
  await fromInput.fill('125');
  await fromInput.press('Enter');
  await advance(page, 1000);
  await page.locator('#cal-message', { hasText: /^err 3 A1's travel must cover/ }).waitFor();
  assert.equal(await fromInput.inputValue(), '48.59');
});

/** Writes the image of another robot to the board; returns the banner with which the board starts. */
async function writeImage(page, runFor, targetText = '') {
  await unfold(page, '#flash');
  const buffer = Buffer.from(formatHex(await makeImage('large')));
  await page.getByLabel('HEX file').setInputFiles({ name: 'large.hex', mimeType: 'text/plain', buffer });
  await page.locator('#flash-question-text', { hasText: /^large\.hex, \d+ bytes\. It is lizard firmware\./ }).waitFor();
  await page.locator('#flash-yes').click();
  const readMessage = () => readText(page, '#flash-message');
  await repeatUntil('the image is written', async () => /written/.test(await readMessage()), () => runFor(100));
  assert.match(await readMessage(), new RegExp(`^written${targetText} and verified in [\\d.]+ s$`));
  const banner = page.locator('#log div', { hasText: /# lizard .* robot large/ }).last();
  await repeatUntil('the board sends its banner', async () => (await banner.count()) > 0, () => runFor(100));
  await runFor(2500);
  return banner.innerText();
}

testPage('an image is written through the real boot loader', openStanding, async (page) => {
  const previousLog = await readText(page, '#log');
  const banner = await writeImage(page, (ms) => advance(page, ms), ' to the simulated UNO');
  assert.ok(!previousLog.includes(banner), banner);
  assert.match(await readText(page, '#where'), /with another robot, robot large [0-9a-f]{8}:/);
  const image = await makeImage('large');
  const writtenBytes = await page.evaluate((length) => Array.from(window.lizard.board.link.board.flash.subarray(0, length)), image.length);
  assert.deepEqual(writtenBytes, Array.from(image));
});

testPage('an invalid HEX file is refused before anything is written', () => openUnfolded('#flash'), async (page) => {
  await page.getByLabel('HEX file').setInputFiles({ name: 'x.hex', mimeType: 'text/plain', buffer: Buffer.from('hello\n') });
  await page.locator('#flash-message', { hasText: "not written: line 1 is not Intel HEX: missing start code ':'" }).waitFor();
  assert.equal((await sendLine(page, 'status', 'ok gait=')).slice(0, 8), 'ok gait=', 'the robot continues');
});

testPage('a board on Web Serial is driven, mirrored, calibrated and written', () => openWithBoard('robot', 4000), async (page) => {
  const runFor = (ms) => page.clock.runFor(ms);
  assert.match(await readText(page, '#where'), /^on a board on USB, robot paper/);
  await page.locator('#log div', { hasText: 'ok watch 2' }).waitFor();
  await findGaitButton(page, 'walk').click();
  await runFor(5000);
  const { predicted, measured } = await readDisplacements(page, 'walk');
  assertNear(measured.forward, predicted.forward, 0.05, 'mm ahead in a cycle, from poses of every second frame');
  await page.keyboard.press('Escape');
  await runFor(200);
  await calibrate(page, runFor);
  assert.match(await writeImage(page, runFor), / robot large /);
  assert.match(await readText(page, '#where'), /with another robot, robot large [0-9a-f]{8}:/);
  await page.locator('#connect').click();
  await runFor(2000);
  assert.match(await readText(page, '#where'), /^on a simulated UNO, robot paper/);
});

testPage('the page reports an unplugged board, and the simulation continues', () => openWithBoard('robot', 4000), async (page) => {
  await page.evaluate(() => window.unplug());
  await page.locator('#problems', { hasText: 'The board is gone: The device has been lost.' }).waitFor();
  await page.clock.runFor(2000);
  assert.match(await readText(page, '#where'), /^on a simulated UNO, robot paper [0-9a-f]{8}$/);
});

testPage('a low supply stops the robot, and the page shows the fault', openStanding, async (page) => {
  await runGait(page, 'walk');
  await page.locator('#supply').fill('3.9');
  await advance(page, 2000);
  // Checks the status first, while its room is open; the log is in another room.
  await page.locator('#health dd', { hasText: 'supply' }).waitFor();
  await page.locator('#log div', { hasText: '# supply: ' }).first().waitFor();
});

testPage('pads that grip more in one direction change the prediction', openStanding, async (page) => {
  const previousForward = (await readDisplacements(page, 'back')).predicted.forward;
  await page.getByLabel('Friction back : ahead').fill('1.5');
  const { predicted, measured } = await runGait(page, 'back');
  assert.notEqual(predicted.forward, previousForward);
  assert.ok(Math.abs(measured.forward - predicted.forward) < 1.5, `distance per cycle: ${measured.forward} mm, predicted ${predicted.forward} mm`);
});

async function setSlider(page, label, value) {
  const slider = page.getByLabel(label);
  await slider.fill(`${value}`);
  await slider.dispatchEvent('change');
}

testPage('weak springs shorten the walk as the contact model predicts', openStanding, async (page) => {
  // Ideal servos, because a dead band would shorten the walk.
  await page.locator('#servos').selectOption('ideal');
  await chooseRobot(page, 'paper');
  await advance(page, 2500);
  const rigidMm = (await runGait(page, 'walk')).measured.forward;
  assert.equal(await page.locator('.sprung').first().isVisible(), false, 'rigid legs do not lag');
  // The table of docs/twin.md: mm per cycle of the paper's robot, and the lag in deg.
  const twinMarkdown = await readFile(new URL('../../docs/twin.md', import.meta.url), 'utf8');
  const readRow = (name) => twinMarkdown.split('\n').find((line) => line.startsWith(`| ${name}`)).split('|').slice(2).map(Number);
  const [pulls, walkedMm, lagsDeg] = ['pull in a slotted strut', '`walk`', 'lag in `walk`'].map(readRow);
  await page.getByLabel('Driven by').selectOption('strut');
  for (const pull of [0.5, 1]) {
    const [expectedMm, expectedLagDeg] = [walkedMm, lagsDeg].map((values) => values[pulls.indexOf(pull)]);
    await setSlider(page, 'Pull in the strut', pull);
    await advance(page, 4000);
    const { predicted, measured } = await readDisplacements(page, 'walk');
    assertNear(predicted.forward, expectedMm, 0.01, 'mm predicted, as in docs/twin.md');
    // The servos cut the corners of the waveforms, which matters over a short distance.
    assertNear(measured.forward, predicted.forward, 0.04, 'mm ahead in a cycle');
    assertNear(measured.lag, expectedLagDeg, 0.15, 'deg of lag');
    assertNear(predicted.fraction, predicted.forward / rigidMm, 0.03, 'fraction of the distance with rigid legs');
    await page.locator('#share', { hasText: `${(100 * predicted.fraction).toFixed(0)} %` }).waitFor();
    await page.waitForFunction((lag) => document.querySelector('#lag').textContent === lag, `${measured.lag.toFixed(1)}°`);
    const hasSprings = await page.evaluate(() => window.lizard.robot.last.scene.legs.every(({ has_spring }) => has_spring));
    assert.ok(hasSprings, 'each leg shows its spring');
  }
  // The legs of a heavy robot lag more.
  const lightPrediction = (await readDisplacements(page, 'walk')).predicted;
  await page.getByLabel('Mass').press('End');
  const heavyPrediction = (await readDisplacements(page, 'walk')).predicted;
  assert.ok(heavyPrediction.lag > 1.2 * lightPrediction.lag, `lag of heavy and light: ${heavyPrediction.lag} and ${lightPrediction.lag} deg`);
  await clickAndAdvance(page, '#floor-reset', 2500);
  const resetDisplacements = await readDisplacements(page, 'walk');
  assertNear(resetDisplacements.predicted.forward, rigidMm, 0.03, 'mm ahead in a cycle, with rigid legs again');
  assertNear(resetDisplacements.measured.forward, rigidMm, 0.03, 'mm ahead in a cycle, with rigid legs again');
  assert.deepEqual([resetDisplacements.predicted.lag, resetDisplacements.measured.lag], [null, 0]);
});

testPage('a foot that is too long shortens the walk as the contact model predicts, but not on soft feet', openStanding, async (page) => {
  await page.locator('#servos').selectOption('ideal');
  await advance(page, 2500);
  const levelMm = (await runGait(page, 'walk')).measured.forward;
  await setSlider(page, 'Front left foot too long', 1);
  await advance(page, 4000);
  const softFeet = await readDisplacements(page, 'walk');
  assertNear(softFeet.measured.forward, softFeet.predicted.forward, 0.03, 'mm ahead on soft feet');
  assert.ok(softFeet.measured.forward > 0.9 * levelMm, `${softFeet.measured.forward} of ${levelMm} mm`);
  await setSlider(page, 'Stiffness of a foot', 3.3);
  await advance(page, 4000);
  const stiffFeet = await readDisplacements(page, 'walk');
  assert.ok(Math.abs(stiffFeet.measured.forward - stiffFeet.predicted.forward) < 1.5, JSON.stringify(stiffFeet));
  assert.ok(stiffFeet.measured.forward < 0.3 * levelMm, `${stiffFeet.measured.forward} of ${levelMm} mm`);
  assert.equal(await page.locator('.sprung').first().isVisible(), false, 'rigid legs do not lag');
});

testPage('a dead band shortens the stroke as predicted', openStanding, async (page) => {
  const walkedMm = [];
  for (const servos of ['ideal', 'own']) {
    await page.locator('#servos').selectOption(servos);
    const { predicted, measured } = await runGait(page, 'walk');
    assertNear(measured.forward, predicted.forward, 0.01, `mm ahead in a cycle, ${servos}`);
    walkedMm.push(measured.forward);
  }
  assertNear(walkedMm[1] / walkedMm[0], 39 / 40, 0.01, 'fraction of the stroke that a dead band of 1 of 40 deg leaves');
});

testPage('at half the pace, the last cycle covers the predicted distance', openStanding, async (page) => {
  await sendLine(page, 'speed 50', 'ok speed 50');
  await sendLine(page, 'walk', 'ok walk');
  await advance(page, 8000);
  const readNumber = async (selector) => Number.parseFloat(await page.locator(selector).textContent());
  await page.waitForFunction(() => ['#cycle', '#predicted'].every((id) => document.querySelector(id).textContent.endsWith('mm')));
  const [cycleMm, predictedMm] = [await readNumber('#cycle'), await readNumber('#predicted')];
  assert.ok(Math.abs(cycleMm / predictedMm - 1) < 0.05, `last cycle: ${cycleMm} mm, predicted ${predictedMm} mm`);
});
