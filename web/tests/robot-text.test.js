// The robot as text: a mistake is reported with its line number; opening a file, dropping a file and following a link
// load the same robot.
import assert from 'node:assert/strict';
import { readFile, writeFile } from 'node:fs/promises';
import { join } from 'node:path';
import { deflateRawSync } from 'node:zlib';

import jsQR from 'jsqr';
import { parse } from 'smol-toml';

import { address, openPage, openUnfolded, waitUntil, useBrowser, chooseRobot, testPage, readToml } from './browser.js';
import { makeFolder } from './temporary-folder.js';

const LARGE_PATH = new URL('../../robots/large.toml', import.meta.url).pathname;

useBrowser();

const findTextBox = (page) => page.locator('#robot-text');
const waitForRobot = (page, text) => page.waitForFunction((text) => window.lizard?.robot.toml === text, text);

/** Returns the names of the user's own robots in the list. */
const readOwnNames = (page) => page.locator('#robot optgroup[label="your own"] option').allInnerTexts();

/** Types a robot.toml and makes it the page's robot. */
async function applyText(page, toml) {
  await findTextBox(page).fill(toml);
  await page.locator('#robot-take').click();
}

const openTextEditor = () => openUnfolded('#robot-editor');

testPage('a text with a mistake is refused with the line number, and the previous robot stays', openTextEditor, async (page) => {
  const firstToml = await readToml(page);
  assert.equal(await findTextBox(page).inputValue(), firstToml);
  const invalidToml = firstToml.replace('l1 = 30.0', 'l1 = "long"');
  const line = invalidToml.split('\n').findIndex((text) => text.startsWith('l1 = ')) + 1;
  await applyText(page, invalidToml);
  await page.getByRole('button', { name: `Go to line ${line}` }).waitFor();
  assert.match(await page.locator('#robot-refusal').innerText(), new RegExp(`^robot\\.toml:${line}: links\\.l1`));
  const readSelection = () => findTextBox(page).evaluate((box) => box.value.slice(box.selectionStart, box.selectionEnd));
  assert.match(await readSelection(), /^l1 = "long"/);
  assert.equal(await readToml(page), firstToml);
  assert.equal(await findTextBox(page).inputValue(), invalidToml, 'the typed text stays');
});

testPage('the message about a refused gait names its effect on the robot, then the line number', openTextEditor, async (page) => {
  const invalidToml = (await readToml(page)).replace('amplitude = 20.0', 'amplitude = 40.0');
  const line = invalidToml.split('\n').findIndex((text) => text.startsWith('[gait.walk]')) + 1;
  await applyText(page, invalidToml);
  await page.getByRole('button', { name: `Go to line ${line}` }).waitFor();
  const refusalText = await page.locator('#robot-refusal').innerText();
  assert.match(refusalText, /^in "walk" the (left|right) (front|hind) leg would lock: margin leg_[lr][fh] -?[0-9.]+ is below 0\.300 at phase [0-9.]+ /i);
  assert.ok(refusalText.endsWith(`(robot.toml:${line}: gait.walk)`), refusalText);
});

testPage('a valid text replaces the robot, and undo and redo work step by step', openTextEditor, async (page) => {
  const firstToml = await readToml(page);
  const secondToml = firstToml.replace('amplitude = 15.0', 'amplitude = 14.0');
  const thirdToml = secondToml.replace('period = 1.25', 'period = 1.5');
  for (const text of [secondToml, thirdToml]) {
    await findTextBox(page).fill(text);
    await findTextBox(page).press('Control+Enter');
    await waitForRobot(page, text);
  }
  assert.equal(await page.evaluate(() => window.lizard.robot.description.gaits.find(({ name }) => name === 'trot').period), 1.5);
  const undo = page.locator('#robot-undo');
  const redo = page.locator('#robot-redo');
  const pressAndWait = async (button, ...texts) => {
    for (const text of texts) {
      await button.click();
      await waitForRobot(page, text);
    }
  };
  await pressAndWait(undo, secondToml, firstToml);
  assert.ok(await undo.isDisabled());
  await pressAndWait(redo, secondToml, thirdToml);
  assert.ok(await redo.isDisabled());
  // A change after an undo drops the undone steps.
  await pressAndWait(undo, secondToml);
  assert.ok(await redo.isEnabled());
  await findTextBox(page).fill(firstToml);
  await findTextBox(page).press('Control+Enter');
  await waitForRobot(page, firstToml);
  assert.ok(await redo.isDisabled());
  await pressAndWait(undo, secondToml);
});

