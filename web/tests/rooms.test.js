// The rooms beside the stage: each has an address, fits its screen, keeps `stop` in reach, and draws only while it is open.
import assert from 'node:assert/strict';
import { createRequire } from 'node:module';
import { after, afterEach, before, test } from 'node:test';

import { address, advance, close, complaints, open, page, overflow, openStanding, closePages, unfold } from './browser.js';

before(open);
afterEach(closePages);
after(close);

const AXE = createRequire(import.meta.url).resolve('axe-core/axe.min.js');
const ROOMS = ['start', 'drive', 'gaits', 'build', 'board', 'measure', 'learn'];
/** The main element of each room, which a phone shows without scrolling. */
const ACTS = { start: '.doors', drive: '#speed', gaits: '#gait-try', build: '#sketch', board: '#setup-open', measure: '#measure-camera', learn: '#learn-title' };
const SIZES = [
  { viewport: { width: 360, height: 640 }, hasTouch: true, isMobile: true },
  { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true },
  { viewport: { width: 844, height: 390 }, hasTouch: true, isMobile: true },
  { viewport: { width: 1280, height: 720 } },
  { viewport: { width: 1440, height: 900 } },
];
const THEMES = ['light', 'dark'];
/** A thumb's reach from the corner of a phone, CSS pixels. */
const REACH = 120;

const link = (opened, room) => opened.locator(`nav a[href="#room=${room}"]`);
const isOpen = (opened, room) => opened.waitForFunction((room) => [...document.querySelectorAll('.room:not([hidden])')].map(({ id }) => id).join() === `room-${room}`, room);
const box = (opened, selector) => opened.evaluate((selector) => document.querySelector(selector).getBoundingClientRect().toJSON(), selector);

