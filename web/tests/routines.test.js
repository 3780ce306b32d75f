// Routines: the page records a drive as steps, the steps are a view of robot.toml, and the robot repeats them.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { openWithBoard, runUntil, reconnect, waitForText } from './board.js';
import { address, advance, openStanding, readText, unfold, useBrowser, hidePage, testPage, findGaitButton, readGait, readPlace, readToml, waitForGait } from './browser.js';

useBrowser();

const PATROL = ['stand 1 s', 'walk 2', 'left 3', 'look 1'];

/** Waits until the robot on a board walks with a gait. */
const waitForBoardGait = (page, name) => runUntil(page, `the robot does ${name}`, async () => (await readGait(page)) === name, 20);
/** Starts a gait of the robot on a board, and lets it run for `ms`. */
async function runBoardGait(page, name, ms) {
  await findGaitButton(page, name).click();
  await waitForBoardGait(page, name);
  await page.clock.runFor(ms);
}
const readShownSteps = (page) => page.locator('#routine-steps input').evaluateAll((inputs) => inputs.map(({ value }) => value));
const findStepInput = (page, number) => page.getByLabel(`Step ${number}`, { exact: true });
const press = async (page, name) => {
  await unfold(page, '#routines');
  await page.locator('#routines').getByRole('button', { name, exact: true }).click();
};
/** Waits until the panel shows these steps. */
const waitForSteps = (page, expected) =>
  page.waitForFunction(
    (expected) => JSON.stringify([...document.querySelectorAll('#routine-steps input')].map(({ value }) => value)) === expected,
    JSON.stringify(expected),
  );
/** Reads the steps in the text of the robot. */
const readSteps = (page) => page.evaluate(() => window.lizard.robot.wasm.constructor.routines(window.lizard.robot.toml).at(-1)?.steps);
const waitForRoundPrediction = (page) => page.waitForFunction(() => document.querySelector('#routine-round').textContent !== '');
const readTrackPath = (page) => page.locator('#routine-path .track').getAttribute('d');

/** Puts a routine into the page's robot, at the end of its text. */
async function putRoutine(page, steps, name = 'patrol') {
  await page.evaluate(([name, steps]) => {
    const { lizard } = window;
    return lizard.robot.change(lizard.robot.wasm.constructor.putSteps(lizard.robot.toml, name, steps).text).then(() => null);
  }, [name, steps]);
}

/** Unfolds the panel, and gives the robot of the page a routine. */
async function showRoutine(page, routine) {
  await unfold(page, '#routines');
  if (!routine) return page;
  await putRoutine(page, routine);
  await waitForSteps(page, routine);
  return page;
}

/** Opens the panel with a routine, for a robot that stands. */
const openRoutine = async (routine = PATROL, options = {}) => showRoutine(await openStanding(options), routine);
/** Opens the panel with a routine that the connected board does not have. */
const openRoutineNotOnBoard = async (routine) => showRoutine(await openWithBoard(), routine);

/** Runs the simulation for some seconds of its own time. */
async function runSeconds(page, seconds) {
  const readClock = () => page.evaluate(() => window.lizard.clock);
  const endSeconds = (await readClock()) + seconds;
  for (let n = 0; (await readClock()) < endSeconds - 0.01; n++) {
    // The page asks for the status twice a second of real time, too rarely for a simulation this fast.
    if (n % 25 === 0) await page.evaluate(() => void window.lizard.board.status());
    await advance(page, 20);
  }
}

