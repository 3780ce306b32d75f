// A run is recorded, replayed and saved, and two robots walk on one floor.
import assert from 'node:assert/strict';

import { advance, openUnfolded, readGait, sendLine, useBrowser, chooseRobot, download, testPage, waitForGait } from './browser.js';

useBrowser();

const openRecordPanel = () => openUnfolded('#keep');

/** CPU cycles of the simulated board in a frame of 20 ms. */
const CYCLES_PER_FRAME = 320_000;
/** Returns the number of frames since the board was switched on. */
const countFrames = (page) => page.evaluate((cycles) => window.lizard.board.link.board.cycle / cycles, CYCLES_PER_FRAME);
/** Waits until the page itself has simulated `count` more frames. */
const waitForFrames = async (page, count) =>
  page.waitForFunction((end) => window.lizard.board.link.board.cycle > end, CYCLES_PER_FRAME * ((await countFrames(page)) + count));
const findButton = (page, name) => page.locator('#keep').getByRole('button', { name, exact: true });

const saveFile = (page, buttonName) => download(page, findButton(page, buttonName));

/** Reads the rows of a CSV table as objects with the columns' names as keys. */
function parseCsv(csv) {
  const [header, ...lines] = csv.trim().split('\n').map((line) => line.split(','));
  return lines.map((fields) => Object.fromEntries(header.map((name, n) => [name, fields[n]])));
}

testPage('the table of a run has the pose, the position and the pulses of every frame', openRecordPanel, async (page) => {
  await sendLine(page, 'walk', 'ok walk');
  const startFrameCount = await countFrames(page);
  await findButton(page, 'Record').click();
  await advance(page, 3000);
  const angles = await page.evaluate(() => window.lizard.robot.last.scene.angles);
  await advance(page, 100);
  await findButton(page, 'Stop recording').click();
  const passedFrameCount = (await countFrames(page)) - startFrameCount;
  const { name, bytes } = await saveFile(page, 'Table (CSV)');
  assert.equal(name, 'run.csv');
  const rows = parseCsv(bytes.toString());
  assert.ok(rows.length >= 150 && rows.length <= passedFrameCount + 1, `${rows.length} of ${passedFrameCount} frames`);
  rows.forEach((row, n) => assert.equal(Number(row.time_s), Number((n * 0.02).toFixed(2))));
  assert.ok(rows.every(({ doing }) => doing === '"walk"'));
  // The angles that the pulses command according to robot.toml: 10 us per degree around 1500 us. The servo lags behind
  // its pulses.
  const computePulseAngle = (row) => 138.590378 + (Number(row.pulse_a1_us) - 1500) / 10;
  const deviations = rows.map((row) => Math.abs(computePulseAngle(row) - Number(row.a1_deg)));
  assert.ok(Math.max(...deviations) < 8, `deviation of A1 from the angle of its pulse: ${Math.max(...deviations)} deg`);
  assert.ok(Number(rows[rows.length - 1].ahead_mm) > Number(rows[0].ahead_mm) + 10, 'the robot moved ahead');
  const poseIndex = rows.findIndex((row) => Math.abs(Number(row.a2_deg) - angles[1]) < 0.001);
  assert.ok(poseIndex > 0, 'the table has the pose during the run');
});

testPage('a run can be replayed from any moment while the robot continues', openRecordPanel, async (page) => {
  await sendLine(page, 'walk', 'ok walk');
  await findButton(page, 'Record').click();
  await advance(page, 2000);
  await findButton(page, 'Stop recording').click();
  await page.getByText(/s recorded\.$/).waitFor();
  await advance(page, 4000);
  await page.getByLabel('Moment').fill('1');
  await page.getByText(/^1\.0 of [0-9.]+ s$/).waitFor();
  assert.equal(await findButton(page, 'Back to the robot').getAttribute('aria-pressed'), 'true');
  await findButton(page, 'Back to the robot').click();
  await findButton(page, 'Replay').click();
  await page.waitForFunction(() => Number(document.querySelector('#moment').value) > 1.1);
  // The recording does not belong to another robot.
  await chooseRobot(page, 'large');
  assert.ok(await findButton(page, 'Replay').isDisabled());
});

testPage('the floor is saved as a PNG or SVG picture, or as a video', openRecordPanel, async (page) => {
  await sendLine(page, 'walk', 'ok walk');
  const png = await saveFile(page, 'Picture (PNG)');
  assert.equal(png.bytes.subarray(1, 4).toString(), 'PNG');
  assert.ok(png.bytes.length > 5000, `${png.bytes.length} bytes`);
  const svg = await saveFile(page, 'Picture (SVG)');
  const shapeCount = await page.evaluate((text) => {
    const parsed = new DOMParser().parseFromString(text, 'image/svg+xml');
    return parsed.querySelector('parsererror') ? 0 : parsed.querySelectorAll('path').length;
  }, svg.bytes.toString());
  assert.ok(shapeCount > 50, `${shapeCount} shapes`);
  assert.match(svg.bytes.toString(), />100 mm<|>50 mm</, 'the scale of the floor');
  await findButton(page, 'Video').click();
  await waitForFrames(page, 50);
  const video = await saveFile(page, 'Stop the video');
  assert.match(video.name, /^run\.(webm|mp4)$/);
  assert.ok(video.bytes.length > 2000, `${video.bytes.length} bytes`);
});

testPage('two robots walk side by side, each as far as alone', openRecordPanel, async (page) => {
  await page.getByLabel('This robot').selectOption('back');
  await page.getByLabel('Beside it').selectOption('walk');
  await findButton(page, 'Start both').click();
  await waitForGait(page, 'back');
  for (let n = 0; n < 20; n++) await advance(page, 500);
  const message = page.locator('#keep-message');
  await page.getByText(/^back: -[0-9.]+ mm.*Beside it, walk: [0-9.]+ mm/).waitFor();
  const [, backMm, walkMm] = /^back: -([0-9.]+) mm.*walk: ([0-9.]+) mm/.exec(await message.innerText()).map(Number);
  // The gait `back` is `walk` in reverse, so it covers the same distance.
  assert.ok(walkMm > 40 && Math.abs(walkMm - backMm) < 0.25 * walkMm, `walk: ${walkMm} mm ahead, back: ${backMm} mm back`);
  await page.locator('.stop').click();
  // Texts are updated ten times per second of page time.
  const readMessage = async () => {
    await waitForFrames(page, 20);
    return message.innerText();
  };
  await advance(page, 3000);
  const stoppedText = await readMessage();
  await advance(page, 1000);
  assert.equal(await readMessage(), stoppedText, 'both have stopped');
  await findButton(page, 'Remove the second robot').click();
  assert.equal(await message.innerText(), '');
});

testPage('if the robot is changed while two robots are being started, no second robot appears', openRecordPanel, async (page) => {
  await page.evaluate(async () => {
    document.querySelector('#both').click();
    await window.lizard.robot.change(window.lizard.robot.toml.replace('amplitude = 15.0', 'amplitude = 14.0'));
  });
  await advance(page, 500);
  assert.ok(await findButton(page, 'Remove the second robot').isDisabled());
  assert.equal(await page.locator('#keep-message').innerText(), '');
});

testPage('if Stop is pressed while two robots are being started, the robot stands and no second robot appears', openRecordPanel, async (page) => {
  await page.evaluate(() => {
    document.querySelector('#both').click();
    document.querySelector('.stop').click();
  });
  await advance(page, 1000);
  assert.equal(await readGait(page), 'stop');
  assert.ok(await findButton(page, 'Remove the second robot').isDisabled());
});
