// The first connection, from a new board to a robot that walks and whose calibration is saved, with every interruption in between.
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, afterEach, before, test } from 'node:test';
import { promisify } from 'node:util';

import { openWithBoard, until } from './board.js';
import { advance, close, closePages, complaints, open, openStanding, overflow, page, PATIENCE, text, unfold } from './browser.js';
import { fakeSerial } from './fake-serial.js';

before(open);
afterEach(closePages);
after(close);

/** Arduino pins of A1 to A4, as robot.toml has them. */
const PINS = [9, 10, 11, 3];
const setup = (opened) => opened.locator('#setup');
const press = async (opened, name) => {
  await setup(opened).scrollIntoViewIfNeeded();
  await setup(opened).getByRole('button', { name, exact: true }).click();
};
const step = async (opened, name) => {
  await setup(opened).scrollIntoViewIfNeeded();
  await setup(opened).getByRole('list', { name: 'Steps' }).getByRole('button', { name: new RegExp(`${name}$`) }).click();
};
const pulses = (opened) => opened.evaluate((pins) => pins.map((pin) => window.pulses[pin]), PINS);

/** Advances the clock until the dialog shows this message. */
const waitForMessage = (opened, what) => until(opened, `${what} is said`, async () => what.test(await text(opened, '#setup-said')));

/** Presses a button and waits for a message. */
async function pressAndWait(opened, name, what) {
  await press(opened, name);
  await waitForMessage(opened, what);
}

function assertNear(found, wanted, by, what) {
  found.forEach((value, n) => assert.ok(Math.abs(value - wanted[n]) <= by, `${what}: ${found}, not ${wanted}`));
}