testPage('a file can be opened, or dropped anywhere on the page', openTextEditor, async (page) => {
  const largeToml = await readFile(LARGE_PATH, 'utf8');
  await page.locator('#robot-open').setInputFiles(LARGE_PATH);
  await waitForRobot(page, largeToml);
  const droppedToml = largeToml.replace(/^/, '# dropped\n');
  await page.evaluate((text) => {
    const transfer = new DataTransfer();
    transfer.items.add(new File([text], 'robot.toml'));
    document.body.dispatchEvent(new DragEvent('drop', { dataTransfer: transfer, bubbles: true, cancelable: true }));
  }, droppedToml);
  await waitForRobot(page, droppedToml);
  const picturePath = join(await makeFolder(), 'x.toml');
  await writeFile(picturePath, Buffer.from([0x89, 0x50, 0x4e, 0x47, 0, 0, 0]));
  await page.locator('#robot-open').setInputFiles(picturePath);
  await page.getByText('x.toml is not a robot.toml.').waitFor();
  assert.equal(await readToml(page), droppedToml);
});

/** Copies a link to the page's robot, and returns it. */
async function copyLink(page) {
  await page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
  await page.getByRole('button', { name: 'Copy a link' }).click();
  await page.getByText('Link copied').waitFor();
  return page.evaluate(() => navigator.clipboard.readText());
}

/** Waits until the page has the robot that a text describes. Comments may differ, because a link omits them. */
async function waitForRobotIgnoringComments(page, expectedToml) {
  await page.waitForFunction((name) => window.lizard?.robot.toml.includes(`name = "${name}"`), parse(expectedToml).name);
  assert.deepEqual(parse(await readToml(page)), parse(expectedToml));
}

/** Reads the shown QR code as a camera would, and returns its text. */
async function scanQrCode(page) {
  const { data, side } = await page.locator('#robot-drawn svg').evaluate(async (svg) => {
    const side = 3 * svg.viewBox.baseVal.width;
    const copy = svg.cloneNode(true);
    for (const name of ['width', 'height']) copy.setAttribute(name, side);
    const picture = new Image();
    picture.src = `data:image/svg+xml,${encodeURIComponent(new XMLSerializer().serializeToString(copy))}`;
    await picture.decode();
    const context = new OffscreenCanvas(side, side).getContext('2d');
    context.fillStyle = 'white';
    context.fillRect(0, 0, side, side);
    context.drawImage(picture, 0, 0);
    return { data: Array.from(context.getImageData(0, 0, side, side).data), side };
  });
  return jsQR.default(Uint8ClampedArray.from(data), side, side)?.data;
}

testPage('a link contains the robot, survives a reload, and equals the text of the QR code', openTextEditor, async (page) => {
  const largeToml = await readFile(LARGE_PATH, 'utf8');
  await page.locator('#robot-open').setInputFiles(LARGE_PATH);
  await waitForRobot(page, largeToml);
  const link = await copyLink(page);
  assert.ok(link.startsWith(`${address()}#robot=`) && link.length < 1900, `${link.length} characters`);
  const otherPage = await openPage();
  assert.notEqual(await readToml(otherPage), largeToml);
  await otherPage.goto(link);
  await waitForRobotIgnoringComments(otherPage, largeToml);
  await otherPage.reload();
  await waitForRobotIgnoringComments(otherPage, largeToml);
  // An incomplete link is refused with a message.
  await otherPage.goto(link.slice(0, -200));
  await otherPage.getByText('The robot in the address is incomplete').waitFor();
  const tooLongRobot = deflateRawSync(Buffer.alloc(200_001, '#')).toString('base64url');
  await otherPage.goto(`${address()}#robot=${tooLongRobot}`);
  await otherPage.getByText('A robot.toml of more than 200 kB does not fit into a link.').waitFor();

  const qrButton = page.getByRole('button', { name: 'QR code' });
  await qrButton.click();
  await page.getByRole('img', { name: 'QR code' }).waitFor();
  assert.equal(await scanQrCode(page), link);
  await page.getByText('a phone needs the page’s address on a web server').waitFor();
  await qrButton.click();
  assert.equal(await page.locator('#robot-drawn svg').count(), 0);
  // Another robot removes the code.
  await qrButton.click();
  await page.getByRole('img', { name: 'QR code' }).waitFor();
  await applyText(page, largeToml.replace('name = "large"', 'name = "other"'));
  await page.waitForFunction(() => document.querySelector('#robot-drawn svg') === null);
});

testPage('a QR code that is still being made is not shown for the next robot', openTextEditor, async (page) => {
  let release;
  const gate = new Promise((resolve) => (release = resolve));
  await page.route('**/assets/qr-code-*', (route) => gate.then(() => route.continue()));
  await page.getByRole('button', { name: 'QR code' }).click();
  const changedToml = (await readToml(page)).replace('amplitude = 15.0', 'amplitude = 14.0');
  await applyText(page, changedToml);
  await waitForRobot(page, changedToml);
  const loading = page.waitForResponse('**/assets/qr-code-*');
  release();
  await loading;
  await page.waitForTimeout(1000);
  assert.equal(await page.locator('#robot-drawn svg').count(), 0);
});

