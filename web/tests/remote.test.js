// The phone as a remote control.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { test } from 'node:test';

import { DIST, LANDSCAPE, address, advance, openStanding, startDrag, useBrowser, testPage, waitForGait } from './browser.js';

useBrowser();

/** A thumb's reach from its corner of the screen, CSS pixels. */
const REACH_PX = 220;
/** Smallest size of a button that a thumb hits without looking, CSS pixels. */
const TARGET_PX = 120;

async function openRemote() {
  const page = await openStanding(LANDSCAPE);
  await page.evaluate(() => {
    window.wakeLockCount = 0;
    window.vibrationCount = 0;
    const request = async () => ((window.wakeLockCount += 1), { release: async () => (window.wakeLockCount -= 1) });
    Object.defineProperty(navigator, 'wakeLock', { value: { request } });
    navigator.vibrate = () => (window.vibrationCount += 1);
  });
  await page.getByRole('button', { name: 'Remote' }).click();
  await page.waitForFunction(() => window.wakeLockCount === 1);
  return page;
}

test('a phone can install the page, with its icons, for use without a network', async () => {
  const manifest = JSON.parse(await readFile(`${DIST}manifest.webmanifest`, 'utf8'));
  const worker = await readFile(`${DIST}service-worker.js`, 'utf8');
  for (const { src, type } of manifest.icons) {
    const bytes = await readFile(`${DIST}${src}`);
    assert.equal(type, bytes[0] === 0x89 ? 'image/png' : 'image/svg+xml');
    assert.ok(worker.includes(`"${src}"`), `${src} is stored`);
  }
  const page = await openStanding(LANDSCAPE);
  const devTools = await page.context().newCDPSession(page);
  const { url, errors, data } = await devTools.send('Page.getAppManifest');
  assert.equal(url, `${address()}manifest.webmanifest`);
  assert.deepEqual([errors, JSON.parse(data).display], [[], 'standalone']);
  const { installabilityErrors } = await devTools.send('Page.getInstallabilityErrors');
  assert.deepEqual(installabilityErrors.filter(({ errorId }) => errorId !== 'in-incognito'), []);
});

testPage('stick and stop are in reach of the thumbs, and the robot fills the screen', openRemote, async (page) => {
  const { width, height } = LANDSCAPE.viewport;
  const [stick, stop, floor] = await Promise.all(['#stick', 'button.stop', 'section.floor'].map((name) => page.locator(name).boundingBox()));
  for (const box of [stick, stop]) assert.ok(Math.min(box.width, box.height) >= TARGET_PX, JSON.stringify(box));
  assert.ok(stick.x + stick.width <= REACH_PX && height - stick.y <= REACH_PX, JSON.stringify(stick));
  assert.ok(width - stop.x <= REACH_PX && height - stop.y <= REACH_PX, JSON.stringify(stop));
  assert.deepEqual([floor.x, floor.y], [0, 0]);
  assert.ok(floor.width >= width && floor.height >= height);
  for (const hiddenSelector of ['header', '#console', '#gaits', '#reset']) assert.equal(await page.locator(hiddenSelector).first().isVisible(), false, hiddenSelector);
});

testPage('the remote drives and stops, and keeps the screen on while it is open', openRemote, async (page) => {
  await page.waitForFunction(() => document.querySelector('#gaits [data-command="walk"] small').textContent !== '');
  const { x, y, width } = await page.locator('#stick').boundingBox();
  await startDrag(page, [x + width / 2, y + width / 2], [x + width / 2, y + 4]);
  await waitForGait(page, 'walk');
  await page.locator('button.stop').dispatchEvent('click');
  await waitForGait(page, 'stop');
  await page.mouse.up();
  await page.getByRole('button', { name: 'Remote' }).click();
  await page.waitForFunction(() => window.wakeLockCount === 0);
  assert.ok(await page.locator('header').isVisible());
});

testPage('the robot stops when the phone leaves full screen, because the browser does not report the Esc key there', openRemote, async (page) => {
  await page.evaluate(() => window.lizard.board.ask('walk'));
  await waitForGait(page, 'walk');
  // A browser without a screen may not enter full screen.
  await page.evaluate(() => (document.fullscreenElement ? document.exitFullscreen() : document.dispatchEvent(new Event('fullscreenchange'))));
  await waitForGait(page, 'stop');
  assert.ok(await page.locator('header').isVisible());
});

testPage('the phone vibrates when the robot stops by itself', openRemote, async (page) => {
  await page.evaluate(() => window.lizard.board.ask('walk'));
  await page.evaluate(() => window.lizard.robot.setSupply(3));
  await advance(page, 2000);
  assert.ok((await page.evaluate(() => window.vibrationCount)) > 0);
});
