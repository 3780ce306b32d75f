// Routines: a drive is recorded as steps, the steps are a view of robot.toml, and the robot repeats them.
import assert from 'node:assert/strict';
import { after, afterEach, before, test } from 'node:test';

import { openWithBoard, until } from './board.js';
import { address, advance, close, closePages, complaints, open, openStanding, text, unfold } from './browser.js';

before(open);
afterEach(closePages);
after(close);

const PATROL = ['stand 1 s', 'walk 2', 'left 3', 'look 1'];

const toml = (page) => page.evaluate(() => window.lizard.toml);
const gait = (page, name) => page.locator(`#gaits button[data-command="${name}"]`);
const steps = (page) => page.locator('#routine-steps input').evaluateAll((inputs) => inputs.map(({ value }) => value));
const step = (page, number) => page.getByLabel(`Step ${number}`, { exact: true });
const press = async (page, name) => {
  await unfold(page, '#routines');
  await page.locator('#routines').getByRole('button', { name, exact: true }).click();
};
/** Waits until the panel shows these steps. */
const waitForSteps = (page, wanted) =>
  page.waitForFunction(
    (wanted) => JSON.stringify([...document.querySelectorAll('#routine-steps input')].map(({ value }) => value)) === wanted,
    JSON.stringify(wanted),
  );
/** Reads the steps in the text of the robot. */
const readSteps = (page) => page.evaluate(() => window.lizard.robot.constructor.routines(window.lizard.toml).at(-1)?.steps);
const waitForPrediction = (page) => page.waitForFunction(() => document.querySelector('#routine-round').textContent !== '');
const track = (page) => page.locator('#routine-path .track').getAttribute('d');

/** Puts a routine into the page's robot, at the end of its text. */
async function putRoutine(page, steps, name = 'patrol') {
  await page.evaluate(([name, steps]) => {
    const { lizard } = window;
    return lizard.change(lizard.robot.constructor.putSteps(lizard.toml, name, steps).text).then(() => null);
  }, [name, steps]);
}

/** Opens the panel with a routine, for a robot that stands. */
async function openRoutine(routine = PATROL, options = {}) {
  const page = await openStanding(options);
  await unfold(page, '#routines');
  if (!routine) return page;
  await putRoutine(page, routine);
  await waitForSteps(page, routine);
  return page;
}

/** Runs the simulation for some seconds of its own time. */
async function drive(page, seconds) {
  const time = () => page.evaluate(() => window.lizard.clock);
  const end = (await time()) + seconds;
  for (let n = 0; (await time()) < end - 0.01; n++) {
    // The page asks for the status twice a second of real time, too rarely for a simulation this fast.
    if (n % 25 === 0) await page.evaluate(() => void window.lizard.status());
    await advance(page, 20);
  }
}