testPage('a link contains everything except comments', openTextEditor, async (page) => {
  const toml = `# one\n${(await readToml(page)).replace('name = "paper"', 'name = "paper" # "two"')}\n  # three # "four"\n`;
  await applyText(page, toml);
  await waitForRobot(page, toml);
  const link = await copyLink(page);
  const otherPage = await openPage();
  await otherPage.goto(link);
  await waitForRobotIgnoringComments(otherPage, toml);
  assert.doesNotMatch(await readToml(otherPage), /one|three/);
});

testPage('after every change the address contains the shown robot', openTextEditor, async (page) => {
  const firstToml = await readToml(page);
  assert.equal(page.url(), `${address()}#room=build`, 'the page\'s own robot is not in the address');
  const changedToml = firstToml.replace('amplitude = 15.0', 'amplitude = 14.0');
  await applyText(page, changedToml);
  await page.waitForFunction(() => location.hash.startsWith('#room=build&robot='));
  // A new browser gets the robot from the address alone.
  const otherPage = await openPage();
  await otherPage.evaluate(() => localStorage.clear());
  await otherPage.goto(await page.evaluate(() => location.href));
  await waitForRobot(otherPage, changedToml);
  // A robot that is too long for an address is not in it.
  const longToml = `${firstToml}# ${'-'.repeat(200_000)}\n`;
  await applyText(page, longToml);
  await waitForRobot(page, longToml);
  await page.waitForFunction(() => location.hash === '#room=build');
  await page.locator('#robot-undo').click();
  await page.waitForFunction(() => location.hash.startsWith('#room=build&robot='));
  await page.locator('#robot-undo').click();
  await page.waitForFunction(() => location.hash === '#room=build');
  await page.locator('#robot').selectOption('large');
  await page.waitForFunction(() => location.hash === '#room=build&file=large');
  await otherPage.goto(await page.evaluate(() => location.href));
  await otherPage.waitForFunction(() => window.lizard.robot.file === 'large');
  // The address is overwritten before the page handles the change.
  await otherPage.evaluate(() => {
    location.hash = '#file=nothing';
    history.replaceState(null, '', '#file=large');
  });
  await otherPage.locator('#problems', { hasText: 'The page has no robot nothing.toml' }).waitFor();
});

testPage('a hostile file runs no script', openTextEditor, async (page) => {
  const dialogs = [];
  page.on('dialog', (dialog) => dialog.dismiss().then(() => dialogs.push(dialog.message())));
  const hostileGait = '[gait."<img src=x onerror=alert(1)>"]\nperiod = 1.0\nwaveform = "still"\n';
  const hostileToml = `${await readToml(page)}\n${hostileGait}`;
  await applyText(page, hostileToml);
  await page.waitForFunction((text) => window.lizard.robot.toml === text || !document.querySelector('#robot-refusal').hidden, hostileToml);
  assert.equal(await page.locator('img').count(), 0);
  assert.deepEqual(dialogs, []);
});

testPage('a button restores the user\'s own robot after a link or another robot was opened', openTextEditor, async (page) => {
  const ownToml = (await readToml(page)).replace('amplitude = 15.0', 'amplitude = 14.0');
  await applyText(page, ownToml);
  await waitForRobot(page, ownToml);
  const backButton = page.locator('#problems').getByRole('button', { name: 'Back to my own robot' });
  // A link from somebody else, opened in another tab.
  await page.goto('about:blank');
  await page.goto(`${address()}#file=large`);
  await page.waitForFunction(() => window.lizard?.robot.file === 'large');
  await backButton.click();
  await waitForRobot(page, ownToml);
  // The same in this tab, after the address was updated.
  await page.waitForFunction(() => location.hash.startsWith('#robot='));
  await page.evaluate(() => (location.hash = '#file=large'));
  await page.waitForFunction(() => window.lizard.robot.file === 'large');
  await backButton.waitFor();
  await page.reload();
  await page.waitForFunction(() => window.lizard?.robot.file === 'large');
  await page.locator('#robot').selectOption({ label: 'paper' });
  await waitForRobot(page, ownToml);
  await chooseRobot(page, 'large');
  await backButton.click();
  await waitForRobot(page, ownToml);
  assert.equal(await page.locator('#robot optgroup[label="your own"]').count(), 0, 'no stored robot is left');
});

