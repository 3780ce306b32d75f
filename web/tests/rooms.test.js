// The rooms of the page: each has an address, fits its screen, keeps Stop within reach, and renders only while it
// is open.
import assert from 'node:assert/strict';

import { findViolations } from './axe.js';
import { address, openPage, measureOverflow, openStanding, readBox, unfold, useBrowser, typeLength, testPage, readToml } from './browser.js';

useBrowser();

const ROOMS = ['start', 'drive', 'gaits', 'build', 'board', 'measure', 'learn'];
/** The main element of each room, which a phone shows without scrolling. */
const MAIN_ELEMENTS = { start: '.doors', drive: '#speed', gaits: '#gait-try', build: '#sketch', board: '#setup-open', measure: '#measure-camera', learn: '#learn-title' };
const SIZES = [
  { viewport: { width: 360, height: 640 }, hasTouch: true, isMobile: true },
  { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true },
  { viewport: { width: 844, height: 390 }, hasTouch: true, isMobile: true },
  { viewport: { width: 1280, height: 720 } },
  { viewport: { width: 1440, height: 900 } },
];
const THEMES = ['light', 'dark'];
/** A thumb's reach from the corner of a phone, CSS pixels. */
const REACH_PX = 120;

const findTab = (page, room) => page.locator(`nav a[href="#room=${room}"]`);
const waitForRoom = (page, room) => page.waitForFunction((room) => [...document.querySelectorAll('.room:not([hidden])')].map(({ id }) => id).join() === `room-${room}`, room);

// Colours do not change the layout, so each size is tested with only one theme.
for (const options of SIZES.map((size, n) => ({ ...size, colorScheme: THEMES[n % 2] }))) {
  const { width, height } = options.viewport;
  testPage(`every room fits ${width} x ${height} pixels in ${options.colorScheme} colours, shows its main element and Stop, and has no violations for axe-core`, () => openStanding({ ...options, bypassCSP: true }), async (page) => {
    for (const room of ROOMS) {
      await page.evaluate((room) => (location.hash = `room=${room}`), room);
      await waitForRoom(page, room);
      await page.waitForFunction(() => document.querySelector('#floor').dataset.zoom);
      assert.equal(await measureOverflow(page), 0, room);
      const [mainElement, stop, navigation] = await Promise.all([MAIN_ELEMENTS[room], '.stop', 'nav'].map((selector) => readBox(page, selector)));
      const bottom = options.hasTouch ? navigation.top : height;
      assert.ok(mainElement.top >= 0 && mainElement.bottom <= bottom + 1, `${room}: ${MAIN_ELEMENTS[room]} ends at ${mainElement.bottom} of ${bottom} pixels`);
      assert.ok(stop.right <= width && stop.bottom <= height && Math.min(stop.width, stop.height) >= 44, room);
      if (options.hasTouch) assert.ok(Math.max(width - stop.left, height - stop.top) <= REACH_PX, JSON.stringify(stop));
      // Nothing covers Stop at the bottom of the page either.
      await page.evaluate(() => scrollTo(0, document.documentElement.scrollHeight));
      assert.equal(await page.evaluate(([x, y]) => document.elementFromPoint(x, y).className, [stop.left + stop.width / 2, stop.top + stop.height / 2]), 'stop', room);
      assert.deepEqual(await findViolations(page), [], room);
    }
  });
}

testPage('an address opens its room and its robot, and the tabs, the title and Back follow', openPage, async (page) => {
  await waitForRoom(page, 'start');
  await page.goto(`${address()}#room=build&file=large`);
  await waitForRoom(page, 'build');
  await page.waitForFunction(() => window.lizard.robot.file === 'large');
  await findTab(page, 'gaits').focus();
  await page.keyboard.press('Enter');
  await waitForRoom(page, 'gaits');
  assert.equal(await findTab(page, 'gaits').getAttribute('aria-current'), 'page');
  assert.equal(await findTab(page, 'build').getAttribute('aria-current'), null);
  assert.equal(await page.title(), 'Gaits and routines, lizard');
  await page.waitForFunction(() => location.hash === '#room=gaits&file=large');
  await page.goBack();
  await waitForRoom(page, 'build');
  assert.equal(await findTab(page, 'build').getAttribute('aria-current'), 'page');
  await page.goForward();
  await waitForRoom(page, 'gaits');
  // An unknown room.
  await page.goto(`${address()}#room=cellar`);
  await waitForRoom(page, 'start');
});

