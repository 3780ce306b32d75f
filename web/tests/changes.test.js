// The user's changes are in the downloaded file and survive a reload.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { after, afterEach, before, test } from 'node:test';

import { address, advance, close, complaints, open, openStanding, closePages, type, unfold } from './browser.js';

before(open);
afterEach(closePages);
after(close);

/** Sets a slider to a value, as a user would. */
async function setSlider(opened, label, value) {
  await opened.getByLabel(label).fill(value);
}

async function download(opened, button = 'Download robot.toml') {
  const coming = opened.waitForEvent('download');
  await opened.getByRole('button', { name: button }).click();
  const file = await (await coming).path();
  return readFile(file, 'utf8');
}

/** Reads the number of a key in a table of a robot.toml line by line, without a parser. */
function readNumber(toml, table, key) {
  const lines = toml.split('\n');
  const begin = lines.findIndex((line) => line.startsWith(`[${table}]`));
  const length = lines.slice(begin + 1).findIndex((line) => line.startsWith('['));
  const within = lines.slice(begin + 1, length < 0 ? undefined : begin + 1 + length);
  const line = within.find((line) => line.startsWith(`${key} =`));
  return line && parseFloat(line.split('=')[1]);
}

async function openChanged() {
  const opened = await openStanding();
  await opened.getByLabel('Driven by').selectOption('strut');
  await setSlider(opened, 'Pull in the strut', '2.5');
  await setSlider(opened, 'Play of a leg', '0.5');
  await setSlider(opened, 'Front left foot too long', '-0.6');
  await setSlider(opened, 'Stiffness of a foot', '2');
  await setSlider(opened, 'Pad friction', '0.5');
  await setSlider(opened, 'Friction back : ahead', '1.5');
  await setSlider(opened, 'Mass', '412');
  await unfold(opened, '#lengths-panel');
  const crank = opened.locator('input[name="leg.crank"]');
  await crank.fill('40');
  await crank.press('Enter');
  await opened.waitForFunction(() => window.lizard.description.lengths.find(({ key }) => key === 'leg.crank').value === 40);
  return opened;
}

test('the downloaded robot.toml has lengths, drive, feet, floor and mass', async () => {
  const opened = await openChanged();
  const toml = await download(opened);
  const found = [
    ['leg', 'crank'],
    ['leg.drive', 'force'],
    ['leg.drive', 'play'],
    ['feet', 'twist'],
    ['feet', 'stiffness'],
    ['ground', 'friction'],
    ['ground', 'friction_back_over_forward'],
    ['body', 'mass'],
  ].map(([table, key]) => readNumber(toml, table, key));
  assert.deepEqual(found, [40, 2.5, 0.5, -0.6, 2, 0.5, 1.5, 412]);
  assert.match(toml, /^kind = "strut"$/m);
});

/** Types a length that is refused; returns the message, and the text of the button with the nearest valid one. */
async function typeRefused(opened, key, value) {
  const box = opened.locator(`#lengths input[name="${key}"]`);
  await box.fill(String(value));
  await box.press('Enter');
  const way = opened.locator('#lengths-instead button');
  await way.waitFor();
  return [await opened.locator('#lengths-refusal').innerText(), await way.innerText()];
}

const length = (opened, name) => opened.evaluate((name) => window.lizard.description.lengths.find(({ key }) => key === name).value, name);

test('a refused length is explained by its effect on the robot, with the nearest valid one', async () => {
  const opened = await openStanding();
  await unfold(opened, '#lengths-panel');
  await opened.locator('#sketch circle').first().waitFor();
  const [said, way] = await typeRefused(opened, 'links.l12', 80);
  assert.equal(said, '80 mm is too long: in the neutral pose the left slider would run into its end.');
  const nearest = Number(/^Try ([0-9.]+) mm$/.exec(way)?.[1]);
  assert.ok(nearest > 45 && nearest < 80, way);
  await opened.locator('#lengths-instead button').click();
  await opened.waitForFunction((nearest) => window.lizard.description.lengths.find(({ key }) => key === 'links.l12').value === nearest, nearest);
  assert.equal(await opened.locator('#lengths-instead button').count(), 0);
  // Half a millimetre more is refused, so this one is the nearest.
  const box = opened.locator('#lengths input[name="links.l12"]');
  await box.fill(String(nearest + 0.5));
  await box.press('Enter');
  await opened.locator('#lengths-refusal', { hasText: `${nearest + 0.5} mm is too long` }).waitFor();
  assert.equal(await length(opened, 'links.l12'), nearest);
});

