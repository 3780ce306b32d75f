// The robot as text: a mistake is reported with its line, and a file, a drop and a link load the same robot.
import assert from 'node:assert/strict';
import { mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, afterEach, before, test } from 'node:test';

import jsQR from 'jsqr';
import { parse } from 'smol-toml';

import { address, close, complaints, open, page as load, openStanding, closePages, unfold, until } from './browser.js';

const LARGE = new URL('../../robots/large.toml', import.meta.url).pathname;
let folder;

before(open);
before(async () => (folder = await mkdtemp(join(tmpdir(), 'robot-'))));
afterEach(closePages);
after(async () => {
  await rm(folder, { recursive: true, force: true });
  await close();
});

const box = (page) => page.locator('#robot-text');
const toml = (page) => page.evaluate(() => window.lizard.toml);
const waitForRobot = (page, text) => page.waitForFunction((text) => window.lizard?.toml === text, text);

async function openText(options) {
  const page = await openStanding(options);
  await unfold(page, '#robot-editor');
  return page;
}

test('a text with a mistake is refused with its line, and the previous robot stays', async () => {
  const page = await openText();
  const before = await toml(page);
  assert.equal(await box(page).inputValue(), before);
  const wrong = before.replace('l1 = 30.0', 'l1 = "long"');
  const line = wrong.split('\n').findIndex((text) => text.startsWith('l1 = ')) + 1;
  await box(page).fill(wrong);
  await page.locator('#robot-take').click();
  await page.getByRole('button', { name: `Go to line ${line}` }).waitFor();
  assert.match(await page.locator('#robot-refusal').innerText(), new RegExp(`^robot\\.toml:${line}: links\\.l1`));
  const marked = () => box(page).evaluate((box) => box.value.slice(box.selectionStart, box.selectionEnd));
  assert.match(await marked(), /^l1 = "long"/);
  assert.equal(await toml(page), before);
  assert.equal(await box(page).inputValue(), wrong, 'nothing that was typed is lost');
});

test('a refused gait is explained by its effect on the robot, then by its place', async () => {
  const page = await openText();
  const wrong = (await toml(page)).replace('amplitude = 20.0', 'amplitude = 40.0');
  const line = wrong.split('\n').findIndex((text) => text.startsWith('[gait.walk]')) + 1;
  await box(page).fill(wrong);
  await page.locator('#robot-take').click();
  await page.getByRole('button', { name: `Go to line ${line}` }).waitFor();
  const said = await page.locator('#robot-refusal').innerText();
  assert.match(said, /^in "walk" the (left|right) (front|hind) leg would lock: margin leg_[lr][fh] -?[0-9.]+ is below 0\.300 at phase [0-9.]+ /i);
  assert.ok(said.endsWith(`(robot.toml:${line}: gait.walk)`), said);
});

test('a valid text becomes the robot, and is undone and redone step by step', async () => {
  const page = await openText();
  const first = await toml(page);
  const second = first.replace('amplitude = 15.0', 'amplitude = 14.0');
  const third = second.replace('period = 1.25', 'period = 1.5');
  for (const text of [second, third]) {
    await box(page).fill(text);
    await box(page).press('Control+Enter');
    await waitForRobot(page, text);
  }
  assert.equal(await page.evaluate(() => window.lizard.description.gaits.find(({ name }) => name === 'trot').period), 1.5);
  for (const text of [second, first]) {
    await page.locator('#robot-undo').click();
    await waitForRobot(page, text);
  }
  assert.ok(await page.locator('#robot-undo').isDisabled());
  const redo = page.locator('#robot-redo');
  for (const text of [second, third]) {
    await redo.click();
    await waitForRobot(page, text);
  }
  assert.ok(await redo.isDisabled());
  // A change after an undo drops the undone steps.
  await page.locator('#robot-undo').click();
  await waitForRobot(page, second);
  assert.ok(await redo.isEnabled());
  await box(page).fill(first);
  await box(page).press('Control+Enter');
  await waitForRobot(page, first);
  assert.ok(await redo.isDisabled());
  await page.locator('#robot-undo').click();
  await waitForRobot(page, second);
});

