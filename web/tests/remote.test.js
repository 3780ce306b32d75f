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
const THUMB = 120;

async function openRemote() {
  const opened = await openStanding(PHONE);
  await opened.evaluate(() => {
    window.locks = 0;
    window.buzzes = 0;
    const request = async () => ((window.locks += 1), { release: async () => (window.locks -= 1) });
    Object.defineProperty(navigator, 'wakeLock', { value: { request } });
    navigator.vibrate = () => (window.buzzes += 1);
  });
  await opened.getByRole('button', { name: 'Remote' }).click();
  await opened.waitForFunction(() => window.locks === 1);
  return opened;
}

test('a phone can install the page, with its icon and without a network', async () => {
  const manifest = JSON.parse(await readFile(`${DIST}manifest.webmanifest`, 'utf8'));
  const worker = await readFile(`${DIST}service-worker.js`, 'utf8');
  for (const { src, type } of manifest.icons) {
    const bytes = await readFile(`${DIST}${src}`);
    assert.equal(type, bytes[0] === 0x89 ? 'image/png' : 'image/svg+xml');
    assert.ok(worker.includes(`"${src}"`), `${src} is kept`);
  }
  const opened = await openStanding(PHONE);
  const tools = await opened.context().newCDPSession(opened);
  const { url, errors, data } = await tools.send('Page.getAppManifest');
  assert.equal(url, `${address()}manifest.webmanifest`);
  assert.deepEqual([errors, JSON.parse(data).display], [[], 'standalone']);
  const { installabilityErrors } = await tools.send('Page.getInstallabilityErrors');
  assert.deepEqual(installabilityErrors.filter(({ errorId }) => errorId !== 'in-incognito'), []);
});

test('stick and stop are under the thumbs, and the robot fills the screen', async () => {
  const opened = await openRemote();
  const { width, height } = PHONE.viewport;
  const [stick, stop, floor] = await Promise.all(['#stick', 'button.stop', 'section.floor'].map((name) => opened.locator(name).boundingBox()));
  for (const box of [stick, stop]) assert.ok(Math.min(box.width, box.height) >= THUMB, JSON.stringify(box));
  assert.ok(stick.x + stick.width <= REACH && height - stick.y <= REACH, JSON.stringify(stick));
  assert.ok(width - stop.x <= REACH && height - stop.y <= REACH, JSON.stringify(stop));
  assert.deepEqual([floor.x, floor.y], [0, 0]);
  assert.ok(floor.width >= width && floor.height >= height);
  for (const hidden of ['header', '.console', '#gaits', '#reset']) assert.equal(await opened.locator(hidden).first().isVisible(), false, hidden);
});

test('the remote drives and stops, and keeps the screen on while it is open', async () => {
  const opened = await openRemote();
  await opened.waitForFunction(() => document.querySelector('#gaits [data-command="walk"] small').textContent !== '');
  const { x, y, width } = await opened.locator('#stick').boundingBox();
  await opened.mouse.move(x + width / 2, y + width / 2);
  await opened.mouse.down();
  await opened.mouse.move(x + width / 2, y + 4);
  await opened.waitForFunction(() => window.lizard.gait === 'walk');
  await opened.locator('button.stop').dispatchEvent('click');
  await opened.waitForFunction(() => window.lizard.gait === 'stop');
  await opened.mouse.up();
  await opened.getByRole('button', { name: 'Remote' }).click();
  await opened.waitForFunction(() => window.locks === 0);
  assert.ok(await opened.locator('header').isVisible());
});

test('a robot that stops by itself buzzes', async () => {
  const opened = await openRemote();
  await opened.evaluate(() => window.lizard.ask('walk'));
  await opened.evaluate(() => window.lizard.setSupply(3));
  await advance(opened, 2000);
  assert.ok((await opened.evaluate(() => window.buzzes)) > 0);
});

test('the browser reported no error or warning', () => assert.deepEqual(complaints, []));