testPage('a recorded drive has the robot\'s motions, and its replay ends at the predicted place', () => openRoutine(null), async (page) => {
  await page.waitForFunction(() => ['walk', 'left'].every((name) => document.querySelector(`#gaits button[data-command="${name}"] small`).textContent));
  await page.getByText('This robot has no routine yet.').waitFor();
  await press(page, 'Record a drive');
  await page.getByText('Recording: drive the robot now').waitFor();
  const startPlace = await readPlace(page);
  const driveFor = async (key, gait, seconds) => {
    await page.keyboard.down(key);
    await waitForGait(page, gait);
    await runSeconds(page, seconds);
    await page.keyboard.up(key);
    await waitForGait(page, 'stop');
  };
  await driveFor('ArrowUp', 'walk', 3.6);
  // The body's displacement shows how many cycles have passed.
  const cycles = ((await readPlace(page)).y - startPlace.y) / 33.2;
  await runSeconds(page, 2);
  await driveFor('ArrowLeft', 'left', 2.6);
  await runSeconds(page, 1);
  await press(page, 'Stop recording');
  const message = await readText(page, '#routine-message');
  const [, walkCycles, pauseSeconds, turnCycles] = (/^Recorded: walk (\d+), stand ([\d.]+) s, left (\d+)$/.exec(message) ?? assert.fail(message)).map(Number);
  assert.ok(walkCycles >= 3 && walkCycles < cycles + 0.2 && walkCycles > cycles - 1.2, `${message}, but the robot has walked ${cycles} cycles`);
  // The page also advances by itself, so this is a lower bound.
  assert.ok(pauseSeconds >= 1.9, message);
  assert.equal(await page.locator('#routine-name').inputValue(), 'patrol');
  await press(page, 'Keep it');
  const recordedSteps = [`walk ${walkCycles}`, `stand ${pauseSeconds} s`, `left ${turnCycles}`];
  await waitForSteps(page, recordedSteps);
  assert.ok((await readToml(page)).endsWith(`\n[routine.patrol]\nsteps = ["${recordedSteps.join('", "')}"]\n`));
  await waitForRoundPrediction(page);
  const [, seconds, forwardMm, , , turnedDeg] = /^A round takes ([\d.]+) s and ends (-?\d+) mm ahead and (\d+) mm to the (right|left) of its start, turned by (-?\d+)°\.$/
    .exec(await readText(page, '#routine-round'));
  assert.ok(Math.abs(forwardMm - 33.2 * walkCycles) < 15 && Math.abs(turnedDeg - 14.1 * turnCycles) < 10, `${forwardMm} mm ahead, turned by ${turnedDeg} deg`);
  await advance(page, 2500);
  await press(page, 'Start it');
  await advance(page, 100);
  await waitForGait(page, 'patrol');
  assert.equal(await findGaitButton(page, 'patrol').getAttribute('aria-pressed'), 'true');
  await advance(page, seconds * 1000 + 200);
  await page.locator('#log div', { hasText: '# done' }).waitFor();
  assert.equal(await readGait(page), 'stop');
  const { y, heading } = await readPlace(page);
  assert.ok(Math.abs(y - forwardMm) < 0.03 * forwardMm + 1, `${y} mm ahead, predicted ${forwardMm}`);
  assert.ok(Math.abs(heading - turnedDeg) < 0.03 * turnedDeg + 1, `turned by ${heading} deg, predicted ${turnedDeg}`);
});

testPage('the recording follows the robot\'s reports, not the pressed buttons', () => openRoutine(null), async (page) => {
  await press(page, 'Record a drive');
  // A line with three cycles ends by itself; a refused line starts no gait.
  for (const [line, seconds] of [['walk 3', 5], ['rest', 2], ['walk', 1], ['stand', 1.5], ['look', 0.8], ['center', 1]]) {
    await page.evaluate((line) => void window.lizard.board.ask(line), line);
    await runSeconds(page, seconds);
  }
  await press(page, 'Stop recording');
  const message = await readText(page, '#routine-message');
  // The page also advances by itself, so these times are lower bounds.
  const [, rest, stand, look] = (/^Recorded: walk 3, stand [\d.]+ s, rest ([\d.]+) s, stand ([\d.]+) s, look ([\d.]+) s$/.exec(message) ?? assert.fail(message)).map(Number);
  assert.ok(rest >= 2.9 && stand >= 1.4 && look >= 0.7, message);
  await press(page, 'Drop it');
  assert.equal(await page.locator('#routine-recorded').isVisible(), false);
  await press(page, 'Record a drive');
  await runSeconds(page, 1);
  await press(page, 'Stop recording');
  await page.getByText('Nothing was recorded, because the robot did not walk.').waitFor();
});

