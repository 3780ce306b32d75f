// The page in Debian's Firefox. Boards at a port are tested in Chromium only: on a busy machine a simulated board is
// slower than real time, and only in Chromium can a test stop the page's clock.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { DIST, advance, openFirefox, measureOverflow, openStanding, reload, assertStops, useBrowser, serveInTest, stopServer, openStored, testPage, readDisplacements, readPlace } from './browser.js';

useBrowser(openFirefox);

const click = (page, selector) => page.evaluate((selector) => document.querySelector(selector).click(), selector);
const readText = (page, selector) => page.evaluate((selector) => document.querySelector(selector).textContent, selector);

testPage('the image walks as predicted, and Esc stops it', openStanding, async (page) => {
  assert.match(await readText(page, '#where'), /^on a simulated UNO, robot [a-z-]+ [0-9a-f]{8}$/);
  await click(page, '#gaits button[data-command="walk"]');
  await advance(page, 5500);
  const { predicted, measured } = await readDisplacements(page, 'walk');
  assert.ok(Math.abs(measured.forward / predicted.forward - 1) < 0.03, `distance per cycle: ${measured.forward} mm, predicted ${predicted.forward} mm`);
  await assertStops(page);
});

testPage('the button Connect a board is disabled if this Firefox has no Web Serial, and only then', openStanding, async (page) => {
  const { hasSerial, note, isConnectDisabled } = await page.evaluate(() => ({
    hasSerial: typeof navigator.serial?.requestPort === 'function',
    note: document.querySelector('#no-serial').hidden ? '' : document.querySelector('#no-serial').textContent,
    isConnectDisabled: document.querySelector('#connect').disabled,
  }));
  assert.equal(isConnectDisabled, !hasSerial);
  assert.equal(note.startsWith('This browser cannot connect to a board on USB'), !hasSerial);
});

testPage('every step of the first connection can be tried with the simulated board', openStanding, async (page) => {
  await click(page, '#setup-open');
  const stepCount = await page.evaluate(() => document.querySelectorAll('#setup-steps button').length);
  assert.equal(stepCount, 9);
  for (let n = 0; n < stepCount; n++) {
    await page.evaluate((n) => document.querySelectorAll('#setup-steps button')[n].click(), n);
    await advance(page, 2000);
    assert.match(await readText(page, '#setup-step'), new RegExp(`^${n + 1} of 9: `));
    // On a busy machine, the module with the steps loads late.
    await page.waitForFunction(() => document.querySelector('#setup-content').textContent.length > 40);
    assert.doesNotMatch(await readText(page, '#setup-content'), /No robot/);
  }
  // The third step, Horns, moves every servo to its middle position.
  await page.evaluate(() => document.querySelectorAll('#setup-steps button')[2].click());
  await page.evaluate(() => [...document.querySelectorAll('#setup-content button')].find(({ textContent }) => /middle/.test(textContent)).click());
  for (let n = 0; n < 40 && (await readText(page, '#setup-message')) === ''; n++) await advance(page, 250);
  assert.match(await readText(page, '#setup-message'), /^Every servo now holds its middle position/);
});

test('the page fits windows 500 and 3840 px wide without scrolling sideways', async () => {
  for (const [width, height] of [[500, 800], [3840, 2160]]) {
    assert.equal(await measureOverflow(await openStanding({ viewport: { width, height } })), 0);
  }
});

test('the page works without a server once it has been opened', async () => {
  const server = await serveInTest(DIST);
  const page = await openStored(server);
  await stopServer(server);
  await reload(page);
  await advance(page, 2500);
  await click(page, '#gaits button[data-command="walk"]');
  await advance(page, 3000);
  assert.ok((await readPlace(page)).y > 20);
});