testPage('a changed robot can be restored if another page has stored its own robot, and if nothing can be stored any more', openTextEditor, async (page) => {
  const ownToml = (await readToml(page)).replace('amplitude = 15.0', 'amplitude = 14.0');
  await applyText(page, ownToml);
  await waitForRobot(page, ownToml);
  await page.evaluate(() => {
    const key = `lizard ${location.pathname}`;
    const stored = JSON.parse(localStorage.getItem(key));
    localStorage.setItem(key, JSON.stringify({ ...stored, toml: stored.toml.replace('amplitude = 14.0', 'amplitude = 13.0') }));
    Storage.prototype.setItem = () => {
      throw new DOMException('The storage is full.', 'QuotaExceededError');
    };
  });
  await chooseRobot(page, 'large');
  await page.locator('#problems').getByRole('button', { name: 'Back to my own robot' }).click();
  await waitForRobot(page, ownToml);
});

testPage('the list has the names of the user\'s own robots, and restores each unchanged', openTextEditor, async (page) => {
  const firstToml = await readToml(page);
  const makeToml = (name) => firstToml.replace('name = "paper"', `name = "${name}"`);
  const list = page.locator('#robot');
  for (const name of ['anna', 'bert']) {
    await chooseRobot(page, 'large');
    await chooseRobot(page, 'robot');
    await applyText(page, makeToml(name));
    await waitForRobot(page, makeToml(name));
  }
  assert.deepEqual(await readOwnNames(page), ['anna']);
  await list.selectOption({ label: 'anna' });
  await waitForRobot(page, makeToml('anna'));
  // The address takes priority over the stored robot, so the test waits until the address is updated.
  await waitUntil(page, async (expectedText) => {
    const encoded = new URLSearchParams(location.hash.slice(1)).get('robot') ?? '';
    const bytes = Uint8Array.from(atob(encoded.replaceAll('-', '+').replaceAll('_', '/')), (letter) => letter.charCodeAt(0));
    const text = new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate-raw'))).text();
    return (await text.catch(() => '')) === expectedText;
  }, makeToml('anna'));
  assert.deepEqual(await readOwnNames(page), ['bert'], 'the previous robot is stored');
  await page.reload();
  await waitForRobot(page, makeToml('anna'));
  assert.deepEqual(await readOwnNames(page), ['bert']);
  await list.selectOption({ label: 'bert' });
  await waitForRobot(page, makeToml('bert'));
  assert.deepEqual(await readOwnNames(page), ['anna']);
});

testPage('a robot put aside stays stored when another page stores one, or when another robot is chosen before its file is loaded', openTextEditor, async (page) => {
  const ownToml = (await readToml(page)).replace('amplitude = 15.0', 'amplitude = 14.0');
  await applyText(page, ownToml);
  await waitForRobot(page, ownToml);
  await chooseRobot(page, 'large');
  // Another page puts its robot aside.
  await page.evaluate(() => {
    const key = `lizard ${location.pathname} aside`;
    const [own] = JSON.parse(localStorage.getItem(key));
    const other = { ...own, toml: own.toml.replace('amplitude = 14.0', 'amplitude = 13.0') };
    localStorage.setItem(key, JSON.stringify([other, own]));
  });
  await page.locator('#problems').getByRole('button', { name: 'Back to my own robot' }).click();
  await waitForRobot(page, ownToml);
  await chooseRobot(page, 'large');
  assert.deepEqual(await readOwnNames(page), ['paper', 'paper'], 'the robot of the other page is still stored');
  let release;
  const gate = new Promise((resolve) => (release = resolve));
  await page.route('**/files/unequal.toml', (route) => gate.then(() => route.continue()));
  await page.evaluate(() => {
    const list = document.querySelector('#robot');
    list.querySelector('optgroup option').selected = true;
    list.dispatchEvent(new Event('change'));
    list.value = 'unequal';
    list.dispatchEvent(new Event('change'));
  });
  // Meanwhile the file of the first chosen robot is loaded.
  await page.waitForTimeout(500);
  release();
  await page.waitForFunction(() => window.lizard.robot.file === 'unequal');
  assert.deepEqual(await readOwnNames(page), ['paper', 'paper']);
});

testPage('another robot that is chosen while the file of an own robot is loading stays', openTextEditor, async (page) => {
  const ownToml = (await readToml(page)).replace('amplitude = 15.0', 'amplitude = 14.0');
  await applyText(page, ownToml);
  await waitForRobot(page, ownToml);
  await chooseRobot(page, 'large');
  let release;
  const gate = new Promise((resolve) => (release = resolve));
  await page.route('**/files/robot.toml', (route) => gate.then(() => route.continue()));
  await page.evaluate(() => {
    const list = document.querySelector('#robot');
    list.querySelector('optgroup option').selected = true;
    list.dispatchEvent(new Event('change'));
  });
  await chooseRobot(page, 'grain');
  const grainToml = await readToml(page);
  const loading = page.waitForResponse('**/files/robot.toml');
  release();
  await loading;
  await page.waitForTimeout(1000);
  assert.equal(await readToml(page), grainToml);
  assert.equal(await page.evaluate(() => window.lizard.robot.file), 'grain');
});