testPage('the recorded number of cycles does not depend on the phase of the previous gait', () => openRoutine(null), async (page) => {
  for (let tenth = 0; tenth < 10; tenth++) {
    await press(page, 'Record a drive');
    await page.evaluate(() => void window.lizard.board.ask('stand'));
    await runSeconds(page, 0.5 + 0.1 * tenth);
    await page.evaluate(() => void window.lizard.board.ask('walk 2'));
    await advance(page, 60);
    await page.evaluate(() => void window.lizard.board.status());
    await runSeconds(page, 3);
    await press(page, 'Stop recording');
    assert.match(await readText(page, '#routine-message'), /^Recorded: walk 2$/, `after ${0.5 + 0.1 * tenth} s`);
    await press(page, 'Drop it');
  }
});

testPage('the recording uses the board\'s own phase, even after its link was cut', openWithBoard, async (page) => {
  await press(page, 'Record a drive');
  // A walk begins with 0.25 s to its first pose, so less than four cycles have passed.
  await runBoardGait(page, 'walk', 4100);
  await runBoardGait(page, 'back', 2600);
  // The link is lost: the robot stops by itself after 0.9 s.
  await page.evaluate(() => {
    const board = window.attachedBoard;
    const { send, onByte } = board;
    board.send = board.onByte = () => {};
    setTimeout(() => Object.assign(board, { send, onByte }), 8000);
  });
  await page.clock.runFor(8500);
  await waitForBoardGait(page, 'stop');
  await page.clock.runFor(500);
  await press(page, 'Stop recording');
  assert.match(await readText(page, '#routine-message'), /^Recorded: walk 3, back [23]$/);
});

testPage('keys alone can change, move, copy and delete steps, and undo each change', openRoutine, async (page) => {
  const history = [PATROL];
  const assertSteps = async (edit, expected) => {
    await edit();
    await waitForSteps(page, expected);
    await page.waitForFunction((expected) => window.lizard.robot.toml.includes(`steps = ${expected}`), `["${expected.join('", "')}"]`);
    history.push(expected);
  };
  await assertSteps(async () => {
    await findStepInput(page, 2).fill(' walk 5 ');
    await page.keyboard.press('Enter');
  }, ['stand 1 s', 'walk 5', 'left 3', 'look 1']);
  const waitForFocus = (label) => page.waitForFunction((label) => document.activeElement?.getAttribute('aria-label') === label, label);
  const pressButton = async (label) => {
    await page.getByLabel(label, { exact: true }).focus();
    await page.keyboard.press('Enter');
  };
  await assertSteps(() => pressButton('Move down step 2'), ['stand 1 s', 'left 3', 'walk 5', 'look 1']);
  await waitForFocus('Move down step 3');
  await assertSteps(() => page.keyboard.press('Enter'), ['stand 1 s', 'left 3', 'look 1', 'walk 5']);
  await assertSteps(() => pressButton('Copy step 2'), ['stand 1 s', 'left 3', 'left 3', 'look 1', 'walk 5']);
  await assertSteps(() => pressButton('Delete step 1'), ['left 3', 'left 3', 'look 1', 'walk 5']);
  await assertSteps(() => pressButton('Move up step 4'), ['left 3', 'left 3', 'walk 5', 'look 1']);
  await waitForFocus('Move up step 3');
  await assertSteps(() => press(page, 'Add a step'), ['left 3', 'left 3', 'walk 5', 'look 1', 'look 1']);
  for (const expected of history.slice(0, -1).reverse()) {
    await page.locator('#routine-undo').click();
    await waitForSteps(page, expected);
  }
  assert.deepEqual(await readSteps(page), PATROL);
});