test('a file is opened, or dropped anywhere on the page', async () => {
  const page = await openText();
  const large = await readFile(LARGE, 'utf8');
  await page.locator('#robot-open').setInputFiles(LARGE);
  await waitForRobot(page, large);
  const other = large.replace(/^/, '# dropped\n');
  await page.evaluate((text) => {
    const dropped = new DataTransfer();
    dropped.items.add(new File([text], 'robot.toml'));
    document.body.dispatchEvent(new DragEvent('drop', { dataTransfer: dropped, bubbles: true, cancelable: true }));
  }, other);
  await waitForRobot(page, other);
  const picture = join(folder, 'x.toml');
  await writeFile(picture, Buffer.from([0x89, 0x50, 0x4e, 0x47, 0, 0, 0]));
  await page.locator('#robot-open').setInputFiles(picture);
  await page.getByText('x.toml is not a robot.toml.').waitFor();
  assert.equal(await toml(page), other);
});

/** Waits until the page has the robot of a text; a link may have dropped its comments. */
async function waitForText(page, wanted) {
  await page.waitForFunction((name) => window.lizard?.toml.includes(`name = "${name}"`), parse(wanted).name);
  assert.deepEqual(parse(await toml(page)), parse(wanted));
}

/** Reads the shown QR code as a camera would, and returns its text. */
async function scanCode(page) {
  const { data, side } = await page.locator('#robot-drawn svg').evaluate(async (svg) => {
    const side = 3 * svg.viewBox.baseVal.width;
    const drawn = svg.cloneNode(true);
    for (const name of ['width', 'height']) drawn.setAttribute(name, side);
    const picture = new Image();
    picture.src = `data:image/svg+xml,${encodeURIComponent(new XMLSerializer().serializeToString(drawn))}`;
    await picture.decode();
    const canvas = new OffscreenCanvas(side, side).getContext('2d');
    canvas.fillStyle = 'white';
    canvas.fillRect(0, 0, side, side);
    canvas.drawImage(picture, 0, 0);
    return { data: Array.from(canvas.getImageData(0, 0, side, side).data), side };
  });
  return jsQR.default(Uint8ClampedArray.from(data), side, side)?.data;
}

test('a link is a robot, also over a reload, and a phone reads it from the screen', async () => {
  const page = await openText();
  await page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
  const large = await readFile(LARGE, 'utf8');
  await page.locator('#robot-open').setInputFiles(LARGE);
  await waitForRobot(page, large);
  await page.getByRole('button', { name: 'Copy a link' }).click();
  await page.getByText('The link is copied').waitFor();
  const link = await page.evaluate(() => navigator.clipboard.readText());
  assert.ok(link.startsWith(`${address()}#robot=`) && link.length < 1900, `${link.length} letters`);
  const other = await load();
  assert.notEqual(await toml(other), large);
  await other.goto(link);
  await waitForText(other, large);
  await other.reload();
  await waitForText(other, large);
  // Half of a link is refused with a message.
  await other.goto(link.slice(0, -200));
  await other.getByText('The robot in the address is incomplete').waitFor();

  const code = page.getByRole('button', { name: 'QR code' });
  await code.click();
  await page.getByRole('img', { name: 'QR code' }).waitFor();
  assert.equal(await scanCode(page), link);
  await page.getByText('a phone reaches the page only where a web server serves it').waitFor();
  await code.click();
  assert.equal(await page.locator('#robot-drawn svg').count(), 0);
  // Another robot removes the code.
  await code.click();
  await page.getByRole('img', { name: 'QR code' }).waitFor();
  await box(page).fill(large.replace('name = "large"', 'name = "other"'));
  await page.locator('#robot-take').click();
  await page.waitForFunction(() => document.querySelector('#robot-drawn svg') === null);
});

test('a link keeps each # outside of comments', async () => {
  const page = await openText();
  await page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
  const text = `# one\n${(await toml(page)).replace('name = "paper"', 'name = "paper" # "two"')}\n  # three # "four"\n`;
  await box(page).fill(text);
  await page.locator('#robot-take').click();
  await waitForRobot(page, text);
  await page.getByRole('button', { name: 'Copy a link' }).click();
  await page.getByText('The link is copied').waitFor();
  const other = await load();
  await other.goto(await page.evaluate(() => navigator.clipboard.readText()));
  await waitForText(other, text);
  assert.doesNotMatch(await toml(other), /one|three/);
});