test('a drive is recorded by the robot\'s motions, and its replay goes where predicted', async () => {
  const page = await openRoutine(null);
  await page.waitForFunction(() => ['walk', 'left'].every((name) => document.querySelector(`#gaits button[data-command="${name}"] small`).textContent));
  await page.getByText('This robot has no routine yet.').waitFor();
  await press(page, 'Record a drive');
  await page.getByText('Recording: drive now').waitFor();
  const place = () => page.evaluate(() => window.lizard.last.place);
  const before = await place();
  await page.keyboard.down('ArrowUp');
  await page.waitForFunction(() => window.lizard.gait === 'walk');
  await drive(page, 3.6);
  await page.keyboard.up('ArrowUp');
  await page.waitForFunction(() => window.lizard.gait === 'stop');
  // The body's displacement shows how many cycles have passed.
  const cycles = ((await place()).y - before.y) / 33.2;
  await drive(page, 2);
  await page.keyboard.down('ArrowLeft');
  await page.waitForFunction(() => window.lizard.gait === 'left');
  await drive(page, 2.6);
  await page.keyboard.up('ArrowLeft');
  await page.waitForFunction(() => window.lizard.gait === 'stop');
  await drive(page, 1);
  await press(page, 'Stop recording');
  const said = await text(page, '#routine-said');
  const [, walked, pause, turns] = (/^Recorded: walk (\d+), stand ([\d.]+) s, left (\d+)$/.exec(said) ?? assert.fail(said)).map(Number);
  assert.ok(walked >= 3 && walked < cycles + 0.2 && walked > cycles - 1.2, `${said}, ${cycles} cycles`);
  // The page also advances by itself, so this is a lower bound.
  assert.ok(pause >= 1.9, said);
  assert.equal(await page.locator('#routine-name').inputValue(), 'patrol');
  await press(page, 'Keep it');
  const recorded = [`walk ${walked}`, `stand ${pause} s`, `left ${turns}`];
  await waitForSteps(page, recorded);
  assert.ok((await toml(page)).endsWith(`\n[routine.patrol]\nsteps = ["${recorded.join('", "')}"]\n`));
  await waitForPrediction(page);
  const [, seconds, ahead, , , turned] = /^A round takes ([\d.]+) s and ends (-?\d+) mm ahead and (\d+) mm to the (right|left) of its start, turned by (-?\d+)°\.$/
    .exec(await text(page, '#routine-round'));
  assert.ok(Math.abs(ahead - 33.2 * walked) < 15 && Math.abs(turned - 14.1 * turns) < 10, `${ahead} mm, ${turned} deg`);
  await advance(page, 2500);
  await press(page, 'Start it');
  await advance(page, 100);
  await page.waitForFunction(() => window.lizard.gait === 'patrol');
  assert.equal(await gait(page, 'patrol').getAttribute('aria-pressed'), 'true');
  await advance(page, seconds * 1000 + 200);
  await page.locator('#log div', { hasText: '# done' }).waitFor();
  assert.equal(await page.evaluate(() => window.lizard.gait), 'stop');
  const { y, heading } = await place();
  assert.ok(Math.abs(y - ahead) < 0.03 * ahead + 1, `${y} mm ahead, predicted ${ahead}`);
  assert.ok(Math.abs(heading - turned) < 0.03 * turned + 1, `turned by ${heading} deg, predicted ${turned}`);
});

test('the recording follows the robot\'s reports, not the pressed buttons', async () => {
  const page = await openRoutine(null);
  await press(page, 'Record a drive');
  // A line with three cycles ends by itself; a refused line starts no gait.
  for (const [line, seconds] of [['walk 3', 5], ['rest', 2], ['walk', 1], ['stand', 1.5], ['look', 0.8], ['center', 1]]) {
    await page.evaluate((line) => void window.lizard.ask(line), line);
    await drive(page, seconds);
  }
  await press(page, 'Stop recording');
  const said = await text(page, '#routine-said');
  // The page also advances by itself, so these times are lower bounds.
  const [, rest, stand, look] = (/^Recorded: walk 3, stand [\d.]+ s, rest ([\d.]+) s, stand ([\d.]+) s, look ([\d.]+) s$/.exec(said) ?? assert.fail(said)).map(Number);
  assert.ok(rest >= 2.9 && stand >= 1.4 && look >= 0.7, said);
  await press(page, 'Drop it');
  assert.equal(await page.locator('#routine-recorded').isVisible(), false);
  await press(page, 'Record a drive');
  await drive(page, 1);
  await press(page, 'Stop recording');
  await page.getByText('Nothing is recorded: the robot has not walked.').waitFor();
});

test('the recorded number of cycles is that of the walk, at whatever phase of the previous gait it began', async () => {
  const page = await openRoutine(null);
  for (let tenth = 0; tenth < 10; tenth++) {
    await press(page, 'Record a drive');
    await page.evaluate(() => void window.lizard.ask('stand'));
    await drive(page, 0.5 + 0.1 * tenth);
    await page.evaluate(() => void window.lizard.ask('walk 2'));
    await advance(page, 60);
    await page.evaluate(() => void window.lizard.status());
    await drive(page, 3);
    await press(page, 'Stop recording');
    assert.match(await text(page, '#routine-said'), /^Recorded: walk 2$/, `after ${tenth} tenths`);
    await press(page, 'Drop it');
  }
});