testPage('the list of steps follows the text, and the text follows the list and keeps its other lines', openRoutine, async (page) => {
  await unfold(page, '#robot-editor');
  const editedToml = `${await readToml(page)}repeat = 3 # rounds\n\n[routine.about]\nsteps = [\n  "left 12", # half a turn\n]\n`;
  await page.locator('#robot-text').fill(editedToml);
  await unfold(page, '#routines');
  assert.deepEqual(await page.locator('#routine option').allInnerTexts(), ['patrol', 'about'], 'before it is used');
  await page.locator('#robot-take').click();
  await page.locator('#routine').selectOption('about');
  await waitForSteps(page, ['left 12']);
  await page.locator('#routine').selectOption('patrol');
  await press(page, 'Delete step 4');
  await page.waitForFunction((expected) => window.lizard.robot.toml === expected, editedToml.replace('"left 3", "look 1"', '"left 3"'));
  assert.equal(await page.locator('#robot-text').inputValue(), await readToml(page));
  assert.deepEqual(await page.locator('#gaits button').allInnerTexts().then((names) => names.slice(-2).map((name) => name.trim())), ['patrol', 'about']);
});

testPage('the page draws the new path while a step is dragged, and changes the text when it is released', () => openRoutine(['walk 3', 'left 6', 'walk 1']), async (page) => {
  await waitForRoundPrediction(page);
  const [previousToml, firstTrack] = [await readToml(page), await readTrackPath(page)];
  const waitForOtherTrack = () => page.waitForFunction((firstTrack) => document.querySelector('#routine-path .track').getAttribute('d') !== firstTrack, firstTrack);
  const findGrip = (number) => page.locator('#routine-steps .grip').nth(number - 1);
  const computeMiddle = async (number) => {
    await findGrip(number).scrollIntoViewIfNeeded();
    const { x, y, width, height } = await findGrip(number).boundingBox();
    return [x + width / 2, y + height / 2];
  };
  await page.mouse.move(...(await computeMiddle(1)));
  await page.mouse.down();
  await page.mouse.move(...(await computeMiddle(3)), { steps: 5 });
  await waitForOtherTrack();
  assert.deepEqual(await readShownSteps(page), ['left 6', 'walk 1', 'walk 3'], 'the order after a release');
  assert.equal(await readToml(page), previousToml);
  await page.mouse.move(...(await computeMiddle(1)), { steps: 5 });
  await page.waitForFunction((firstTrack) => document.querySelector('#routine-path .track').getAttribute('d') === firstTrack, firstTrack);
  await page.mouse.up();
  assert.equal(await readToml(page), previousToml, 'the step is back at its place');
  await page.mouse.move(...(await computeMiddle(1)));
  await page.mouse.down();
  await page.mouse.move(...(await computeMiddle(2)), { steps: 5 });
  await page.mouse.up();
  await page.waitForFunction(() => window.lizard.robot.toml.includes('steps = ["left 6", "walk 3", "walk 1"]'));
  await waitForOtherTrack();
});

test('a finger drags a step, too', async () => {
  const page = await openRoutine(['walk 3', 'left 6'], { viewport: { width: 360, height: 740 }, hasTouch: true, isMobile: true });
  const session = await page.context().newCDPSession(page);
  const grip = page.locator('#routine-steps .grip');
  await grip.first().scrollIntoViewIfNeeded();
  const [fromBox, toBox] = [await grip.nth(0).boundingBox(), await grip.nth(1).boundingBox()];
  const x = fromBox.x + fromBox.width / 2;
  await session.send('Input.dispatchTouchEvent', { type: 'touchStart', touchPoints: [{ x, y: fromBox.y + 10 }] });
  for (let fraction = 0; fraction <= 1; fraction += 0.1) await session.send('Input.dispatchTouchEvent', { type: 'touchMove', touchPoints: [{ x, y: fromBox.y + 10 + fraction * (toBox.y - fromBox.y + 5) }] });
  await session.send('Input.dispatchTouchEvent', { type: 'touchEnd', touchPoints: [] });
  await page.waitForFunction(() => window.lizard.robot.toml.includes('steps = ["left 6", "walk 3"]'));
});

