// Tests of the page's room Measure. The browser's camera is a rendered video, so the true motion is known.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { afterEach, before, test } from 'node:test';

import { connect } from './board.js';
import { address, openBlankPage, closeBrowser, browserErrors, hidePage, openBrowserWithCamera, openPage, closePages, download, testPage, readGait, waitForGait } from './browser.js';
import { installFakeSerial } from './fake-serial.js';
import { makeFolder } from './temporary-folder.js';

const { LIZARD } = process.env;
const ROBOT = new URL('../../robots/paper.toml', import.meta.url).pathname;
const folder = await makeFolder();
/** Largest allowed differences between a mean and the true value, mm and deg, as in the tests of crates/video. */
const TOLERANCES = { forward: 0.3, left: 0.3, turn: 0.5 };

/** Renders a video into a folder; `args` are its width, its number of cycles and the ids of hidden tags. */
function renderVideo(name, ...args) {
  const videoFolder = join(folder, name);
  execFileSync(join(dirname(LIZARD), 'studio'), [videoFolder, ...args.map(String)]);
  return videoFolder;
}

let walkFolder;
let trueValues;
before(() => {
  walkFolder = renderVideo('walk', 640, 14);
  trueValues = JSON.parse(readFileSync(join(walkFolder, 'truth.json'), 'utf8'));
});
afterEach(() => closePages().finally(closeBrowser));

/** Opens the room with the paper's robot, and waits until it stands. */
async function openRoom() {
  const page = await openPage({}, undefined, `${address()}#room=measure&file=paper`);
  await page.waitForFunction(() => window.lizard?.board.gait === 'stand' && window.lizard.board.mayAsk);
  await page.locator('#measure-height').pressSequentially('95');
  return page;
}

/** Opens the room in a browser with a video as its camera, or without a camera if there is no video. */
async function openRoomWithVideo(videoFolder) {
  await openBrowserWithCamera(videoFolder && join(videoFolder, 'video.y4m'));
  return openRoom();
}

const waitForMessage = (page, id, words) => page.locator(`#measure-${id}`, { hasText: words }).waitFor();

/** Presses a button, and waits for words in an element. */
async function pressAndWait(page, name, id, words) {
  await page.getByRole('button', { name }).click();
  await waitForMessage(page, id, words);
}

const switchCameraOn = (page, words = 'All five tags are visible.') => pressAndWait(page, 'Camera', 'visible-tags', words);

/** Types a number into an input of the room. */
async function typeNumber(page, id, number) {
  const box = page.locator(`#measure-${id}`);
  await box.press('Control+a');
  await box.pressSequentially(String(number));
}

/** Selects gaits, switches the camera on, and lets the page drive after the first `videoMs` of the video. */
async function startDriving(page, gaits, cycleCount, videoMs = 0) {
  await page.locator('#measure-driver').selectOption('page');
  for (const box of await page.locator('#measure-gaits input').all()) await box.setChecked(gaits.includes(await box.getAttribute('name')));
  await typeNumber(page, 'cycles', cycleCount);
  await typeNumber(page, 'pause', 0.5);
  await switchCameraOn(page);
  await page.waitForTimeout(videoMs);
  await page.locator('#measure-start').click();
}

/** Downloads the results in a format and returns the content of the file. */
const downloadResults = async (page, format) => (await download(page, page.locator(`#measured-${format}`))).bytes;

/** Measures the same frames with `lizard measure` and returns the report. */
const measureWithCommand = () => JSON.parse(execFileSync(LIZARD, ['measure', join(walkFolder, 'frames'), '--robot', ROBOT, '--gait', 'walk', '--height', '95', '--json'], { encoding: 'utf8' })).gaits[0];

function assertNearTrueValues(report) {
  for (const [quantity, tolerance] of Object.entries(TOLERANCES)) {
    assert.ok(Math.abs(report[quantity].mean - trueValues[quantity]) < tolerance, `${quantity}: ${report[quantity].mean}, not ${trueValues[quantity]}`);
    assert.ok(report[quantity].error > 0 && report[quantity].error < tolerance, JSON.stringify(report[quantity]));
  }
}