test('a drive of a board is recorded by its own phase, even if its link was cut', async () => {
  const page = await openWithBoard('robot', 8000);
  await unfold(page, '#routines');
  await press(page, 'Record a drive');
  const doing = (name) => until(page, `it does ${name}`, async () => (await page.evaluate(() => window.lizard.gait)) === name, 20);
  await gait(page, 'walk').click();
  await doing('walk');
  // A walk begins with a quarter of a second to its first pose, so less than four cycles have passed.
  await page.clock.runFor(4100);
  await gait(page, 'back').click();
  await doing('back');
  await page.clock.runFor(2600);
  // The link is lost: the robot stops by itself after 0.9 s.
  await page.evaluate(() => {
    const board = window.otherBoard;
    const { send, onByte } = board;
    board.send = board.onByte = () => {};
    setTimeout(() => Object.assign(board, { send, onByte }), 8000);
  });
  await page.clock.runFor(8500);
  await doing('stop');
  await page.clock.runFor(500);
  await press(page, 'Stop recording');
  assert.match(await text(page, '#routine-said'), /^Recorded: walk 3, back [23]$/);
});

test('steps are changed, moved, copied and deleted by keys alone, and each is undone', async () => {
  const page = await openRoutine();
  const known = [PATROL];
  const does = async (act, wanted) => {
    await act();
    await waitForSteps(page, wanted);
    await page.waitForFunction((wanted) => window.lizard.toml.includes(`steps = ${wanted}`), `["${wanted.join('", "')}"]`);
    known.push(wanted);
  };
  const focused = () => page.evaluate(() => document.activeElement?.getAttribute('aria-label'));
  await does(async () => {
    await step(page, 2).fill(' walk 5 ');
    await page.keyboard.press('Enter');
  }, ['stand 1 s', 'walk 5', 'left 3', 'look 1']);
  const key = async (label) => {
    await page.getByLabel(label, { exact: true }).focus();
    await page.keyboard.press('Enter');
  };
  await does(() => key('Move down step 2'), ['stand 1 s', 'left 3', 'walk 5', 'look 1']);
  await page.waitForFunction(() => document.activeElement?.getAttribute('aria-label') === 'Move down step 3');
  await does(() => page.keyboard.press('Enter'), ['stand 1 s', 'left 3', 'look 1', 'walk 5']);
  await does(() => key('Copy step 2'), ['stand 1 s', 'left 3', 'left 3', 'look 1', 'walk 5']);
  await does(() => key('Delete step 1'), ['left 3', 'left 3', 'look 1', 'walk 5']);
  await does(() => key('Move up step 4'), ['left 3', 'left 3', 'walk 5', 'look 1']);
  await page.waitForFunction(() => document.activeElement?.getAttribute('aria-label') === 'Move up step 3');
  assert.equal(await focused(), 'Move up step 3');
  await does(() => press(page, 'Add a step'), ['left 3', 'left 3', 'walk 5', 'look 1', 'look 1']);
  for (const wanted of known.slice(0, -1).reverse()) {
    await page.locator('#routine-undo').click();
    await waitForSteps(page, wanted);
  }
  assert.deepEqual(await readSteps(page), PATROL);
});

test('the list follows the text, and the text the list, with all its other lines', async () => {
  const page = await openRoutine();
  await unfold(page, '#robot-editor');
  const own = `${await toml(page)}repeat = 3 # rounds\n\n[routine.about]\nsteps = [\n  "left 12", # half a turn\n]\n`;
  await page.locator('#robot-text').fill(own);
  await unfold(page, '#routines');
  assert.deepEqual(await page.locator('#routine option').allInnerTexts(), ['patrol', 'about'], 'before it is used');
  await page.locator('#robot-take').click();
  await page.locator('#routine').selectOption('about');
  await waitForSteps(page, ['left 12']);
  await page.locator('#routine').selectOption('patrol');
  await press(page, 'Delete step 4');
  await page.waitForFunction((wanted) => window.lizard.toml === wanted, own.replace('"left 3", "look 1"', '"left 3"'));
  assert.equal(await page.locator('#robot-text').inputValue(), await toml(page));
  assert.deepEqual(await page.locator('#gaits button').allInnerTexts().then((all) => all.slice(-2).map((name) => name.trim())), ['patrol', 'about']);
});