testPage('a mistake is shown at its step with its line, and the previous robot stays in use', openRoutine, async (page) => {
  const previousToml = await readToml(page);
  const line = previousToml.split('\n').findIndex((text) => text.startsWith('steps = ')) + 1;
  await findStepInput(page, 2).fill('wolk 4');
  await page.keyboard.press('Enter');
  const block = page.locator('#routine-steps li', { has: findStepInput(page, 2) });
  const message = `robot.toml:${line}: routine.patrol.steps: step 2, "wolk 4", names the gait "wolk", which does not exist; did you mean "walk"?`;
  await block.getByText(message).waitFor();
  assert.deepEqual(await page.locator('#routine-steps input[aria-invalid="true"]').evaluateAll((inputs) => inputs.map(({ value }) => value)), ['wolk 4']);
  assert.equal(await readToml(page), previousToml);
  assert.ok((await page.locator('#routine-start').isDisabled()) && (await page.locator('#routine-write').isDisabled()));
  assert.equal(await page.locator('#robot-editor').getAttribute('open'), null, 'the text editor stays closed');
  // An invalid step moves unchanged.
  await press(page, 'Move down step 2');
  await page.locator('#routine-steps li', { has: findStepInput(page, 3) }).getByText(message.replace('step 2', 'step 3')).waitFor();
  await waitForSteps(page, ['stand 1 s', 'left 3', 'wolk 4', 'look 1']);
  await page.locator('#routine-undo').click();
  await waitForSteps(page, PATROL);
  assert.equal(await page.locator('#routine-refusal').isVisible(), false);
  // A routine needs steps.
  await putRoutine(page, ['walk 1']);
  await waitForSteps(page, ['walk 1']);
  await press(page, 'Delete step 1');
  await page.getByText('routine.patrol.steps has 0 steps; it must have between 1 and 99').first().waitFor();
  await press(page, 'Add a step');
  await waitForSteps(page, ['stand 1 s']);
});

testPage('an invalid or existing name is refused, and the recorded steps stay', openRoutine, async (page) => {
  await press(page, 'Record a drive');
  await page.evaluate(() => void window.lizard.board.ask('walk 2'));
  await runSeconds(page, 3);
  await press(page, 'Stop recording');
  assert.equal(await page.locator('#routine-name').inputValue(), 'patrol-2', 'the name patrol is in use');
  for (const [name, refusal] of [
    ['walk', 'routine.walk has the name of a gait; choose another name'],
    ['stop', 'routine.stop is not a routine name: "stop" is a console command'],
    ['a"b', 'it must consist of lower-case letters, digits and hyphens, and begin with a letter'],
    ['patrol', 'The routine patrol already exists; choose another name.'],
  ]) {
    await page.locator('#routine-name').fill(name);
    await press(page, 'Keep it');
    await page.locator('#routine-message', { hasText: refusal }).waitFor();
  }
  await page.locator('#routine-name').fill('two steps');
  await press(page, 'Keep it');
  await page.waitForFunction(() => window.lizard.robot.toml.endsWith('\n[routine.two-steps]\nsteps = ["walk 2"]\n'));
  assert.equal(await page.locator('#routine').inputValue(), 'two-steps');
});

test('a routine of 99 steps that lasts longer than a day does not block the page', async () => {
  const page = await openRoutine(['walk 1', ...Array(98).fill('stand 999 s')]);
  await page.getByText('The first 120 s of a round end 3').waitFor();
  await page.locator('#routine-steps li').nth(98).waitFor();
});