test('a button drops the gait that forbids a length, and the length is accepted', async () => {
  const opened = await openStanding();
  await unfold(opened, '#lengths-panel');
  await opened.locator('#sketch circle').first().waitFor();
  assert.deepEqual(await typeRefused(opened, 'links.l2', 60), ['60 mm is too long: in "look" the left front leg would lock.', 'Drop “look”']);
  await opened.locator('#lengths-instead button', { hasText: 'Drop' }).click();
  await opened.waitForFunction(() => window.lizard.description.lengths.find(({ key }) => key === 'links.l2').value === 60);
  const gaits = await opened.evaluate(() => window.lizard.description.gaits.map(({ name }) => name));
  assert.ok(!gaits.includes('look') && gaits.includes('walk'), gaits.join());
  await unfold(opened, '#robot-editor');
  await opened.locator('#robot-undo').click();
  await opened.waitForFunction(() => window.lizard.description.gaits.some(({ name }) => name === 'look'));
});

test('an unchanged file is downloaded unchanged', async () => {
  const opened = await openStanding();
  await unfold(opened, '#lengths-panel');
  const own = await readFile(new URL('../dist/files/robot.toml', import.meta.url), 'utf8');
  assert.equal(await download(opened), own);
});

test('a reload keeps the user\'s changes', async () => {
  const opened = await openChanged();
  await opened.locator('#servos').selectOption('ideal');
  await opened.reload();
  await opened.waitForFunction(() => window.lizard);
  const { floor, lengths, servos } = await opened.evaluate(() => {
    const { floor, description, servos } = window.lizard;
    return { floor, lengths: description.lengths, servos };
  });
  const { rate, ...set } = floor;
  const drive = { kind: 'strut', force: 2.5, play: 0.5 };
  assert.deepEqual(set, { friction: 0.5, ratio: 1.5, mass: 412, leaf: 2, twist: -0.6, ...drive });
  assert.ok(rate > 0, 'the spring of the parts has a rate');
  assert.equal(lengths.find(({ key }) => key === 'leg.crank').value, 40);
  assert.equal(servos, 'ideal');
  assert.equal(await opened.locator('#servos').inputValue(), 'ideal');
  assert.equal(await opened.locator('#mass').inputValue(), '412');
});

test('stored changes to a file that has changed since are dropped, with a message', async () => {
  const opened = await openChanged();
  await opened.evaluate(() => {
    const key = Object.keys(localStorage)[0];
    const kept = JSON.parse(localStorage.getItem(key));
    localStorage.setItem(key, JSON.stringify({ ...kept, original: `${kept.original}\n` }));
  });
  // While the address holds the robot, nothing would be lost.
  await opened.waitForFunction(() => location.hash.includes('robot='));
  await opened.goto(address());
  await opened.waitForFunction(() => window.lizard);
  await opened.locator('#trouble', { hasText: 'robot.toml is not the file of last time' }).waitFor();
  assert.equal(await opened.evaluate(() => window.lizard.toml), await readFile(new URL('../dist/files/robot.toml', import.meta.url), 'utf8'));
  const lost = await download(opened, 'Download what was changed');
  assert.deepEqual([readNumber(lost, 'leg', 'crank'), readNumber(lost, 'body', 'mass')], [40, 412], 'they are not lost');
});

test('the pace slider shows the robot\'s pace after a typed line and after a reset', async () => {
  const opened = await openStanding();
  await advance(opened, 3000);
  await type(opened, 'speed 35', 'ok speed 35');
  const slider = opened.getByLabel('Pace');
  assert.equal(await slider.inputValue(), '35');
  await opened.locator('#reset').click();
  // No status has been asked for yet.
  await advance(opened, 2000);
  assert.equal(await slider.inputValue(), '100');
  assert.equal(await opened.locator('#speed-out').innerText(), '100 %');
  assert.match(await type(opened, 'status', 'ok gait=stand'), / speed=100( |$)/);
});