testPage('the page drives the simulated robot in front of a camera, and its measurement of the gait matches lizard measure', () => openRoomWithVideo(walkFolder), async (page) => {
  await startDriving(page, ['walk'], 5);
  await waitForGait(page, 'walk');
  await page.locator('#measure-results').waitFor();
  const { gaits: [report] } = JSON.parse(await downloadResults(page, 'json'));
  assertNearTrueValues(report);
  const expected = measureWithCommand();
  assertNearTrueValues(expected);
  for (const quantity of Object.keys(TOLERANCES)) {
    // The sine functions of the two programs may differ in the last bits.
    assert.ok(Math.abs(report[quantity].predicted - expected[quantity].predicted) < 1e-9, quantity);
    // The browser samples the frames at different times, and may miss some cycles.
    assert.ok(Math.abs(report[quantity].mean - expected[quantity].mean) < 2 * (report[quantity].error + expected[quantity].error), quantity);
  }
  assert.ok(report.cycles >= 2 && report.cycles <= 5, `${report.cycles}`);
  assert.deepEqual(report.mujoco, expected.mujoco);
  assert.ok(report.range.least < report.forward.predicted && report.forward.predicted < report.range.most, JSON.stringify(report.range));
  assert.equal(report.range.least_by, expected.range.least_by);
  const cells = await page.locator('#measured tr', { hasText: 'ahead, mm' }).first().locator('td').allTextContents();
  assert.equal(cells.at(-1), `+${expected.mujoco[0].toFixed(2)}`);
  assert.match(String(await downloadResults(page, 'csv')), /^gait,speed,cycles,forward_mean.*\nwalk,100,\d/);
  assert.match(String(await downloadResults(page, 'svg')), /^<svg .*walk, 100 %, .*ahead, mm.*<\/svg>$/s);
  assert.deepEqual([...(await downloadResults(page, 'png')).subarray(1, 4)], [...Buffer.from('PNG')]);
});

test('the gait in a recorded video file is recognised by its path, and rejected as another gait', async () => {
  await openBrowserWithCamera(join(walkFolder, 'video.y4m'));
  const recorderPage = await openBlankPage();
  await recorderPage.goto(address());
  const bytes = await recorderPage.evaluate(async () => {
    const stream = await navigator.mediaDevices.getUserMedia({ video: { width: 640, height: 360 } });
    const chunks = [];
    const recorder = new MediaRecorder(stream, { mimeType: 'video/webm;codecs=vp8', videoBitsPerSecond: 5e6 });
    recorder.ondataavailable = ({ data }) => chunks.push(data);
    recorder.start();
    await new Promise((resolve) => setTimeout(resolve, 9000));
    await new Promise((resolve) => Object.assign(recorder, { onstop: resolve }).stop());
    for (const track of stream.getTracks()) track.stop();
    const reader = new FileReader();
    const loading = new Promise((resolve) => (reader.onload = resolve));
    reader.readAsDataURL(new Blob(chunks));
    await loading;
    return reader.result.split(',')[1];
  });
  writeFileSync(join(folder, 'video.webm'), Buffer.from(bytes, 'base64'));
  const page = await openRoom();
  await page.locator('#measure-file').setInputFiles(join(folder, 'video.webm'));
  await page.locator('#measure-results').waitFor();
  const { gaits: [report] } = JSON.parse(await downloadResults(page, 'json'));
  assertNearTrueValues(report);
  assert.equal(report.gait, 'walk');
  await page.locator('#measure-gait').selectOption('left');
  await pressAndWait(page, 'Measure again', 'message', /^left: the path does not match this gait.*; it resembles walk\./);
  assert.ok(!(await page.locator('#measure-results').isVisible()));
  // A file that is not a video.
  await page.locator('#measure-file').setInputFiles({ name: 'words.mp4', mimeType: 'video/mp4', buffer: Buffer.from('words') });
  await waitForMessage(page, 'message', /^words\.mp4 is not a video that this browser can play/);
});