test('while a step is dragged its path is drawn, and the text changes when it is let go', async () => {
  const page = await openRoutine(['walk 3', 'left 6', 'walk 1']);
  await waitForPrediction(page);
  const [before, first] = [await toml(page), await track(page)];
  const grip = (number) => page.locator('#routine-steps .grip').nth(number - 1);
  const middle = async (number) => {
    await grip(number).scrollIntoViewIfNeeded();
    const { x, y, width, height } = await grip(number).boundingBox();
    return [x + width / 2, y + height / 2];
  };
  await page.mouse.move(...(await middle(1)));
  await page.mouse.down();
  await page.mouse.move(...(await middle(3)), { steps: 5 });
  await page.waitForFunction((first) => document.querySelector('#routine-path .track').getAttribute('d') !== first, first);
  assert.deepEqual(await steps(page), ['left 6', 'walk 1', 'walk 3'], 'as if it were let go');
  assert.equal(await toml(page), before);
  await page.mouse.move(...(await middle(1)), { steps: 5 });
  await page.waitForFunction((first) => document.querySelector('#routine-path .track').getAttribute('d') === first, first);
  await page.mouse.up();
  assert.equal(await toml(page), before, 'it is where it was');
  await page.mouse.move(...(await middle(1)));
  await page.mouse.down();
  await page.mouse.move(...(await middle(2)), { steps: 5 });
  await page.mouse.up();
  await page.waitForFunction(() => window.lizard.toml.includes('steps = ["left 6", "walk 3", "walk 1"]'));
  await page.waitForFunction((first) => document.querySelector('#routine-path .track').getAttribute('d') !== first, first);
});

test('a finger drags a step, too', async () => {
  const page = await openRoutine(['walk 3', 'left 6'], { viewport: { width: 360, height: 740 }, hasTouch: true, isMobile: true });
  const touch = await page.context().newCDPSession(page);
  const grip = page.locator('#routine-steps .grip');
  await grip.first().scrollIntoViewIfNeeded();
  const [from, to] = [await grip.nth(0).boundingBox(), await grip.nth(1).boundingBox()];
  const x = from.x + from.width / 2;
  await touch.send('Input.dispatchTouchEvent', { type: 'touchStart', touchPoints: [{ x, y: from.y + 10 }] });
  for (let share = 0; share <= 1; share += 0.1) await touch.send('Input.dispatchTouchEvent', { type: 'touchMove', touchPoints: [{ x, y: from.y + 10 + share * (to.y - from.y + 5) }] });
  await touch.send('Input.dispatchTouchEvent', { type: 'touchEnd', touchPoints: [] });
  await page.waitForFunction(() => window.lizard.toml.includes('steps = ["left 6", "walk 3"]'));
});