test("the share of the servos' line is that of the robot's pace and of the servos' supply", async () => {
  const opened = await openStanding();
  await unfold(opened, '#power');
  const note = async (pace) => {
    const line = opened.locator('#line-note', { hasText: `line at ${pace} % of its pace` });
    await line.waitFor();
    return Number((await line.innerText()).match(/, (\d\.\d\d) of/)[1]);
  };
  await advance(opened, 3000);
  const full = await note(100);
  await type(opened, 'speed 50', 'ok speed 50');
  const half = await note(50);
  // docs/gaits.md: the hardest gait uses 0.82 and 0.51.
  assert.deepEqual([full, half], [0.82, 0.51]);
  // Those of docs/gaits.md to a hundredth, with a mark from 0.9.
  const shows = async (...shares) => {
    const lines = await opened.locator('#gaits .line').allInnerTexts();
    assert.equal(lines.length, shares.length);
    for (const [n, line] of lines.entries()) {
      const share = Number(line.match(/line (\d\.\d\d)$/)[1]);
      assert.ok(Math.abs(share - shares[n]) < 0.011, `${line}, not ${shares[n]}`);
      assert.equal(line.startsWith('⚠'), share >= 0.9, line);
    }
  };
  await shows(0.45, 0.49, 0.51, 0.45, 0.5, 0.5, 0.45, 0.45, 0.24);
  await type(opened, 'speed 100', 'ok speed 100');
  await setSlider(opened, 'Supply of the servos', '4.2');
  await opened.locator('#line-note.warning').waitFor();
  await opened.waitForFunction(() => [...document.querySelectorAll('#gaits .line')].at(-1).textContent > 'line 0.3');
  await shows(0.83, 0.92, 0.93, 0.83, 0.93, 0.93, 0.82, 0.82, 0.33);
  // Another model comes with a supply of its own.
  await opened.locator('#servos').selectOption('MG90S');
  assert.equal(await opened.getByLabel('Supply of the servos').inputValue(), '4.8');
});

test('sliders without an effect on rigid legs with ideal servos are disabled, with a note', async () => {
  const opened = await openStanding();
  for (const panel of ['#world', '#power']) await unfold(opened, panel);
  const note = opened.getByText('The legs are rigid, the servos ideal, and the feet stand evenly: friction and mass cancel out');
  assert.equal(await note.isVisible(), false, 'the torque of real servos is not for nothing');
  assert.ok(await opened.getByLabel('Pad friction').isEnabled());
  await opened.locator('#servos').selectOption('ideal');
  assert.ok(await note.isVisible());
  for (const label of ['Pad friction', 'Mass', 'Pull in the strut']) assert.ok(await opened.getByLabel(label).isDisabled(), label);
  assert.ok(await opened.getByLabel('Friction back : ahead').isEnabled());
  // With a foot that is too long, the weight and the feet's stiffness matter.
  await setSlider(opened, 'Front left foot too long', '1');
  assert.equal(await note.isVisible(), false);
  for (const label of ['Mass', 'Stiffness of a foot']) assert.ok(await opened.getByLabel(label).isEnabled(), label);
  assert.ok(await opened.getByLabel('Pad friction').isDisabled());
  await setSlider(opened, 'Front left foot too long', '0');
  assert.ok(await opened.getByLabel('Stiffness of a foot').isDisabled());
  await opened.getByLabel('Driven by').selectOption('strut');
  assert.equal(await note.isVisible(), false);
  for (const label of ['Pad friction', 'Mass', 'Pull in the strut']) assert.ok(await opened.getByLabel(label).isEnabled(), label);
});

test('predictions come with the page for an unchanged robot, and are computed for any other', async () => {
  const opened = await openStanding();
  const made = () => opened.workers().filter((worker) => worker.url().includes('robot-worker')).length;
  const notes = () => opened.locator('#gaits button[data-command] small').allInnerTexts();
  const robots = await opened.locator('#robot option').evaluateAll((options) => options.map(({ value }) => value));
  assert.ok(robots.includes('own-gaits') && robots.length > 4);
  for (const name of robots) {
    await opened.locator('#robot').selectOption(name);
    await opened.waitForFunction((name) => window.lizard.file === name, name);
    const predicted = await opened.evaluate(() => {
      const { robot, description } = window.lizard;
      return description.gaits.map((_, gait) => robot.predict(gait));
    });
    const shown = await notes();
    for (const [n, { forward, turn }] of predicted.entries()) {
      const ahead = forward === null ? ['may drift'] : Math.abs(forward) >= 0.5 ? [`${forward.toFixed(1)} mm`] : [];
      const turned = turn !== null && Math.abs(turn) >= 0.05 ? [`${turn.toFixed(1)}°`] : [];
      assert.equal(shown[n], [...ahead, ...turned].join(', '), `${name}, gait ${n}`);
    }
  }
  assert.equal(made(), 0, 'nothing was computed for it');

  await opened.locator('#robot').selectOption('robot');
  await opened.waitForFunction(() => window.lizard.file === 'robot');
  const [, walk] = await notes();
  await setSlider(opened, 'Friction back : ahead', '1.5');
  await opened.waitForFunction((walk) => document.querySelector('#gaits button[data-command="walk"] small').textContent !== walk, walk);
  assert.equal(made(), 1);
  await opened.locator('#floor-reset').click();
  await opened.waitForFunction((walk) => document.querySelector('#gaits button[data-command="walk"] small').textContent === walk, walk);
});

test('the browser reported no error or warning', () => assert.deepEqual(complaints, []));
