// The page in Debian's Firefox. Boards at a port are tested in Chromium only, whose clock a test can stop: on a busy machine a
// simulated board is slower than real time.
import assert from 'node:assert/strict';
import { after, afterEach, before, test } from 'node:test';

import { DIST, address, advance, openBlank, close, complaints, openFirefox, serve, overflow, openStanding, assertStops, closePages, until, within } from './browser.js';

before(openFirefox);
afterEach(closePages);
after(close);

const click = (opened, selector) => opened.evaluate((selector) => document.querySelector(selector).click(), selector);
const text = (opened, selector) => opened.evaluate((selector) => document.querySelector(selector).textContent, selector);
const place = (opened) => opened.evaluate(() => window.lizard.last.place);

test('the image walks as predicted, and Esc stops it', async () => {
  const opened = await openStanding();
  assert.match(await text(opened, '#where'), /^on a simulated UNO, robot [a-z-]+ [0-9a-f]{8}$/);
  await click(opened, '#gaits button[data-command="walk"]');
  await advance(opened, 5500);
  const { predicted, measured } = await opened.evaluate(() => {
    const { robot, description } = window.lizard;
    const walk = description.gaits.findIndex(({ command }) => command === 'walk');
    return { predicted: robot.predict(walk), measured: window.lizard.measured() };
  });
  assert.ok(Math.abs(measured.forward / predicted.forward - 1) < 0.03, `${measured.forward} of ${predicted.forward} mm`);
  await assertStops(opened);
});

test('the page says that no board can be connected exactly if this Firefox lacks Web Serial', async () => {
  const opened = await openStanding();
  const { has, note, isOff } = await opened.evaluate(() => ({
    has: typeof navigator.serial?.requestPort === 'function',
    note: document.querySelector('#no-serial').hidden ? '' : document.querySelector('#no-serial').textContent,
    isOff: document.querySelector('#connect').disabled,
  }));
  assert.deepEqual([isOff, note.startsWith('This browser cannot reach a board on USB')], [!has, !has]);
});

test('every step of the first connection can be tried with the simulated board', async () => {
  const opened = await openStanding();
  await click(opened, '#setup-open');
  const count = await opened.evaluate(() => document.querySelectorAll('#setup-steps button').length);
  assert.equal(count, 9);
  for (let n = 0; n < count; n++) {
    await opened.evaluate((n) => document.querySelectorAll('#setup-steps button')[n].click(), n);
    await advance(opened, 2000);
    assert.match(await text(opened, '#setup-step'), new RegExp(`^${n + 1} of 9: `));
    const robot = await text(opened, '#setup-what');
    assert.ok(robot.length > 40 && !robot.includes('No robot'), robot);
  }
  await opened.evaluate(() => document.querySelectorAll('#setup-steps button')[2].click());
  await opened.evaluate(() => [...document.querySelectorAll('#setup-what button')].find(({ textContent }) => /middle/.test(textContent)).click());
  for (let n = 0; n < 40 && (await text(opened, '#setup-said')) === ''; n++) await advance(opened, 250);
  assert.match(await text(opened, '#setup-said'), /^Every servo holds its middle now/);
});

test('a phone\'s width shows it without scrolling sideways, and so does a large screen', async () => {
  for (const [width, height] of [[500, 800], [3840, 2160]]) {
    assert.equal(await overflow(await openStanding({ viewport: { width, height } })), 0);
  }
});

test('once opened, it walks without a server', async () => {
  const server = await serve(DIST);
  const opened = await openBlank({ serviceWorkers: 'allow' });
  await opened.goto(address(server));
  await until(opened, async () => (await navigator.serviceWorker.ready) && navigator.serviceWorker.controller !== null);
  server.closeAllConnections();
  await within('the server to close', new Promise((closed) => server.close(closed)));
  await opened.reload();
  await opened.waitForFunction(() => window.lizard);
  await advance(opened, 2500);
  await click(opened, '#gaits button[data-command="walk"]');
  await advance(opened, 3000);
  assert.ok((await place(opened)).y > 20);
});

test('the browser reported no error or warning', () => assert.deepEqual(complaints, []));