testPage('a routine is written to a board, started by its name, and reports its end', () => openRoutineNotOnBoard(['walk 2', 'rest 2 s', 'left 1']), async (page) => {
  // Until the routine is written, the board's robot does not have it.
  await press(page, 'Start it');
  await runUntil(page, 'the command is refused', async () => (await readText(page, '#drive-message')) === 'patrol: unknown command; send help for the list');
  await press(page, 'Write it to the board');
  await waitForText(page, '#routine-message', /^written and verified in [\d.]+ s$/);
  await page.clock.runFor(6000);
  await page.evaluate(() => (window.receivedText = ''));
  // The routine is not over while the robot rests, so the page keeps sending lines.
  await runBoardGait(page, 'patrol', 3500);
  assert.equal(await readGait(page), 'patrol');
  assert.ok(!(await page.evaluate(() => window.receivedText)).includes('deadman 0'));
  await runUntil(page, 'the routine is done', async () => (await page.locator('#log div', { hasText: /^# done$/ }).count()) === 1, 20);
  await page.clock.runFor(600);
  assert.equal(await readGait(page), 'stop');
  assert.match(await page.evaluate(() => window.receivedText), /deadman 901\n[^]*patrol\n[^]*deadman 0\n/);
});

testPage('a resting routine is stopped when the page is hidden', openWithBoard, async (page) => {
  await putRoutine(page, ['walk 1', 'rest 9 s', 'walk 99']);
  await page.locator('#flash-robot').evaluate((button) => button.click());
  await runUntil(page, 'the robot is written', async () => /^written and verified/.test(await page.locator('#flash-message').textContent()));
  await page.clock.runFor(6000);
  await runBoardGait(page, 'patrol', 3500);
  await page.evaluate(() => (window.receivedText = ''));
  await hidePage(page);
  await page.clock.runFor(500);
  assert.match(await page.evaluate(() => window.receivedText), /^stop\n/);
});

testPage('the page reports a board that is unplugged while a routine is written, and writes the routine later', () => openRoutineNotOnBoard(['walk 1']), async (page) => {
  await press(page, 'Write it to the board');
  await waitForText(page, '#routine-message', /^writing/, 20);
  await page.clock.runFor(60);
  await page.evaluate(() => window.unplug());
  await waitForText(page, '#routine-message', /^not written: .*\. The board now has an incomplete robot: its firmware reports fault=robot and moves no servo\. Write the robot again$/);
  assert.deepEqual(await readSteps(page), ['walk 1'], 'the routine is still in the page');
  await reconnect(page);
  await runUntil(page, 'the board sends its banner', async () => (await readText(page, '#where')) === 'on a board on USB with this firmware but no robot: write this robot');
  await press(page, 'Write it to the board');
  await waitForText(page, '#routine-message', /^written and verified/);
});

testPage('a robot whose format the firmware does not read is reported as missing', openWithBoard, async (page) => {
  await page.evaluate(() => {
    const { start } = window.lizard.robot.description;
    window.attachedBoard.flash[start + 4] ^= 1;
    window.attachedBoard.reset('external');
  });
  await runUntil(page, 'the board sends its banner', async () => (await readText(page, '#where')) === 'on a board on USB with this firmware but no robot: write this robot');
  await page.locator('#log div', { hasText: '# fault: the robot in the flash is for another version; write it again' }).waitFor();
});

test('two pages in one browser each keep their own routine', async () => {
  const firstPage = await openRoutine();
  const [secondPage] = await Promise.all([firstPage.waitForEvent('popup'), firstPage.evaluate((address) => void window.open(address), address())]);
  await secondPage.waitForFunction(() => window.lizard);
  // The second page starts with the robot that the first page has stored, and then has its own changes.
  assert.deepEqual(await readSteps(secondPage), PATROL);
  const ownRoutines = [[firstPage, ['right 2']], [secondPage, ['left 2']]];
  for (const [page, expected] of ownRoutines) {
    const previousUrl = page.url();
    await putRoutine(page, expected);
    await page.waitForFunction((previousUrl) => location.href !== previousUrl, previousUrl);
  }
  for (const [page, expected] of ownRoutines) {
    await page.reload();
    await page.waitForFunction(() => window.lizard?.robot.toml.includes('[routine.'));
    assert.deepEqual(await readSteps(page), expected);
  }
});

testPage('a routine that was only typed into robot.toml is part of the robot when it is started', () => openRoutine(null), async (page) => {
  await page.locator('#robot-text').fill(`${await readToml(page)}\n[routine.patrol]\nsteps = ["walk 1"]\n`);
  await press(page, 'Start it');
  await page.waitForFunction(() => window.lizard.robot.toml.includes('[routine.patrol]'));
});