testPage('a video recorded until Done, while another program drives the robot, is measured', () => openRoomWithVideo(walkFolder), async (page) => {
  await switchCameraOn(page);
  await page.getByRole('button', { name: 'Record' }).click();
  await page.waitForTimeout(6000);
  await page.getByRole('button', { name: 'Done' }).click();
  await page.locator('#measure-results').waitFor();
  assertNearTrueValues(JSON.parse(await downloadResults(page, 'json')).gaits[0]);
});

testPage('a hidden tag is named while the camera is on, and no result is computed', () => openRoomWithVideo(renderVideo('hidden', 640, 1, 2)), async (page) => {
  await switchCameraOn(page, 'Not visible: the left tag of strip 2.');
  await page.getByRole('button', { name: 'Record' }).click();
  await page.waitForTimeout(1000);
  await pressAndWait(page, 'Done', 'message', /floor tag 2 is not completely visible/);
  assert.ok(!(await page.locator('#measure-results').isVisible()));
});

testPage('a video without tags is reported', () => openRoomWithVideo(renderVideo('none', 640, 1, 0, 1, 2, 3, 4)), async (page) => {
  await switchCameraOn(page, 'No tag of the sheet is visible');
});

testPage('the page offers to open a video if there is no camera or the browser may not use it', () => openRoomWithVideo(null), async (page) => {
  await pressAndWait(page, 'Camera', 'message', /This machine has no camera|not allowed to use the camera/);
  await page.evaluate(() => (navigator.mediaDevices.getUserMedia = () => Promise.reject(new DOMException('no', 'NotAllowedError'))));
  await pressAndWait(page, 'Camera', 'message', /not allowed to use the camera.*record a video and open it here/);
});

testPage('Stop, or leaving the room, ends the measurement and stops the robot, and leaving also switches the camera off', () => openRoomWithVideo(walkFolder), async (page) => {
  await startDriving(page, ['walk', 'left'], 20);
  await waitForGait(page, 'walk');
  await page.keyboard.press('Escape');
  await waitForMessage(page, 'message', 'it was stopped');
  await waitForGait(page, 'stop');
  // A robot that was stopped stays stopped.
  await page.waitForTimeout(2000);
  assert.equal(await readGait(page), 'stop');
  await page.getByRole('button', { name: 'Drive and measure' }).click();
  await waitForGait(page, 'walk');
  await page.locator('nav a', { hasText: 'Drive' }).click();
  await waitForGait(page, 'stop');
  assert.equal(await page.evaluate(() => document.querySelector('#measure-view video').srcObject), null);
});

testPage('a stop or a hidden page before the first walk ends the measurement', () => openRoomWithVideo(walkFolder), async (page) => {
  await page.locator('#measure-driver').selectOption('page');
  await typeNumber(page, 'pause', 30);
  await switchCameraOn(page);
  // The robot is stopped while the previous video is still being cleared.
  await page.evaluate(() => {
    document.querySelector('#measure-start').click();
    void window.lizard.board.ask('stop');
  });
  await waitForMessage(page, 'message', 'it was stopped');
  await page.getByRole('button', { name: 'Drive and measure' }).click();
  await hidePage(page);
  await waitForMessage(page, 'message', 'the page was hidden');
});

testPage('a restart of the robot before a walk ends the measurement, because the robot has forgotten its pace', () => openRoomWithVideo(walkFolder), async (page) => {
  await page.locator('#measure-driver').selectOption('page');
  await typeNumber(page, 'pause', 5);
  await switchCameraOn(page);
  // At the start of the video the page would first drive the robot back.
  await page.waitForTimeout(2500);
  await page.getByRole('button', { name: 'Drive and measure' }).click();
  await page.waitForFunction(() => document.querySelector('#measure-start').textContent === 'Stop');
  await page.evaluate(() => window.lizard.board.link.board.reset('power'));
  await waitForMessage(page, 'message', 'the robot has restarted');
});

testPage('nothing is recorded if the camera is switched off before the recording begins', () => openRoomWithVideo(walkFolder), async (page) => {
  await switchCameraOn(page);
  // The previous video is still being cleared.
  await page.evaluate(() => {
    document.querySelector('#measure-start').click();
    document.querySelector('#measure-camera').click();
  });
  await page.waitForTimeout(1000);
  assert.equal(await page.locator('#measure-start').innerText(), 'Record');
  assert.ok(await page.locator('#measure-driver').isEnabled());
});

