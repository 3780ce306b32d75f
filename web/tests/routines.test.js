// Routines: a drive is recorded as steps, the steps are a view of robot.toml, and the robot repeats them.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { openWithBoard, runUntil, reconnect, waitForText } from './board.js';
import { address, advance, complaints, openStanding, text, unfold, useBrowser, hidePage } from './browser.js';

useBrowser();

const PATROL = ['stand 1 s', 'walk 2', 'left 3', 'look 1'];

const gaitOf = (page) => page.evaluate(() => window.lizard.gait);
/** Waits until the robot on a board does a gait. */
const waitForBoardGait = (page, name) => runUntil(page, `the robot does ${name}`, async () => (await gaitOf(page)) === name, 20);
const tomlOf = (page) => page.evaluate(() => window.lizard.toml);
const gaitButton = (page, name) => page.locator(`#gaits button[data-command="${name}"]`);
const stepsOf = (page) => page.locator('#routine-steps input').evaluateAll((inputs) => inputs.map(({ value }) => value));
const stepInput = (page, number) => page.getByLabel(`Step ${number}`, { exact: true });
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
const readSteps = (page) => page.evaluate(() => window.lizard.robot.constructor.routines(window.lizard.toml).at(-1)?.steps);
const waitForPrediction = (page) => page.waitForFunction(() => document.querySelector('#routine-round').textContent !== '');
const trackPathOf = (page) => page.locator('#routine-path .track').getAttribute('d');