/** The robot's own answer to `cal`. */
async function readCalibration(opened) {
  const before = await opened.locator('#log div', { hasText: /^ok cal$/ }).count();
  await opened.getByLabel('A line for the robot').fill('cal');
  await opened.getByRole('button', { name: 'Send' }).click();
  await until(opened, 'cal is answered', async () => (await opened.locator('#log div', { hasText: /^ok cal$/ }).count()) > before);
  return (await opened.locator('#log div', { hasText: /^# A\d trim/ }).allInnerTexts()).slice(-4);
}

test('a new UNO becomes a calibrated robot that walks, and lizard calibrate restore accepts its file', async () => {
  const opened = await openWithBoard(null, 8000);
  await setup(opened).getByText('2 of 9: Write the firmware').waitFor();
  await setup(opened).getByText('The board on USB is a UNO by its boot loader, and this firmware is not on it.').waitFor();
  await pressAndWait(opened, 'Write firmware and robot', /^written and verified in [\d.]+ s$/);
  await until(opened, 'it greets', async () => (await setup(opened).getByText('has this firmware and this robot, robot.toml.').count()) > 0);
  await press(opened, 'Go on');

  // Before the servos get power there are no pulses.
  await pressAndWait(opened, 'Let the servos rest', /^No pulses now/);
  await opened.clock.runFor(200);
  await opened.evaluate(() => (window.pulses = {}));
  await opened.clock.runFor(500);
  assert.deepEqual(await pulses(opened), [undefined, undefined, undefined, undefined]);

  // Horns: by its pin, every servo stands in its middle.
  await pressAndWait(opened, 'Turn all servos to their middle', /1500 µs/);
  assertNear(await pulses(opened), [1500, 1500, 1500, 1500], 0.5, 'us of the middle');

  // Signs: A2 is mounted upside down, so the user answers no.
  await step(opened, 'Signs');
  for (const [servo, isWrong] of [[1, false], [2, true], [3, false], [4, false]]) {
    await pressAndWait(opened, `Turn A${servo}`, new RegExp(`^A${servo} was told to turn 10° counter-clockwise`));
    assertNear(await pulses(opened), [1, 2, 3, 4].map((n) => (n === servo ? 1600 : 1500)), 0.6, 'one servo alone');
    if (isWrong) {
      await pressAndWait(opened, 'No, the other way', new RegExp(`^The sign of A${servo} is "-" now`));
      await pressAndWait(opened, `Turn A${servo}`, new RegExp(`^A${servo} was told to turn 10° counter-clockwise`));
      assertNear(await pulses(opened), [1500, 1400, 1500, 1500], 0.6, 'the other way');
    }
    await press(opened, 'Yes');
  }
  await waitForMessage(opened, /^All four turn the right way/);
  await setup(opened).getByText('5 of 9: Straighten the cranks').waitFor();

  await press(opened, 'A3 back right');
  await pressAndWait(opened, '↻ 0.5°', /^The trim of A3 is -0\.50°/);
  await pressAndWait(opened, '↺ 0.1°', /^The trim of A3 is -0\.40°/);

  await step(opened, 'Scale');
  await pressAndWait(opened, 'Turn A1 by 20°', /^A1 was told to turn 20°/);
  assertNear(await pulses(opened), [1700, 1500, 1496, 1500], 0.6, 'twenty degrees of one servo');
  await setup(opened).getByLabel('It turned by, degrees').fill('18.5');
  await setup(opened).getByLabel('It turned by, degrees').press('Enter');
  // 10 us per degree, times 20, divided by 18.5.
  await waitForMessage(opened, /^The scale of A1 is 10\.81 µs per degree/);
  // Another scale leaves the horn where it is: the trim has other degrees then.
  await press(opened, 'A3 back right');
  await pressAndWait(opened, 'Turn A3 by 20°', /^A3 was told to turn 20°/);
  await setup(opened).getByLabel('It turned by, degrees').fill('18.5');
  await setup(opened).getByLabel('It turned by, degrees').press('Enter');
  await waitForMessage(opened, /^The scale of A3 is 10\.81 µs per degree/);
  await until(opened, 'it stands', async () => (await text(opened, '#doing')) === 'stand');
  await opened.clock.runFor(500);
  assertNear(await pulses(opened), [1500, 1500, 1496, 1500], 0.6, 'neutral is where it was');

  await step(opened, 'Limits');
  await until(opened, 'it stands', async () => (await text(opened, '#doing')) === 'stand');
  await press(opened, 'A4 back left');
  await pressAndWait(opened, '↻ 5°', /^A4 points to 216\.41°/);
  await press(opened, 'A4 back left');
  await setup(opened).getByLabel('From, degrees').fill('150');
  await setup(opened).getByLabel('From, degrees').press('Enter');
  await waitForMessage(opened, /^A4 goes from 150\.00° to 311\.41°/);

  await step(opened, 'First walk');
  assert.equal(await setup(opened).getByText('Not proven yet').count(), 0);
  await until(opened, 'it stands', async () => (await text(opened, '#doing')) === 'stand');
  await pressAndWait(opened, 'Let it walk', /^The robot does "walk"/);
  const place = await opened.evaluate(() => window.lizard.last.place.y);
  await opened.clock.runFor(3000);
  assert.ok((await opened.evaluate(() => window.lizard.last.place.y)) - place > 10, 'it walks');
  await pressAndWait(opened, 'Let it stand', /^The robot stands/);

  await setup(opened).getByRole('button', { name: 'Save it before', exact: true }).waitFor();
  await step(opened, 'Keep');
  await setup(opened).getByText('Not saved yet.').waitFor();
  await pressAndWait(opened, 'Save in the board', /^Saved: the board begins with it/);
  const coming = opened.waitForEvent('download');
  await press(opened, 'Save as a file');
  const file = await (await coming).path();

  // The restarted board has the calibration, and so has the file, as the host's program reads it.
  await opened.evaluate(() => window.otherBoard.reset('external'));
  await opened.clock.runFor(5000);
  assert.deepEqual(await readCalibration(opened), [
    '# A1 trim 0.00 limit 48.59 228.59 dir + scale 10.81',
    '# A2 trim 0.00 limit 311.41 131.41 dir - scale 10.00',
    '# A3 trim -0.37 limit 228.59 48.59 dir + scale 10.81',
    '# A4 trim 0.00 limit 150.00 311.41 dir + scale 10.00',
  ]);
  const folder = await mkdtemp(join(tmpdir(), 'lizard-'));
  try {
    const kept = join(folder, 'calibration.toml');
    await writeFile(kept, await readFile(file));
    const root = new URL('../..', import.meta.url).pathname;
    const robot = ['--sim', '--robot', 'robot.toml'];
    const { stdout } = await promisify(execFile)(process.env.LIZARD, ['calibrate', 'restore', kept, ...robot], { cwd: root, timeout: PATIENCE });
    assert.match(stdout, /has accepted and saved the calibration of .*/);
  } finally {
    await rm(folder, { recursive: true });
  }
});

test('a board with another robot is recognized, and gets only the page\'s robot written', async () => {
  const opened = await openWithBoard('large', 5000);
  await setup(opened).getByText('has this firmware and another robot, large ').waitFor();
  await pressAndWait(opened, 'Write this robot alone', /^written and verified in [\d.]+ s$/);
  await until(opened, 'it greets', async () => (await setup(opened).getByText('has this firmware and this robot, robot.toml.').count()) > 0);
});

test('a board that does not answer is reported, and no step is a dead end', async () => {
  const opened = await page({}, fakeSerial);
  await opened.evaluate(() => (window.flashed = null));
  await opened.locator('#connect').click();
  await opened.waitForFunction(() => window.otherBoard);
  await opened.evaluate(() => (window.otherBoard.send = () => {}));
  await opened.clock.runFor(10000);
  await setup(opened).getByText('answers neither as this firmware nor as a boot loader').waitFor();
  await pressAndWait(opened, 'Write firmware and robot', /^not written: no boot loader answers/);
  await step(opened, 'Horns');
  await setup(opened).getByText('No robot with this firmware answers').waitFor();
  await press(opened, 'To the board');
  await press(opened, 'Disconnect');
  await until(opened, 'the simulation is back', async () => /simulated UNO/.test(await text(opened, '#where')));
});

test('a board that sends meaningless bytes is not taken for a robot', async () => {
  const opened = await page({}, fakeSerial);
  await opened.evaluate(() => (window.garbage = true));
  await opened.locator('#connect').click();
  await opened.waitForFunction(() => window.otherBoard);
  await until(opened, 'it is asked about', async () => setup(opened).getByText('answers neither as this firmware nor as a boot loader').isVisible());
  await pressAndWait(opened, 'Write firmware and robot', /^not written: /);
  const lengths = await opened.locator('#log div').evaluateAll((lines) => lines.map(({ textContent }) => textContent.length));
  assert.ok(Math.max(0, ...lengths) < 1000, 'a line that never ends is cut');
});

test('unplugging the board is reported at any step, and the dialog continues where it was', async () => {
  const opened = await page({}, fakeSerial);
  const names = await opened.locator('#setup-steps button').allTextContents();
  assert.equal(names.length, 9);
  for (const name of names) {
    await opened.evaluate(() => (window.otherBoard = undefined));
    await opened.locator('#connect').click();
    await opened.waitForFunction(() => window.otherBoard);
    await opened.clock.runFor(4500);
    await step(opened, name);
    await opened.clock.runFor(400);
    // While an action is under way, if the step has one.
    const acts = setup(opened).locator('#setup-what button.main');
    const act = (await acts.count()) > 0 && !['Board', 'Firmware'].includes(name) ? acts.first() : null;
    if (act) await act.click();
    await opened.clock.runFor(60);
    await opened.evaluate(() => window.unplug());
    await until(opened, `${name} says it`, async () => /is not connected any more/.test(await text(opened, '#setup-said')));
    assert.match(await text(opened, '#setup-step'), new RegExp(`^${names.indexOf(name) + 1} of 9`), 'the step is kept');
    assert.equal(await setup(opened).getAttribute('aria-busy'), 'false', 'nothing waits for ever');
  }
});

test('a board that is unplugged while it is written says so, and can be written when it is back', async () => {
  const opened = await openWithBoard(null, 8000);
  await press(opened, 'Write firmware and robot');
  await opened.clock.runFor(1500);
  await opened.evaluate(() => window.unplug());
  await until(opened, 'it is said', async () => /is not connected any more|not written/.test(await text(opened, '#setup-said')));
  await opened.evaluate(() => (window.otherBoard = undefined));
  await until(opened, 'it may be connected', () => opened.locator('#connect').isEnabled());
  await opened.locator('#connect').click();
  await opened.waitForFunction(() => window.otherBoard);
  await opened.clock.runFor(8000);
  await pressAndWait(opened, 'Write firmware and robot', /^written and verified/);
});

test('an action that began on a board does not continue in the simulation when the board is unplugged', async () => {
  const opened = await openWithBoard('robot', 4500);
  await step(opened, 'Trims');
  await opened.clock.runFor(500);
  await opened.evaluate(() => window.unplug());
  for (const name of ['Trims', 'Keep', 'Firmware']) {
    await step(opened, name);
    await opened.clock.runFor(500);
    await setup(opened).locator('#setup-what').getByText('The board is not connected any more.').waitFor();
    assert.deepEqual(await setup(opened).locator('#setup-what button').allInnerTexts(), ['Connect it again…', 'Try this step on the simulated UNO'], name);
  }
  await press(opened, 'Try this step on the simulated UNO');
  await setup(opened).getByText('to the simulated UNO').waitFor();
});

test('the robot does not walk while it is being assembled', async () => {
  const opened = await openWithBoard('robot', 8000);
  await until(opened, 'the ways are known', async () => (await text(opened, '#gaits button[data-command="walk"] small')) !== '');
  await step(opened, 'Trims');
  await opened.clock.runFor(500);
  const before = (await opened.evaluate(() => window.heard)).length;
  await opened.locator('#log').focus();
  await opened.evaluate(() => {
    document.activeElement.blur();
    navigator.getGamepads = () => [{ axes: [0, -1], buttons: [] }];
  });
  await opened.keyboard.down('w');
  await opened.clock.runFor(500);
  await opened.keyboard.up('w');
  assert.ok(!(await opened.evaluate(() => window.heard)).slice(before).includes('walk'));
  await opened.evaluate(() => delete navigator.getGamepads);
  await press(opened, 'Leave');
  await until(opened, 'it is left', async () => !(await setup(opened).isVisible()));
  await opened.locator('#gaits button[data-command="walk"]').click();
  await until(opened, 'it walks', async () => (await opened.evaluate(() => window.lizard.gait)) === 'walk');
  await opened.locator('#setup-open').click();
  await until(opened, 'it is stopped', async () => (await opened.evaluate(() => window.lizard.gait)) !== 'walk');
});

test('a restart of the board is reported, with the loss of unsaved settings', async () => {
  const opened = await openWithBoard('robot', 4500);
  await setup(opened).getByText('3 of 9: Fit the horns').waitFor();
  await step(opened, 'Trims');
  await opened.clock.runFor(500);
  await pressAndWait(opened, '↺ 0.5°', /^The trim of A1 is 0\.50°/);
  await opened.evaluate(() => window.otherBoard.reset('external'));
  await waitForMessage(opened, /^The board has restarted\. What was not saved is lost\.$/);
  await pressAndWait(opened, '↺ 0.5°', /^The trim of A1 is 0\.50°/);
});

test('leaving restores the robot, and the dialog opens again at the same step', async () => {
  const opened = await openWithBoard('robot', 4500);
  const before = await readCalibration(opened);
  await step(opened, 'Trims');
  await opened.clock.runFor(500);
  await pressAndWait(opened, '↺ 0.5°', /^The trim of A1 is 0\.50°/);
  assert.notDeepEqual(await readCalibration(opened), before);
  await press(opened, 'Leave');
  await until(opened, 'it is left', async () => !(await setup(opened).isVisible()));
  await opened.getByText('the robot has the calibration that it had before').waitFor();
  assert.deepEqual(await readCalibration(opened), before);
  await opened.locator('#setup-open').click();
  await setup(opened).getByText('5 of 9: Straighten the cranks').waitFor();
  // Proven signs stay proven unless they are reset.
  await step(opened, 'Signs');
  await pressAndWait(opened, 'Turn A1', /^A1 was told to turn 10°/);
  await press(opened, 'Yes');
  await press(opened, 'Leave');
  await until(opened, 'it is left', async () => !(await setup(opened).isVisible()));
  await opened.locator('#setup-open').click();
  await step(opened, 'First walk');
  await setup(opened).getByText('Not proven yet: the sign of A2, A3, A4.').waitFor();
});

test('a refusal by the robot is shown in its words, and changes nothing', async () => {
  const opened = await openWithBoard('robot', 4500);
  const before = await readCalibration(opened);
  await step(opened, 'Limits');
  await opened.clock.runFor(1000);
  await setup(opened).getByLabel('From, degrees').fill('125');
  await setup(opened).getByLabel('From, degrees').press('Enter');
  await waitForMessage(opened, /^The robot refuses "limit 1 125\.00 228\.59": A1 would not reach what the gaits need/);
  assert.equal(await setup(opened).getByLabel('From, degrees').inputValue(), '48.59');
  assert.deepEqual(await readCalibration(opened), before);
});

const KEPT = `format = "lizard calibration 1"
boot = "stand"
deadman = 0
${[1, 2, 3, 4].map((n) => `[servo.A${n}]\ntrim = ${n}.25\nlimit = [${[48.59, 311.41, 228.59, 131.41][n - 1]}, ${[228.59, 131.41, 48.59, 311.41][n - 1]}]\ndir = "+"\nscale = 10.0\n`).join('')}`;

test('a saved calibration file is sent to the robot, and an invalid one is refused with its mistake', async () => {
  const opened = await openWithBoard('robot', 4500);
  await step(opened, 'Keep');
  await opened.clock.runFor(1500);
  const choose = (name, body) =>
    setup(opened).getByLabel('Open a saved file').setInputFiles({ name, mimeType: 'text/plain', buffer: Buffer.from(body) });
  await choose('mine.toml', KEPT);
  await waitForMessage(opened, /^The robot has the calibration of mine\.toml\. It is not saved yet\.$/);
  assert.match((await readCalibration(opened))[2], /^# A3 trim 3\.25 /);
  const before = await readCalibration(opened);
  const wrong = [
    ['<img src=x onerror="window.strange=1">.toml', 'hello', /^<img .*>\.toml:1: `hello` lacks the = /],
    ['a.toml', 'format = "lizard calibration 2"', /^a\.toml:1: format must be "lizard calibration 1"/],
    ['b.toml', KEPT.replace('2.25', '400'), /^b\.toml:\d+: servo\.A2\.trim is 400; it must be within -360 to 360 deg/],
    ['c.toml', KEPT.replace('"stand"', '"stand\\nsave"'), /^c\.toml:\d+: boot is not the name of a gait$/],
    ['d.toml', KEPT.replace('scale = 10.0', 'scale = 99.0'), /^The robot refuses "scale 1 99\.00": scale must be 5\.\.20/],
  ];
  for (const [name, body, message] of wrong) {
    await choose(name, body);
    await waitForMessage(opened, message);
    assert.deepEqual(await readCalibration(opened), before, `${name} changes nothing`);
  }
  assert.equal(await opened.evaluate(() => window.strange), undefined);
});

test('without a board every step can be tried, by the keyboard alone', async () => {
  const opened = await openStanding();
  await opened.locator('#setup-open').focus();
  await opened.keyboard.press('Enter');
  assert.equal(await opened.evaluate(() => document.activeElement.id), 'setup-step');
  /** Goes to a control by the Tab key, past all other controls if needed. */
  const tabTo = async (name) => {
    for (let n = 0; n < 40; n++) {
      if ((await opened.evaluate(() => document.activeElement.textContent)) === name) return;
      await opened.keyboard.press('Tab');
    }
    assert.fail(`no tab leads to ${name}`);
  };
  for (const title of ['Write the firmware', 'Fit the horns']) {
    await tabTo('Next step');
    await opened.keyboard.press('Enter');
    await setup(opened).getByText(title).first().waitFor();
  }
  await tabTo('Turn all servos to their middle');
  await opened.keyboard.press('Enter');
  // Keys must not drive while the user's fingers may be in the robot.
  await opened.keyboard.down('ArrowUp');
  for (let n = 0; n < 40 && (await text(opened, '#setup-said')) === ''; n++) await advance(opened, 250);
  assert.match(await text(opened, '#setup-said'), /^Every servo holds its middle now/);
  assert.equal(await opened.evaluate(() => document.activeElement.textContent), 'Turn all servos to their middle', 'it stays where it was');
  await advance(opened, 500);
  await opened.keyboard.up('ArrowUp');
  await unfold(opened, '#pulses');
  await opened.waitForFunction(() => document.querySelector('#widths td:nth-child(3)').textContent !== '–');
  assert.deepEqual(await opened.locator('#widths td:nth-child(3)').allInnerTexts(), ['1500.00', '1500.00', '1500.00', '1500.00']);
});

for (const [name, options] of [
  ['a phone', { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true }],
  ['the narrowest screen', { viewport: { width: 320, height: 640 }, hasTouch: true, isMobile: true }],
]) {
  test(`every step fits on ${name} without scrolling sideways`, async () => {
    const opened = await openStanding(options);
    await opened.locator('#setup-open').tap();
    for (const button of await opened.locator('#setup-steps button').all()) {
      await button.tap();
      await advance(opened, 1500);
      const outside = await opened.evaluate(() =>
        [...document.querySelectorAll('#setup :not(#setup-steps *):is(button, table, svg)')].filter((each) => each.getBoundingClientRect().right > innerWidth).map(({ textContent }) => textContent),
      );
      assert.equal(await overflow(opened), 0, await text(opened, '#setup-step'));
      assert.deepEqual(outside, []);
      // The row of steps scrolls, so that the current step's name is visible.
      const at = await opened.locator('#setup-steps [aria-current]').evaluate((button) => {
        const { left, right } = button.getBoundingClientRect();
        return { isSeen: left >= 0 && right <= innerWidth, isWhole: button.scrollWidth <= button.clientWidth, size: Number.parseFloat(getComputedStyle(button).fontSize) };
      });
      assert.ok(at.isSeen && at.isWhole && at.size >= 12, JSON.stringify(at));
    }
  });
}

test('the browser reported no error or warning', () => assert.deepEqual(complaints, []));