testPage('leaving the room before the camera is open leaves it off', () => openRoomWithVideo(walkFolder), async (page) => {
  let release;
  const gate = new Promise((resolve) => (release = resolve));
  await page.route('**/files/measure.wasm', (route) => gate.then(() => route.continue()));
  await page.getByRole('button', { name: 'Camera' }).click();
  await page.locator('nav a', { hasText: 'Drive' }).click();
  const loading = page.waitForResponse('**/files/measure.wasm');
  release();
  await loading;
  await page.waitForTimeout(1000);
  assert.equal(await page.evaluate(() => document.querySelector('#measure-view video').srcObject), null);
});

testPage('after the link is cut, the board is no longer driven, the room reports the cut, and the recorded cycles are measured', () => openRoomWithVideo(walkFolder), async (page) => {
  await page.evaluate(installFakeSerial);
  // For a robot with a Bluetooth module, the page does not open the dialog of the first connection.
  await connect(page, { flashedRobot: 'paper', boardKeepsRunning: true, bluetoothService: '00001101-0000-1000-8000-00805f9b34fb' });
  await page.waitForFunction(() => window.lizard.board.isReal && window.lizard.board.gait === 'stand' && window.lizard.board.mayAsk);
  // At the start of the video the robot is near the end of the sheet, and the page would first drive it back.
  await startDriving(page, ['walk', 'left'], 8, 2500);
  await waitForMessage(page, 'message', '1 of 2: walk');
  await page.waitForTimeout(6000);
  await page.evaluate(() => window.unplug());
  await waitForMessage(page, 'message', 'Ended before all gaits were walked: the link to the robot was cut');
  assertNearTrueValues(JSON.parse(await downloadResults(page, 'json')).gaits[0]);
  assert.ok(!/left/.test(await page.evaluate(() => window.receivedText)), 'no further gait was sent to the board');
  assert.equal(await readGait(page), 'stand', 'no gait was sent to the simulated board that replaces it');
});

testPage('after another robot was chosen, the recorded cycles are compared with the robot that walked', () => openRoomWithVideo(walkFolder), async (page) => {
  await startDriving(page, ['walk'], 8, 2500);
  await waitForGait(page, 'walk');
  await page.waitForTimeout(6000);
  await page.locator('#robot').selectOption('large');
  await waitForMessage(page, 'message', 'Ended before all gaits were walked: another robot was chosen');
  const { gaits: [report] } = JSON.parse(await downloadResults(page, 'json'));
  assertNearTrueValues(report);
  const expected = measureWithCommand();
  for (const quantity of Object.keys(TOLERANCES)) assert.ok(Math.abs(report[quantity].predicted - expected[quantity].predicted) < 1e-9, quantity);
  assert.match(String(await downloadResults(page, 'svg')), /paper/);
});

testPage('the downloaded sheet equals the output of lizard measure sheet for both paper sizes', () => openRoomWithVideo(null), async (page) => {
  for (const [name, paper] of [['A4', 'a4'], ['letter', 'letter']]) {
    await page.locator('#measure-paper').selectOption(name);
    const { bytes } = await download(page, page.getByRole('button', { name: 'Download the sheet' }));
    const file = join(folder, `${paper}.pdf`);
    execFileSync(LIZARD, ['measure', 'sheet', '--paper', paper, '-o', file]);
    assert.deepEqual(bytes, readFileSync(file));
  }
});

testPage('a worker that cannot be loaded is reported, and the next press of the button loads it', () => openRoomWithVideo(null), async (page) => {
  const previousCount = browserErrors.length;
  await page.route(/assets\/worker-/, (route) => route.abort());
  await pressAndWait(page, 'Download the sheet', 'message', /^the worker could not be loaded/);
  await page.unroute(/assets\/worker-/);
  await download(page, page.getByRole('button', { name: 'Download the sheet' }));
  // The browser also reports the file that was not loaded, as expected.
  for (const browserError of browserErrors.splice(previousCount)) assert.match(browserError, /Failed to load|worker/i);
});
