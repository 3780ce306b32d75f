// What a person changes is in the file that the page gives, and outlasts a reload.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { after, afterEach, before, test } from 'node:test';

import { advance, close, complaints, open, standing, tidy, type } from './browser.js';

before(open);
afterEach(tidy);
after(close);

/** Sets a slider as a person does, by its value. */
async function slide(opened, label, value) {
  await opened.getByLabel(label).fill(value);
}

async function downloaded(opened, button = 'Download robot.toml') {
  const coming = opened.waitForEvent('download');
  await opened.getByRole('button', { name: button }).click();
  const file = await (await coming).path();
  return readFile(file, 'utf8');
}

/** The number of a key in a table of a robot.toml, by its lines alone. */
function number(toml, table, key) {
  const lines = toml.split('\n');
  const begin = lines.findIndex((line) => line.startsWith(`[${table}]`));
  const length = lines.slice(begin + 1).findIndex((line) => line.startsWith('['));
  const within = lines.slice(begin + 1, length < 0 ? undefined : begin + 1 + length);
  const line = within.find((line) => line.startsWith(`${key} =`));
  return line && parseFloat(line.split('=')[1]);
}

async function changed() {
  const opened = await standing();
  await slide(opened, 'Leg springs', '7');
  await slide(opened, 'Preload', '12');
  await slide(opened, 'Pad friction', '0.5');
  await slide(opened, 'Friction back : ahead', '1.5');
  await slide(opened, 'Mass', '412');
  await opened.getByText('Lengths', { exact: true }).click();
  const crank = opened.locator('input[name="leg.crank"]');
  await crank.fill('40');
  await crank.press('Enter');
  await opened.waitForFunction(() => window.lizard.link.name === 'core in the page');
  return opened;
}

test('the downloaded robot.toml has lengths, springs, floor and mass', async () => {
  const opened = await changed();
  const toml = await downloaded(opened);
  const found = [
    ['leg', 'crank'],
    ['leg', 'spring'],
    ['leg', 'preload'],
    ['ground', 'friction'],
    ['ground', 'friction_back_over_forward'],
    ['body', 'mass'],
  ].map(([table, key]) => number(toml, table, key));
  assert.deepEqual(found, [40, 5, 12, 0.5, 1.5, 412]);
});

test('a file of which nothing was changed is given as it is', async () => {
  const opened = await standing();
  await opened.getByText('Lengths', { exact: true }).click();
  const own = await readFile(new URL('../dist/files/robot.toml', import.meta.url), 'utf8');
  assert.equal(await downloaded(opened), own);
});

test('a reload keeps what was changed', async () => {
  const opened = await changed();
  await opened.locator('#servos').selectOption('ideal');
  await opened.reload();
  await opened.waitForFunction(() => window.lizard);
  const { floor, link, lengths, servos } = await opened.evaluate(() => {
    const { floor, link, description, servos } = window.lizard;
    return { floor, link: link.name, lengths: description.lengths, servos };
  });
  assert.deepEqual(floor, { friction: 0.5, ratio: 1.5, mass: 412, stiffness: 5, preload: 12 });
  assert.equal(lengths.find(({ key }) => key === 'leg.crank').value, 40);
  assert.equal(link, 'core in the page');
  assert.equal(servos, 'ideal');
  assert.equal(await opened.locator('#servos').inputValue(), 'ideal');
  assert.equal(await opened.locator('#mass').inputValue(), '412');
});

test('changes of a file that is another now are not taken, and that is said', async () => {
  const opened = await changed();
  await opened.evaluate(() => {
    const key = Object.keys(localStorage)[0];
    const kept = JSON.parse(localStorage.getItem(key));
    localStorage.setItem(key, JSON.stringify({ ...kept, original: `${kept.original}\n` }));
  });
  await opened.reload();
  await opened.waitForFunction(() => window.lizard);
  await opened.locator('#trouble', { hasText: 'robot.toml is not the file of last time' }).waitFor();
  assert.equal(await opened.evaluate(() => window.lizard.link.name), 'simulated UNO');
  const lost = await downloaded(opened, 'Download what was changed');
  assert.deepEqual([number(lost, 'leg', 'crank'), number(lost, 'body', 'mass')], [40, 412], 'they are not lost');
});

test('the pace slider has what the robot has, after a typed line and after a reset', async () => {
  const opened = await standing();
  await advance(opened, 3000);
  await type(opened, 'speed 35', 'ok speed 35');
  const slider = opened.getByLabel('Pace');
  assert.equal(await slider.inputValue(), '35');
  await opened.getByRole('button', { name: 'reset' }).click();
  await advance(opened, 7000);
  await opened.waitForFunction(async () => {
    window.lizard.advance(20);
    return document.querySelector('#speed').value === '100';
  });
  assert.equal(await opened.locator('#speed-out').innerText(), '100 %');
});

test('what moves nothing with rigid legs says so and cannot be set', async () => {
  const opened = await standing();
  const note = opened.getByText('The legs are rigid: friction and mass cancel out');
  assert.ok(await note.isVisible());
  for (const label of ['Pad friction', 'Mass', 'Preload']) assert.ok(await opened.getByLabel(label).isDisabled(), label);
  assert.ok(await opened.getByLabel('Friction back : ahead').isEnabled());
  await slide(opened, 'Leg springs', '7');
  assert.equal(await note.isVisible(), false);
  for (const label of ['Pad friction', 'Mass', 'Preload']) assert.ok(await opened.getByLabel(label).isEnabled(), label);
});

test('nothing was complained of', () => assert.deepEqual(complaints, []));