test('after every change the address is that of the shown robot', async () => {
  const page = await openText();
  const first = await toml(page);
  assert.equal(page.url(), `${address()}#room=build`, 'the robot of the page itself needs none');
  const changed = first.replace('amplitude = 15.0', 'amplitude = 14.0');
  await box(page).fill(changed);
  await page.locator('#robot-take').click();
  await page.waitForFunction(() => location.hash.startsWith('#room=build&robot='));
  // A new browser gets the robot from the address alone.
  const other = await load();
  await other.evaluate(() => localStorage.clear());
  await other.goto(await page.evaluate(() => location.href));
  await waitForRobot(other, changed);
  await page.locator('#robot-undo').click();
  await page.waitForFunction(() => location.hash === '#room=build');
  await page.locator('#robot').selectOption('large');
  await page.waitForFunction(() => location.hash === '#room=build&file=large');
  await other.goto(await page.evaluate(() => location.href));
  await other.waitForFunction(() => window.lizard.file === 'large');
  // The address is overwritten before the page handles the change.
  await other.evaluate(() => {
    location.hash = '#file=nothing';
    history.replaceState(null, '', '#file=large');
  });
  await other.locator('#trouble', { hasText: 'This page has no nothing.toml' }).waitFor();
});

test('a hostile file runs no script', async () => {
  const page = await openText();
  const hostile = `${await toml(page)}\n[gait."<img src=x onerror=alert(1)>"]\nperiod = 1.0\nwaveform = "still"\n`;
  await box(page).fill(hostile);
  await page.locator('#robot-take').click();
  await page.waitForFunction((text) => window.lizard.toml === text || !document.querySelector('#robot-refusal').hidden, hostile);
  assert.equal(await page.locator('img').count(), 0);
});

test('opening a link or another robot puts the user\'s own robot aside, and a button restores it', async () => {
  const page = await openText();
  const own = (await toml(page)).replace('amplitude = 15.0', 'amplitude = 14.0');
  await box(page).fill(own);
  await page.locator('#robot-take').click();
  await waitForRobot(page, own);
  const back = page.locator('#trouble').getByRole('button', { name: 'Back to my own robot' });
  // A link from somebody else, opened in another tab.
  await page.goto('about:blank');
  await page.goto(`${address()}#file=large`);
  await page.waitForFunction(() => window.lizard?.file === 'large');
  await back.click();
  await waitForRobot(page, own);
  // The same in this tab, after the address was updated.
  await page.waitForFunction(() => location.hash.startsWith('#robot='));
  await page.evaluate(() => (location.hash = '#file=large'));
  await page.waitForFunction(() => window.lizard.file === 'large');
  await back.waitFor();
  await page.reload();
  await page.waitForFunction(() => window.lizard?.file === 'large');
  await page.locator('#robot').selectOption({ label: 'paper' });
  await waitForRobot(page, own);
  await page.locator('#robot').selectOption('large');
  await page.waitForFunction(() => window.lizard.file === 'large');
  await back.click();
  await waitForRobot(page, own);
  assert.equal(await page.locator('#robot optgroup[label="your own"]').count(), 0, 'none is left');
});

test('the user\'s own robots are listed by their names, and each is restored unchanged', async () => {
  const page = await openText();
  const first = await toml(page);
  const own = (name) => first.replace('name = "paper"', `name = "${name}"`);
  const list = page.locator('#robot');
  const names = () => page.locator('#robot optgroup[label="your own"] option').allInnerTexts();
  for (const name of ['anna', 'bert']) {
    await list.selectOption('large');
    await page.waitForFunction(() => window.lizard.file === 'large');
    await list.selectOption('robot');
    await page.waitForFunction(() => window.lizard.file === 'robot');
    await box(page).fill(own(name));
    await page.locator('#robot-take').click();
    await waitForRobot(page, own(name));
  }
  assert.deepEqual(await names(), ['anna']);
  await list.selectOption({ label: 'anna' });
  await waitForRobot(page, own('anna'));
  // The address is updated a little later, and takes priority over the stored robot.
  await until(page, async (wanted) => {
    const part = new URLSearchParams(location.hash.slice(1)).get('robot') ?? '';
    const bytes = Uint8Array.from(atob(part.replaceAll('-', '+').replaceAll('_', '/')), (letter) => letter.charCodeAt(0));
    const text = new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate-raw'))).text();
    return (await text.catch(() => '')) === wanted;
  }, own('anna'));
  assert.deepEqual(await names(), ['bert'], 'what was shown is put aside');
  await page.reload();
  await waitForRobot(page, own('anna'));
  assert.deepEqual(await names(), ['bert']);
  await list.selectOption({ label: 'bert' });
  await waitForRobot(page, own('bert'));
  assert.deepEqual(await names(), ['anna']);
});

test('the browser reported no error or warning', () => assert.deepEqual(complaints, []));