for (const options of SIZES.flatMap((size) => THEMES.map((colorScheme) => ({ ...size, colorScheme })))) {
  const { width, height } = options.viewport;
  test(`every room fits ${width} x ${height} pixels in ${options.colorScheme} colours, shows its main element and stop, and axe-core finds nothing`, async () => {
    const opened = await openStanding({ ...options, bypassCSP: true });
    await opened.addScriptTag({ path: AXE });
    for (const room of ROOMS) {
      await opened.evaluate((room) => (location.hash = `room=${room}`), room);
      await isOpen(opened, room);
      await opened.waitForFunction(() => document.querySelector('#floor').dataset.zoom);
      assert.equal(await overflow(opened), 0, room);
      const [act, stop, bar] = await Promise.all([ACTS[room], '.stop', 'nav'].map((selector) => box(opened, selector)));
      const bottom = options.hasTouch ? bar.top : height;
      assert.ok(act.top >= 0 && act.bottom <= bottom + 1, `${room}: ${ACTS[room]} ends at ${act.bottom} of ${bottom}`);
      assert.ok(stop.right <= width && stop.bottom <= height && Math.min(stop.width, stop.height) >= 44, room);
      if (options.hasTouch) assert.ok(width - stop.left <= REACH && height - stop.top <= REACH, JSON.stringify(stop));
      // Nothing covers it, wherever the page is scrolled to.
      await opened.evaluate(() => scrollTo(0, document.documentElement.scrollHeight));
      assert.equal(await opened.evaluate(([x, y]) => document.elementFromPoint(x, y).className, [stop.left + stop.width / 2, stop.top + stop.height / 2]), 'stop', room);
      const { violations } = await opened.evaluate(() => window.axe.run(document, { resultTypes: ['violations'] }));
      assert.deepEqual(violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html).join('\n')}`), [], room);
    }
  });
}

test('an address opens its room, with the robot that it names, and the tabs, the title and Back follow', async () => {
  const opened = await page();
  await isOpen(opened, 'start');
  await opened.goto(`${address()}#room=build&file=large`);
  await isOpen(opened, 'build');
  await opened.waitForFunction(() => window.lizard.file === 'large');
  await link(opened, 'gaits').focus();
  await opened.keyboard.press('Enter');
  await isOpen(opened, 'gaits');
  assert.equal(await link(opened, 'gaits').getAttribute('aria-current'), 'page');
  assert.equal(await link(opened, 'build').getAttribute('aria-current'), null);
  assert.equal(await opened.title(), 'Gaits and routines, lizard');
  await opened.waitForFunction(() => location.hash === '#room=gaits&file=large');
  await opened.goBack();
  await isOpen(opened, 'build');
  assert.equal(await link(opened, 'build').getAttribute('aria-current'), 'page');
  await opened.goForward();
  await isOpen(opened, 'gaits');
  // An unknown room.
  await opened.goto(`${address()}#room=cellar`);
  await isOpen(opened, 'start');
});

test('a robot that was changed stays when the browser goes back a room', async () => {
  const opened = await page();
  await link(opened, 'build').click();
  await opened.locator('#lengths input[name="links.l12"]').fill('46');
  await opened.keyboard.press('Enter');
  await opened.waitForFunction(() => location.hash.startsWith('#room=build&robot='));
  const first = await opened.evaluate(() => location.hash);
  await link(opened, 'drive').click();
  await isOpen(opened, 'drive');
  await opened.locator('#lengths input[name="links.l12"]').fill('47');
  await opened.keyboard.press('Enter');
  await opened.waitForFunction((first) => location.hash.startsWith('#room=build&robot=') && location.hash !== first, first);
  const toml = await opened.evaluate(() => window.lizard.toml);
  await opened.goBack();
  await isOpen(opened, 'drive');
  await opened.goBack();
  await isOpen(opened, 'build');
  await opened.waitForTimeout(500);
  assert.equal(await opened.evaluate(() => window.lizard.toml), toml);
});

test('the three doors of the first screen lead to rooms', async () => {
  const opened = await page();
  for (const [door, room] of [['Play', 'drive'], ['Build', 'build'], ['Connect', 'board']]) {
    await opened.locator('.doors a', { hasText: door }).click();
    await isOpen(opened, room);
    await opened.goBack();
    await isOpen(opened, 'start');
  }
});

test('a closed room draws nothing, even if its panels are unfolded', async () => {
  const opened = await openStanding();
  for (const panel of ['#maps', '#margins-panel', '#pulses', '#keep', '#power', '#routines', '#path-editor', '#parts']) await unfold(opened, panel);
  await opened.locator('#solid').click();
  // The parts may come late, and fill their lists then.
  await opened.waitForFunction(() => document.querySelector('#part').length > 10);
  await link(opened, 'board').click();
  await isOpen(opened, 'board');
  await opened.evaluate(() => window.lizard.ask('walk'));
  await opened.waitForFunction(() => document.querySelector('#cycle').textContent.endsWith('mm'));
  const drawn = await opened.evaluate(async () => {
    const drawn = [];
    const hidden = [...document.querySelectorAll('.room[hidden]')];
    const watcher = new MutationObserver((changes) => {
      // The log keeps the robot's lines.
      for (const { target } of changes) if (!target.closest?.('#log') && !target.parentElement?.closest('#log')) drawn.push(target.id || target.nodeName);
    });
    for (const room of hidden) watcher.observe(room, { subtree: true, childList: true, attributes: true, characterData: true });
    const { getContext } = HTMLCanvasElement.prototype;
    HTMLCanvasElement.prototype.getContext = function (...values) {
      if (this.closest('.room')) drawn.push(this.id);
      return getContext.apply(this, values);
    };
    await new Promise((done) => setTimeout(done, 3000));
    return drawn;
  });
  assert.deepEqual(drawn, []);
});

test('3D and the drawing from above are one press apart, and three.js is loaded for 3D alone', async () => {
  const loaded = [];
  const opened = await openStanding();
  opened.on('request', (request) => loaded.push(new URL(request.url()).pathname));
  for (const room of ROOMS.slice(1)) await link(opened, room).click();
  assert.deepEqual(loaded.filter((path) => /space|parts/.test(path)), []);
  await opened.locator('#solid').click();
  await opened.waitForFunction(() => document.querySelector('#part').length > 10);
  assert.ok(loaded.some((path) => /space/.test(path)));
  assert.ok(await opened.locator('#space').isVisible());
  await opened.locator('#solid').click();
  assert.ok(!(await opened.locator('#space').isVisible()));
});

test('the browser reported no error or warning', () => assert.deepEqual(complaints, []));