testPage('a changed robot stays when the browser goes back to the previous room', openPage, async (page) => {
  await findTab(page, 'build').click();
  await typeLength(page, 'links.l12', 46);
  await page.waitForFunction(() => location.hash.startsWith('#room=build&robot='));
  const firstHash = await page.evaluate(() => location.hash);
  await findTab(page, 'drive').click();
  await waitForRoom(page, 'drive');
  await typeLength(page, 'links.l12', 47);
  await page.waitForFunction((firstHash) => location.hash.startsWith('#room=build&robot=') && location.hash !== firstHash, firstHash);
  const toml = await readToml(page);
  await page.goBack();
  await waitForRoom(page, 'drive');
  await page.goBack();
  await waitForRoom(page, 'build');
  await page.waitForTimeout(500);
  assert.equal(await readToml(page), toml);
});

testPage('the three doors of the first screen lead to rooms', openPage, async (page) => {
  for (const [door, room] of [['Play', 'drive'], ['Build', 'build'], ['Connect', 'board']]) {
    await page.locator('.doors a', { hasText: door }).click();
    await waitForRoom(page, room);
    await page.goBack();
    await waitForRoom(page, 'start');
  }
});

testPage('a closed room renders nothing, even if its panels are unfolded', openStanding, async (page) => {
  for (const panel of ['#maps', '#margins-panel', '#pulses', '#keep', '#power', '#routines', '#gesture-editor', '#parts']) await unfold(page, panel);
  await page.locator('#button-3d').click();
  // The parts fill their lists when they are loaded.
  await page.waitForFunction(() => document.querySelector('#part').length > 10);
  await findTab(page, 'board').click();
  await waitForRoom(page, 'board');
  await page.evaluate(() => window.lizard.board.ask('walk'));
  await page.waitForFunction(() => document.querySelector('#cycle').textContent.endsWith('mm'));
  const drawnNames = await page.evaluate(async () => {
    const drawnNames = [];
    const closedRooms = [...document.querySelectorAll('.room[hidden]')];
    const observer = new MutationObserver((changes) => {
      // The log keeps the robot's lines.
      for (const { target } of changes) if (!target.closest?.('#log') && !target.parentElement?.closest('#log')) drawnNames.push(target.id || target.nodeName);
    });
    for (const room of closedRooms) observer.observe(room, { subtree: true, childList: true, attributes: true, characterData: true });
    const { getContext } = HTMLCanvasElement.prototype;
    HTMLCanvasElement.prototype.getContext = function (...args) {
      if (this.closest('.room')) drawnNames.push(this.id);
      return getContext.apply(this, args);
    };
    await new Promise((resolve) => setTimeout(resolve, 3000));
    return drawnNames;
  });
  assert.deepEqual(drawnNames, []);
});

testPage('one press switches between 3D and the plan view, and three.js is loaded only for 3D', openStanding, async (page) => {
  const loadedPaths = [];
  page.on('request', (request) => loadedPaths.push(new URL(request.url()).pathname));
  for (const room of ROOMS.slice(1)) await findTab(page, room).click();
  assert.deepEqual(loadedPaths.filter((path) => /robot-view|parts/.test(path)), []);
  await page.locator('#button-3d').click();
  await page.waitForFunction(() => document.querySelector('#part').length > 10);
  assert.ok(loadedPaths.some((path) => /robot-view/.test(path)));
  assert.ok(await page.locator('#canvas-3d').isVisible());
  await page.locator('#button-3d').click();
  assert.ok(!(await page.locator('#canvas-3d').isVisible()));
});