test('a mistake is shown at its block with its line and its step, and the previous robot walks on', async () => {
  const page = await openRoutine();
  const before = await toml(page);
  const line = before.split('\n').findIndex((text) => text.startsWith('steps = ')) + 1;
  await step(page, 2).fill('wolk 4');
  await page.keyboard.press('Enter');
  const block = page.locator('#routine-steps li', { has: step(page, 2) });
  const message = `robot.toml:${line}: routine.patrol.steps: step 2, "wolk 4", names the gait "wolk", which does not exist; did you mean "walk"?`;
  await block.getByText(message).waitFor();
  assert.deepEqual(await page.locator('#routine-steps input[aria-invalid="true"]').evaluateAll((all) => all.map(({ value }) => value)), ['wolk 4']);
  assert.equal(await toml(page), before);
  assert.ok((await page.locator('#routine-start').isDisabled()) && (await page.locator('#routine-write').isDisabled()));
  assert.equal(await page.locator('#robot-editor').getAttribute('open'), null, 'nobody is led away');
  // Unknown text moves with its block, letter by letter.
  await press(page, 'Move down step 2');
  await page.locator('#routine-steps li', { has: step(page, 3) }).getByText(message.replace('step 2', 'step 3')).waitFor();
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
  await drive(page, 3);
  await press(page, 'Stop recording');
  assert.equal(await page.locator('#routine-name').inputValue(), 'patrol-2', 'the first one is taken');
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
  const page = await openWithBoard('robot', 8000);
  await unfold(page, '#routines');
  await putRoutine(page, ['walk 2', 'rest 2 s', 'left 1']);
  await waitForSteps(page, ['walk 2', 'rest 2 s', 'left 1']);
  // Until it is written, the board has the robot without it.
  await press(page, 'Start it');
  await until(page, 'it is refused', async () => (await text(page, '#drive-said')) === 'patrol: unknown command, send help for the list');
  await press(page, 'Write it to the board');
  await until(page, 'it is written', async () => /^written and verified in [\d.]+ s$/.test(await text(page, '#routine-said')));
  await page.clock.runFor(6000);
  await page.evaluate(() => (window.heard = ''));
  await gait(page, 'patrol').click();
  const doing = () => page.evaluate(() => window.lizard.gait);
  await until(page, 'it patrols', async () => (await doing()) === 'patrol', 20);
  // While the robot rests, the routine is still under way, and the page keeps sending lines.
  await page.clock.runFor(3500);
  assert.equal(await doing(), 'patrol');
  assert.ok(!(await page.evaluate(() => window.heard)).includes('deadman 0'));
  await until(page, 'it is done', async () => (await page.locator('#log div', { hasText: /^# done$/ }).count()) === 1, 20);
  await page.clock.runFor(600);
  assert.equal(await doing(), 'stop');
  assert.match(await page.evaluate(() => window.heard), /deadman 901\n[^]*patrol\n[^]*deadman 0\n/);
});

test('a resting routine is stopped when the page is hidden', async () => {
  const page = await openWithBoard('robot', 8000);
  await putRoutine(page, ['walk 1', 'rest 9 s', 'walk 99']);
  await page.locator('#flash-robot').evaluate((button) => button.click());
  await until(page, 'it is written', async () => /^written and verified/.test(await page.locator('#flash-said').textContent()));
  await page.clock.runFor(6000);
  await gait(page, 'patrol').click();
  await until(page, 'it patrols', async () => (await page.evaluate(() => window.lizard.gait)) === 'patrol', 20);
  await page.clock.runFor(3500);
  await page.evaluate(() => {
    window.heard = '';
    Object.defineProperty(document, 'hidden', { value: true });
    document.dispatchEvent(new Event('visibilitychange'));
  });
  await page.clock.runFor(500);
  assert.match(await page.evaluate(() => window.heard), /^stop\n/);
});

test('a board that is unplugged while a routine is written says so, and gets it when it is back', async () => {
  const page = await openWithBoard('robot', 8000);
  await unfold(page, '#routines');
  await putRoutine(page, ['walk 1']);
  await waitForSteps(page, ['walk 1']);
  await press(page, 'Write it to the board');
  await until(page, 'it is being written', async () => (await text(page, '#routine-said')).startsWith('writing'), 20);
  await page.clock.runFor(60);
  await page.evaluate(() => window.unplug());
  await until(page, 'it says so', async () => /^not written: .*\. The board has half a robot now: its firmware says fault=robot and moves no servo\. Write it again$/.test(await text(page, '#routine-said')));
  assert.deepEqual(await readSteps(page), ['walk 1'], 'the routine is still in the page');
  await until(page, 'it may be connected', () => page.locator('#connect').isEnabled());
  await page.evaluate(() => (window.same = true));
  await page.locator('#connect').click();
  await until(page, 'it greets', async () => (await text(page, '#where')) === 'on a board on USB with this firmware and no robot in it: write this one');
  await press(page, 'Write it to the board');
  await until(page, 'it is written', async () => /^written and verified/.test(await text(page, '#routine-said')));
});

test('with a firmware for another robot format the page says what to write', async () => {
  const page = await openWithBoard('robot', 8000);
  await page.evaluate(() => {
    const { start } = window.lizard.description;
    window.otherBoard.flash[start + 4] ^= 1;
    window.otherBoard.reset('external');
  });
  await until(page, 'it greets', async () => (await text(page, '#where')) === 'on a board on USB with this firmware and no robot in it: write this one');
  await page.locator('#log div', { hasText: '# fault: the robot in the flash is for another version, write it again' }).waitFor();
});

test('two pages in one browser keep a routine each', async () => {
  const one = await openRoutine();
  const [other] = await Promise.all([one.waitForEvent('popup'), one.evaluate((address) => void window.open(address), address())]);
  await other.waitForFunction(() => window.lizard);
  // It begins with the copy that the first page has stored; later changes are its own.
  assert.deepEqual(await readSteps(other), PATROL);
  const own = [[one, ['right 2']], [other, ['left 2']]];
  for (const [page, wanted] of own) {
    const before = page.url();
    await putRoutine(page, wanted);
    await page.waitForFunction((before) => location.href !== before, before);
  }
  for (const [page, wanted] of own) {
    await page.reload();
    await page.waitForFunction(() => window.lizard?.toml.includes('[routine.'));
    assert.deepEqual(await readSteps(page), wanted);
  }
});

test('the browser reported no error or warning', () => assert.deepEqual(complaints, []));
