// The page's image equals the compiler's, byte for byte, and its pulses equal those of `lizard sim` on libsimavr, width
// for width, even for a robot that was edited in the page.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';

import { loadHex } from '../../tools/judge/src/hex.js';
import { TIMEOUT_MS, advance, openPage, openUnfolded, sendLine, useBrowser, testPage } from './browser.js';
import { makeFolder } from './temporary-folder.js';

useBrowser();

const ROOT = new URL('../../', import.meta.url).pathname;
const ROBOT_FILE = join(ROOT, 'robot.toml');
/** The compiler's image of the robot in `ROBOT_FILE`. */
const HEX_FILE = join(ROOT, 'target/avr-atmega328p/release/lizard.hex');

/** Script of a run: ms since power-on, and the line sent then. */
const SCRIPT = [
  [1503, 'walk'],
  [4007, 'left'],
  [6511, 'arc right'],
  [9013, 'look'],
  [13005, 'trim 2 1.5'],
  [13509, 'pose 120 60 318.59 221.41'],
  [15011, 'rest'],
];
const END_MS = 16_011;
/** Turn of a servo for one CPU cycle of pulse width, deg. */
const CYCLE_DEG = 1 / 160;

/** Returns the servo angles of each frame, which `lizard sim` computes from the pulses at the pins. */
async function runLizardSim(toml) {
  const folder = await makeFolder();
  try {
    const scriptPath = join(folder, 'script');
    writeFileSync(scriptPath, SCRIPT.map(([ms, line]) => `${ms} ${line}\n`).join(''));
    const robotPath = join(folder, 'robot.toml');
    writeFileSync(robotPath, toml);
    const fileArguments = ['--robot', robotPath, '--svg', join(folder, 'x.svg')];
    const output = execFileSync(process.env.LIZARD, ['sim', '--json', '--script', scriptPath, ...fileArguments], {
      cwd: ROOT,
      maxBuffer: 1 << 26,
      timeout: TIMEOUT_MS,
    });
    return JSON.parse(output).frames.flatMap(({ angles }) => (angles ? [angles] : []));
  } catch (error) {
    if (error.code === 'ETIMEDOUT') throw new Error(`timed out after ${TIMEOUT_MS / 1000} s while waiting for this: the end of lizard sim`);
    throw error;
  }
}

testPage('the image of robot.toml equals that of the compiler, byte for byte', openPage, async (page) => {
  const flash = new Uint8Array(32 * 1024).fill(0xff);
  loadHex(readFileSync(HEX_FILE, 'utf8'), flash);
  const image = await page.evaluate(() => Array.from(window.lizard.robot.image));
  assert.ok(image.length > 0x6e00 + 1000, `${image.length} bytes`);
  assert.deepEqual(image, Array.from(flash.subarray(0, image.length)));
  assert.ok(flash.subarray(image.length).every((byte) => byte === 0xff));
});

const TOML = readFileSync(ROBOT_FILE, 'utf8');
/** A robot with a shorter walk and an additional gait. */
const EDITED_TOML = `${TOML.replace('amplitude = 20.0', 'amplitude = 17.0')}
[gait.limp]
period = 1.4
waveform = "wave"
duty = 0.7
amplitude = 12.0
start = { LF = 0.0, RF = 0.5, RH = 0.2, LH = 0.7 }
`;

for (const [robotName, toml] of [['robot.toml', TOML], ['a robot that was edited in the page', EDITED_TOML]]) test(`the servo angles of ${robotName} equal those of lizard sim`, async () => {
  // With an init script, even an empty one, the page's clock is paused: only this test advances the simulation.
  const page = await openPage({}, () => {});
  if (toml !== TOML) assert.equal(await page.evaluate((toml) => window.lizard.robot.change(toml), toml), null);
  const { frames, rises } = await page.evaluate(
    ([script, end]) => {
      const { lizard } = window;
      const { board } = lizard.board.link;
      const { pin } = lizard.robot.description.servos[3];
      const frames = [];
      const rises = [];
      // Ideal servos have the angles of their pulses.
      lizard.robot.wasm.setServoModel('ideal');
      // Records the angles that the page itself computes.
      const originalFollowPulses = lizard.robot.wasm.followPulses.bind(lizard.robot.wasm);
      lizard.robot.wasm.followPulses = (widths) => {
        const frame = originalFollowPulses(widths);
        if (widths.every((width) => width > 0)) frames.push(frame.scene.angles);
        return frame;
      };
      const originalOnPulse = board.onPulse;
      board.onPulse = (pulsePin, rise, width) => {
        if (pulsePin === pin) rises.push(rise);
        originalOnPulse(pulsePin, rise, width);
      };
      // The page may have advanced the simulation while it loaded.
      let currentMs = board.cycle / 16_000;
      for (const [ms, line] of [...script, [end, '']]) {
        lizard.advance(ms - currentMs);
        currentMs = ms;
        if (line !== '') void lizard.board.link.write(new TextEncoder().encode(`${line}\n`));
      }
      return { frames, rises };
    },
    [SCRIPT, END_MS],
  );
  const expectedFrames = await runLizardSim(toml);
  assert.ok(frames.length > 600, `${frames.length} frames`);
  assert.equal(frames.length, expectedFrames.length);
  frames.forEach((angles, frame) =>
    angles.forEach((angle, servo) => {
      const deviation = Math.abs(angle - expectedFrames[frame][servo]);
      assert.ok(deviation < CYCLE_DEG / 100, `frame ${frame}, A${servo + 1}: ${angle} and ${expectedFrames[frame][servo]}`);
    }),
  );
  const periods = new Set(rises.slice(1).map((rise, n) => (rise - rises[n]) % 320_000));
  assert.deepEqual([...periods], [0], 'a frame is exactly 20 ms');
});

testPage('the table shows the widths of the pulses, and "none" while the robot rests', () => openUnfolded('#pulses'), async (page) => {
  const waitForWidths = (pattern) =>
    page.waitForFunction((pattern) => {
      const cells = [...document.querySelectorAll('#widths td:nth-child(3)')];
      return cells.length === 4 && cells.every(({ textContent }) => new RegExp(pattern).test(textContent));
    }, pattern);
  await waitForWidths('^1500\\.00$');
  await sendLine(page, 'rest', 'ok rest');
  await advance(page, 1000);
  await waitForWidths('^none$');
});