/** Puts a routine into the page's robot, at the end of its text. */
async function putRoutine(page, steps, name = 'patrol') {
  await page.evaluate(([name, steps]) => {
    const { lizard } = window;
    return lizard.change(lizard.robot.constructor.putSteps(lizard.toml, name, steps).text).then(() => null);
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
const openBoardWithRoutine = async (routine) => showRoutine(await openWithBoard('robot', 8000), routine);

/** Runs the simulation for some seconds of its own time. */
async function runSeconds(page, seconds) {
  const readClock = () => page.evaluate(() => window.lizard.clock);
  const endSeconds = (await readClock()) + seconds;
  for (let n = 0; (await readClock()) < endSeconds - 0.01; n++) {
    // The page asks for the status twice a second of real time, too rarely for a simulation this fast.
    if (n % 25 === 0) await page.evaluate(() => void window.lizard.status());
    await advance(page, 20);
  }
}

test('a drive is recorded by the robot\'s motions, and its replay ends where predicted', async () => {
  const page = await openRoutine(null);
  await page.waitForFunction(() => ['walk', 'left'].every((name) => document.querySelector(`#gaits button[data-command="${name}"] small`).textContent));
  await page.getByText('This robot has no routine yet.').waitFor();
  await press(page, 'Record a drive');
  await page.getByText('Recording: drive now').waitFor();
  const readPlace = () => page.evaluate(() => window.lizard.last.place);
  const startPlace = await readPlace();
  await page.keyboard.down('ArrowUp');
  await page.waitForFunction(() => window.lizard.gait === 'walk');
  await runSeconds(page, 3.6);
  await page.keyboard.up('ArrowUp');
  await page.waitForFunction(() => window.lizard.gait === 'stop');
  // The body's displacement shows how many cycles have passed.
  const cycles = ((await readPlace()).y - startPlace.y) / 33.2;
  await runSeconds(page, 2);
  await page.keyboard.down('ArrowLeft');
  await page.waitForFunction(() => window.lizard.gait === 'left');
  await runSeconds(page, 2.6);
  await page.keyboard.up('ArrowLeft');
  await page.waitForFunction(() => window.lizard.gait === 'stop');
  await runSeconds(page, 1);
  await press(page, 'Stop recording');
  const message = await text(page, '#routine-said');
  const [, walkCycles, pauseSeconds, turnCycles] = (/^Recorded: walk (\d+), stand ([\d.]+) s, left (\d+)$/.exec(message) ?? assert.fail(message)).map(Number);
  assert.ok(walkCycles >= 3 && walkCycles < cycles + 0.2 && walkCycles > cycles - 1.2, `${message}, ${cycles} cycles`);
  // The page also advances by itself, so this is a lower bound.
  assert.ok(pauseSeconds >= 1.9, message);
  assert.equal(await page.locator('#routine-name').inputValue(), 'patrol');
  await press(page, 'Keep it');
  const recordedSteps = [`walk ${walkCycles}`, `stand ${pauseSeconds} s`, `left ${turnCycles}`];
  await waitForSteps(page, recordedSteps);
  assert.ok((await tomlOf(page)).endsWith(`\n[routine.patrol]\nsteps = ["${recordedSteps.join('", "')}"]\n`));
  await waitForPrediction(page);
  const [, seconds, forwardMm, , , turnedDeg] = /^A round takes ([\d.]+) s and ends (-?\d+) mm ahead and (\d+) mm to the (right|left) of its start, turned by (-?\d+)°\.$/
    .exec(await text(page, '#routine-round'));
  assert.ok(Math.abs(forwardMm - 33.2 * walkCycles) < 15 && Math.abs(turnedDeg - 14.1 * turnCycles) < 10, `${forwardMm} mm, ${turnedDeg} deg`);
  await advance(page, 2500);
  await press(page, 'Start it');
  await advance(page, 100);
  await page.waitForFunction(() => window.lizard.gait === 'patrol');
  assert.equal(await gaitButton(page, 'patrol').getAttribute('aria-pressed'), 'true');
  await advance(page, seconds * 1000 + 200);
  await page.locator('#log div', { hasText: '# done' }).waitFor();
  assert.equal(await gaitOf(page), 'stop');
  const { y, heading } = await readPlace();
  assert.ok(Math.abs(y - forwardMm) < 0.03 * forwardMm + 1, `${y} mm ahead, predicted ${forwardMm}`);
  assert.ok(Math.abs(heading - turnedDeg) < 0.03 * turnedDeg + 1, `turned by ${heading} deg, predicted ${turnedDeg}`);
});

test('the recording follows the robot\'s reports, not the pressed buttons', async () => {
  const page = await openRoutine(null);
  await press(page, 'Record a drive');
  // A line with three cycles ends by itself; a refused line starts no gait.
  for (const [line, seconds] of [['walk 3', 5], ['rest', 2], ['walk', 1], ['stand', 1.5], ['look', 0.8], ['center', 1]]) {
    await page.evaluate((line) => void window.lizard.ask(line), line);
    await runSeconds(page, seconds);
  }
  await press(page, 'Stop recording');
  const message = await text(page, '#routine-said');
  // The page also advances by itself, so these times are lower bounds.
  const [, rest, stand, look] = (/^Recorded: walk 3, stand [\d.]+ s, rest ([\d.]+) s, stand ([\d.]+) s, look ([\d.]+) s$/.exec(message) ?? assert.fail(message)).map(Number);
  assert.ok(rest >= 2.9 && stand >= 1.4 && look >= 0.7, message);
  await press(page, 'Drop it');
  assert.equal(await page.locator('#routine-recorded').isVisible(), false);
  await press(page, 'Record a drive');
  await runSeconds(page, 1);
  await press(page, 'Stop recording');
  await page.getByText('Nothing is recorded: the robot has not walked.').waitFor();
});

test('the recorded number of cycles is that of the walk, whatever the phase of the previous gait at its start', async () => {
  const page = await openRoutine(null);
  for (let tenth = 0; tenth < 10; tenth++) {
    await press(page, 'Record a drive');
    await page.evaluate(() => void window.lizard.ask('stand'));
    await runSeconds(page, 0.5 + 0.1 * tenth);
    await page.evaluate(() => void window.lizard.ask('walk 2'));
    await advance(page, 60);
    await page.evaluate(() => void window.lizard.status());
    await runSeconds(page, 3);
    await press(page, 'Stop recording');
    assert.match(await text(page, '#routine-said'), /^Recorded: walk 2$/, `after ${tenth} tenths`);
    await press(page, 'Drop it');
  }
});

test('the drive of a board is recorded by the board\'s own phase, even if its link was cut', async () => {
  const page = await openWithBoard('robot', 8000);
  await unfold(page, '#routines');
  await press(page, 'Record a drive');
  await gaitButton(page, 'walk').click();
  await waitForBoardGait(page, 'walk');
  // A walk begins with 0.25 s to its first pose, so less than four cycles have passed.
  await page.clock.runFor(4100);
  await gaitButton(page, 'back').click();
  await waitForBoardGait(page, 'back');
  await page.clock.runFor(2600);
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
  assert.match(await text(page, '#routine-said'), /^Recorded: walk 3, back [23]$/);
});

test('steps are changed, moved, copied and deleted by keys alone, and each is undone', async () => {
  const page = await openRoutine();
  const history = [PATROL];
  const assertSteps = async (edit, expected) => {
    await edit();
    await waitForSteps(page, expected);
    await page.waitForFunction((expected) => window.lizard.toml.includes(`steps = ${expected}`), `["${expected.join('", "')}"]`);
    history.push(expected);
  };
  const readFocus = () => page.evaluate(() => document.activeElement?.getAttribute('aria-label'));
  await assertSteps(async () => {
    await stepInput(page, 2).fill(' walk 5 ');
    await page.keyboard.press('Enter');
  }, ['stand 1 s', 'walk 5', 'left 3', 'look 1']);
  const pressButton = async (label) => {
    await page.getByLabel(label, { exact: true }).focus();
    await page.keyboard.press('Enter');
  };
  await assertSteps(() => pressButton('Move down step 2'), ['stand 1 s', 'left 3', 'walk 5', 'look 1']);
  await page.waitForFunction(() => document.activeElement?.getAttribute('aria-label') === 'Move down step 3');
  await assertSteps(() => page.keyboard.press('Enter'), ['stand 1 s', 'left 3', 'look 1', 'walk 5']);
  await assertSteps(() => pressButton('Copy step 2'), ['stand 1 s', 'left 3', 'left 3', 'look 1', 'walk 5']);
  await assertSteps(() => pressButton('Delete step 1'), ['left 3', 'left 3', 'look 1', 'walk 5']);
  await assertSteps(() => pressButton('Move up step 4'), ['left 3', 'left 3', 'walk 5', 'look 1']);
  await page.waitForFunction(() => document.activeElement?.getAttribute('aria-label') === 'Move up step 3');
  assert.equal(await readFocus(), 'Move up step 3');
  await assertSteps(() => press(page, 'Add a step'), ['left 3', 'left 3', 'walk 5', 'look 1', 'look 1']);
  for (const expected of history.slice(0, -1).reverse()) {
    await page.locator('#routine-undo').click();
    await waitForSteps(page, expected);
  }
  assert.deepEqual(await readSteps(page), PATROL);
});

test('the list follows the text, and the text follows the list and keeps its other lines', async () => {
  const page = await openRoutine();
  await unfold(page, '#robot-editor');
  const editedToml = `${await tomlOf(page)}repeat = 3 # rounds\n\n[routine.about]\nsteps = [\n  "left 12", # half a turn\n]\n`;
  await page.locator('#robot-text').fill(editedToml);
  await unfold(page, '#routines');
  assert.deepEqual(await page.locator('#routine option').allInnerTexts(), ['patrol', 'about'], 'before it is used');
  await page.locator('#robot-take').click();
  await page.locator('#routine').selectOption('about');
  await waitForSteps(page, ['left 12']);
  await page.locator('#routine').selectOption('patrol');
  await press(page, 'Delete step 4');
  await page.waitForFunction((expected) => window.lizard.toml === expected, editedToml.replace('"left 3", "look 1"', '"left 3"'));
  assert.equal(await page.locator('#robot-text').inputValue(), await tomlOf(page));
  assert.deepEqual(await page.locator('#gaits button').allInnerTexts().then((names) => names.slice(-2).map((name) => name.trim())), ['patrol', 'about']);
});

test('while a step is dragged the new path is drawn, and the text changes when the step is released', async () => {
  const page = await openRoutine(['walk 3', 'left 6', 'walk 1']);
  await waitForPrediction(page);
  const [previousToml, firstTrack] = [await tomlOf(page), await trackPathOf(page)];
  const waitForOtherTrack = () => page.waitForFunction((firstTrack) => document.querySelector('#routine-path .track').getAttribute('d') !== firstTrack, firstTrack);
  const gripOf = (number) => page.locator('#routine-steps .grip').nth(number - 1);
  const middleOf = async (number) => {
    await gripOf(number).scrollIntoViewIfNeeded();
    const { x, y, width, height } = await gripOf(number).boundingBox();
    return [x + width / 2, y + height / 2];
  };
  await page.mouse.move(...(await middleOf(1)));
  await page.mouse.down();
  await page.mouse.move(...(await middleOf(3)), { steps: 5 });
  await waitForOtherTrack();
  assert.deepEqual(await stepsOf(page), ['left 6', 'walk 1', 'walk 3'], 'the order after a release');
  assert.equal(await tomlOf(page), previousToml);
  await page.mouse.move(...(await middleOf(1)), { steps: 5 });
  await page.waitForFunction((firstTrack) => document.querySelector('#routine-path .track').getAttribute('d') === firstTrack, firstTrack);
  await page.mouse.up();
  assert.equal(await tomlOf(page), previousToml, 'the step is where it was');
  await page.mouse.move(...(await middleOf(1)));
  await page.mouse.down();
  await page.mouse.move(...(await middleOf(2)), { steps: 5 });
  await page.mouse.up();
  await page.waitForFunction(() => window.lizard.toml.includes('steps = ["left 6", "walk 3", "walk 1"]'));
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
  for (let share = 0; share <= 1; share += 0.1) await session.send('Input.dispatchTouchEvent', { type: 'touchMove', touchPoints: [{ x, y: fromBox.y + 10 + share * (toBox.y - fromBox.y + 5) }] });
  await session.send('Input.dispatchTouchEvent', { type: 'touchEnd', touchPoints: [] });
  await page.waitForFunction(() => window.lizard.toml.includes('steps = ["left 6", "walk 3"]'));
});

test('a mistake is shown at its block with its line and its step, and the previous robot stays in use', async () => {
  const page = await openRoutine();
  const previousToml = await tomlOf(page);
  const line = previousToml.split('\n').findIndex((text) => text.startsWith('steps = ')) + 1;
  await stepInput(page, 2).fill('wolk 4');
  await page.keyboard.press('Enter');
  const block = page.locator('#routine-steps li', { has: stepInput(page, 2) });
  const message = `robot.toml:${line}: routine.patrol.steps: step 2, "wolk 4", names the gait "wolk", which does not exist; did you mean "walk"?`;
  await block.getByText(message).waitFor();
  assert.deepEqual(await page.locator('#routine-steps input[aria-invalid="true"]').evaluateAll((inputs) => inputs.map(({ value }) => value)), ['wolk 4']);
  assert.equal(await tomlOf(page), previousToml);
  assert.ok((await page.locator('#routine-start').isDisabled()) && (await page.locator('#routine-write').isDisabled()));
  assert.equal(await page.locator('#robot-editor').getAttribute('open'), null, 'the text editor stays closed');
  // An invalid step moves unchanged.
  await press(page, 'Move down step 2');
  await page.locator('#routine-steps li', { has: stepInput(page, 3) }).getByText(message.replace('step 2', 'step 3')).waitFor();
  await waitForSteps(page, ['stand 1 s', 'left 3', 'wolk 4', 'look 1']);
  await page.locator('#routine-undo').click();
  await waitForSteps(page, PATROL);
  assert.equal(await page.locator('#routine-refusal').isVisible(), false);
  // A routine needs steps.
  await putRoutine(page, ['walk 1']);
  await waitForSteps(page, ['walk 1']);
  await press(page, 'Delete step 1');
  await page.getByText('routine.patrol.steps has 0 steps; it must have 1 to 99').first().waitFor();
  await press(page, 'Add a step');
  await waitForSteps(page, ['stand 1 s']);
});

test('an invalid or existing name is refused, and the recorded steps stay', async () => {
  const page = await openRoutine();
  await press(page, 'Record a drive');
  await page.evaluate(() => void window.lizard.ask('walk 2'));
  await runSeconds(page, 3);
  await press(page, 'Stop recording');
  assert.equal(await page.locator('#routine-name').inputValue(), 'patrol-2', 'the name patrol is in use');
  for (const [name, refusal] of [
    ['walk', 'routine.walk has the name of a gait; give it another one'],
    ['stop', 'routine.stop is not a routine name: "stop" is a command of the console'],
    ['a"b', 'it must be lower-case letters, digits and dashes, a letter first'],
    ['patrol', 'patrol is there already: give it another name.'],
  ]) {
    await page.locator('#routine-name').fill(name);
    await press(page, 'Keep it');
    await page.locator('#routine-said', { hasText: refusal }).waitFor();
  }
  await page.locator('#routine-name').fill('two steps');
  await press(page, 'Keep it');
  await page.waitForFunction(() => window.lizard.toml.endsWith('\n[routine.two-steps]\nsteps = ["walk 2"]\n'));
  assert.equal(await page.locator('#routine').inputValue(), 'two-steps');
});

test('a step that waits forever, or a large number of steps, does not block the page', async () => {
  const page = await openRoutine(['walk 1', ...Array(98).fill('stand 999 s')]);
  await page.getByText('The first 120 s of a round end 3').waitFor();
  await page.locator('#routine-steps li').nth(98).waitFor();
});

test('a routine is written to a board, started by its name, and reports its end', async () => {
  const page = await openBoardWithRoutine(['walk 2', 'rest 2 s', 'left 1']);
  // Until it is written, the board has the robot without it.
  await press(page, 'Start it');
  await runUntil(page, 'the command is refused', async () => (await text(page, '#drive-said')) === 'patrol: unknown command, send help for the list');
  await press(page, 'Write it to the board');
  await waitForText(page, '#routine-said', /^written and verified in [\d.]+ s$/);
  await page.clock.runFor(6000);
  await page.evaluate(() => (window.receivedText = ''));
  await gaitButton(page, 'patrol').click();
  await waitForBoardGait(page, 'patrol');
  // While the robot rests, the routine is still under way, and the page keeps sending lines.
  await page.clock.runFor(3500);
  assert.equal(await gaitOf(page), 'patrol');
  assert.ok(!(await page.evaluate(() => window.receivedText)).includes('deadman 0'));
  await runUntil(page, 'the routine is done', async () => (await page.locator('#log div', { hasText: /^# done$/ }).count()) === 1, 20);
  await page.clock.runFor(600);
  assert.equal(await gaitOf(page), 'stop');
  assert.match(await page.evaluate(() => window.receivedText), /deadman 901\n[^]*patrol\n[^]*deadman 0\n/);
});

test('a resting routine is stopped when the page is hidden', async () => {
  const page = await openWithBoard('robot', 8000);
  await putRoutine(page, ['walk 1', 'rest 9 s', 'walk 99']);
  await page.locator('#flash-robot').evaluate((button) => button.click());
  await runUntil(page, 'the robot is written', async () => /^written and verified/.test(await page.locator('#flash-said').textContent()));
  await page.clock.runFor(6000);
  await gaitButton(page, 'patrol').click();
  await waitForBoardGait(page, 'patrol');
  await page.clock.runFor(3500);
  await page.evaluate(() => (window.receivedText = ''));
  await hidePage(page);
  await page.clock.runFor(500);
  assert.match(await page.evaluate(() => window.receivedText), /^stop\n/);
});

test('unplugging a board while a routine is written is reported, and the board gets the routine later', async () => {
  const page = await openBoardWithRoutine(['walk 1']);
  await press(page, 'Write it to the board');
  await waitForText(page, '#routine-said', /^writing/, 20);
  await page.clock.runFor(60);
  await page.evaluate(() => window.unplug());
  await waitForText(page, '#routine-said', /^not written: .*\. The board has half a robot now: its firmware says fault=robot and moves no servo\. Write it again$/);
  assert.deepEqual(await readSteps(page), ['walk 1'], 'the routine is still in the page');
  await reconnect(page);
  await runUntil(page, 'the board greets', async () => (await text(page, '#where')) === 'on a board on USB with this firmware and no robot in it: write this one');
  await press(page, 'Write it to the board');
  await waitForText(page, '#routine-said', /^written and verified/);
});

test('with a firmware for another robot format the page says what to write', async () => {
  const page = await openWithBoard('robot', 8000);
  await page.evaluate(() => {
    const { start } = window.lizard.description;
    window.attachedBoard.flash[start + 4] ^= 1;
    window.attachedBoard.reset('external');
  });
  await runUntil(page, 'the board greets', async () => (await text(page, '#where')) === 'on a board on USB with this firmware and no robot in it: write this one');
  await page.locator('#log div', { hasText: '# fault: the robot in the flash is for another version, write it again' }).waitFor();
});

test('two pages in one browser each keep their own routine', async () => {
  const firstPage = await openRoutine();
  const [secondPage] = await Promise.all([firstPage.waitForEvent('popup'), firstPage.evaluate((address) => void window.open(address), address())]);
  await secondPage.waitForFunction(() => window.lizard);
  // The second page begins with the robot that the first page has stored, and then has its own changes.
  assert.deepEqual(await readSteps(secondPage), PATROL);
  const ownRoutines = [[firstPage, ['right 2']], [secondPage, ['left 2']]];
  for (const [page, expected] of ownRoutines) {
    const previousUrl = page.url();
    await putRoutine(page, expected);
    await page.waitForFunction((previousUrl) => location.href !== previousUrl, previousUrl);
  }
  for (const [page, expected] of ownRoutines) {
    await page.reload();
    await page.waitForFunction(() => window.lizard?.toml.includes('[routine.'));
    assert.deepEqual(await readSteps(page), expected);
  }
});

test('the browser reported no error or warning', () => assert.deepEqual(complaints, []));
