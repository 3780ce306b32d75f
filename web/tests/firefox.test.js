// The page in Debian's Firefox. Boards behind a port are Chromium's, whose clock a test can hold: a simulated board on a busy
// machine is slower than the clock on the wall.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';

import { DIST, address, serve, sideways, within } from './browser.js';
import { Firefox } from './firefox.js';

/** The key Esc of WebDriver. */
const ESCAPE = '\uE00C';

let firefox;
let server;

before(async () => {
  server = await serve(DIST);
  firefox = await Firefox.start();
});
after(async () => {
  await firefox?.stop();
  server?.closeAllConnections();
  server?.close();
});

const advance = (ms) =>
  firefox.evaluate(async (ms) => {
    for (let left = ms; left > 0; left -= 4) {
      window.lizard.advance(Math.min(4, left));
      await Promise.resolve();
    }
  }, ms);

const click = (selector) => firefox.evaluate((selector) => document.querySelector(selector).click(), selector);
const text = (selector) => firefox.evaluate((selector) => document.querySelector(selector).textContent, selector);
const place = () => firefox.evaluate(() => window.lizard.last.place);

async function standing() {
  await firefox.goto(address(server));
  await firefox.until(() => window.lizard !== undefined);
  await advance(2500);
}

test('the image of the board walks the predicted way, and Esc stops it', async () => {
  await standing();
  assert.match(await text('#where'), /^on a simulated UNO, robot [a-z-]+ [0-9a-f]{8}$/);
  await click('#gaits button[data-command="walk"]');
  await advance(5500);
  const { predicted, measured } = await firefox.evaluate(() => {
    const { robot, description } = window.lizard;
    const walk = description.gaits.findIndex(({ command }) => command === 'walk');
    return { predicted: robot.predict(walk), measured: window.lizard.measured() };
  });
  assert.ok(Math.abs(measured.forward / predicted.forward - 1) < 0.03, `${measured.forward} of ${predicted.forward} mm`);
  await firefox.press(ESCAPE);
  await advance(500);
  const stopped = await place();
  await advance(1000);
  assert.deepEqual(await place(), stopped);
});

test('it says that no board can be connected exactly where this Firefox has no Web Serial', async () => {
  await standing();
  const { has, note, isOff } = await firefox.evaluate(() => ({
    has: typeof navigator.serial?.requestPort === 'function',
    note: document.querySelector('#no-serial').hidden ? '' : document.querySelector('#no-serial').textContent,
    isOff: document.querySelector('#connect').disabled,
  }));
  assert.deepEqual([isOff, note.startsWith('This browser cannot reach a board on USB')], [!has, !has]);
});

test('every step of the first connection can be tried with the simulated board', async () => {
  await standing();
  await click('#setup-open');
  const count = await firefox.evaluate(() => document.querySelectorAll('#setup-steps button').length);
  assert.equal(count, 9);
  for (let n = 0; n < count; n++) {
    await firefox.evaluate((n) => document.querySelectorAll('#setup-steps button')[n].click(), n);
    await advance(2000);
    assert.match(await text('#setup-step'), new RegExp(`^${n + 1} of 9: `));
    const robot = await firefox.evaluate(() => document.querySelector('#setup-what').textContent);
    assert.ok(robot.length > 40 && !robot.includes('No robot'), robot);
  }
  await firefox.evaluate(() => document.querySelectorAll('#setup-steps button')[2].click());
  await firefox.evaluate(() => [...document.querySelectorAll('#setup-what button')].find(({ textContent }) => /middle/.test(textContent)).click());
  for (let n = 0; n < 40 && (await text('#setup-said')) === ''; n++) await advance(250);
  assert.match(await text('#setup-said'), /^Every servo holds its middle now/);
});

test('a phone\'s width shows it without scrolling sideways, and so does a large screen', async () => {
  for (const [width, height] of [[500, 800], [3840, 2160]]) {
    await firefox.size(width, height);
    await standing();
    assert.equal(await sideways(firefox), 0);
  }
});

test('once opened, it walks without a server', async () => {
  await standing();
  await firefox.until(async () => (await navigator.serviceWorker.ready) && navigator.serviceWorker.controller !== null);
  server.closeAllConnections();
  await within('the server to close', new Promise((closed) => server.close(closed)));
  await firefox.reload();
  await firefox.until(() => window.lizard !== undefined);
  await advance(2500);
  await click('#gaits button[data-command="walk"]');
  await advance(3000);
  assert.ok((await place()).y > 20);
});

test('nothing was complained of', () => assert.deepEqual(firefox.complaints, []));
