// The phone as a remote control.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { after, afterEach, before, test } from 'node:test';

import { DIST, address, advance, close, complaints, open, openStanding, closePages } from './browser.js';

before(open);
afterEach(closePages);
after(close);

const PHONE = { viewport: { width: 844, height: 390 }, hasTouch: true, isMobile: true };
/** A thumb's reach from its corner, and the size of a target that it hits without looking, CSS pixels. */
const REACH = 220;
const TARGET_SIZE = 120;

async function openRemote() {
  const page = await openStanding(PHONE);
  await page.evaluate(() => {
    window.locks = 0;
    window.buzzes = 0;
    const request = async () => ((window.locks += 1), { release: async () => (window.locks -= 1) });
    Object.defineProperty(navigator, 'wakeLock', { value: { request } });
    navigator.vibrate = () => (window.buzzes += 1);
  });
  await page.getByRole('button', { name: 'Remote' }).click();
  await page.waitForFunction(() => window.locks === 1);
  return page;
}

test('a phone can install the page, with its icon and without a network', async () => {
  const manifest = JSON.parse(await readFile(`${DIST}manifest.webmanifest`, 'utf8'));
  const worker = await readFile(`${DIST}service-worker.js`, 'utf8');
  for (const { src, type } of manifest.icons) {
    const bytes = await readFile(`${DIST}${src}`);
    assert.equal(type, bytes[0] === 0x89 ? 'image/png' : 'image/svg+xml');
    assert.ok(worker.includes(`"${src}"`), `${src} is kept`);
  }
  const page = await openStanding(PHONE);
  const devTools = await page.context().newCDPSession(page);
  const { url, errors, data } = await devTools.send('Page.getAppManifest');
  assert.equal(url, `${address()}manifest.webmanifest`);
  assert.deepEqual([errors, JSON.parse(data).display], [[], 'standalone']);
  const { installabilityErrors } = await devTools.send('Page.getInstallabilityErrors');
  assert.deepEqual(installabilityErrors.filter(({ errorId }) => errorId !== 'in-incognito'), []);
});

test('stick and stop are under the thumbs, and the robot fills the screen', async () => {
  const page = await openRemote();
  const { width, height } = PHONE.viewport;
  const [stick, stop, floor] = await Promise.all(['#stick', 'button.stop', 'section.floor'].map((name) => page.locator(name).boundingBox()));
  for (const box of [stick, stop]) assert.ok(Math.min(box.width, box.height) >= TARGET_SIZE, JSON.stringify(box));
  assert.ok(stick.x + stick.width <= REACH && height - stick.y <= REACH, JSON.stringify(stick));
  assert.ok(width - stop.x <= REACH && height - stop.y <= REACH, JSON.stringify(stop));
  assert.deepEqual([floor.x, floor.y], [0, 0]);
  assert.ok(floor.width >= width && floor.height >= height);
  for (const hiddenSelector of ['header', '.console', '#gaits', '#reset']) assert.equal(await page.locator(hiddenSelector).first().isVisible(), false, hiddenSelector);
});

test('the remote drives and stops, and keeps the screen on while it is open', async () => {
  const page = await openRemote();
  await page.waitForFunction(() => document.querySelector('#gaits [data-command="walk"] small').textContent !== '');
  const { x, y, width } = await page.locator('#stick').boundingBox();
  await page.mouse.move(x + width / 2, y + width / 2);
  await page.mouse.down();
  await page.mouse.move(x + width / 2, y + 4);
  await page.waitForFunction(() => window.lizard.gait === 'walk');
  await page.locator('button.stop').dispatchEvent('click');
  await page.waitForFunction(() => window.lizard.gait === 'stop');
  await page.mouse.up();
  await page.getByRole('button', { name: 'Remote' }).click();
  await page.waitForFunction(() => window.locks === 0);
  assert.ok(await page.locator('header').isVisible());
});

test('a robot that stops by itself buzzes', async () => {
  const page = await openRemote();
  await page.evaluate(() => window.lizard.ask('walk'));
  await page.evaluate(() => window.lizard.setSupply(3));
  await advance(page, 2000);
  assert.ok((await page.evaluate(() => window.buzzes)) > 0);
});

test('the browser reported no error or warning', () => assert.deepEqual(complaints, []));
