// A problem is shown where the user looks, and stays until it is solved.
import assert from 'node:assert/strict';
import { after, afterEach, before, test } from 'node:test';

import { address, advance, close, closePages, complaints, open, openBlank, openForbidden, openStanding, page, text, type, unfold } from './browser.js';
import { fakeSerial } from './fake-serial.js';

before(open);
afterEach(closePages);
after(close);

const trouble = (opened) => opened.locator('#trouble');

test('the message about an unreadable robot file stays while the previous robot walks on', async () => {
  const opened = await openStanding();
  await opened.route('**/files/large.toml', (route) => route.fulfill({ status: 404 }));
  await opened.locator('#robot').selectOption('large');
  const said = trouble(opened).getByText('files/large.toml is not there (404)');
  await said.waitFor();
  assert.equal(await opened.locator('#robot').inputValue(), 'robot', 'the choice is the robot that is there');
  await type(opened, 'walk', 'ok walk');
  await advance(opened, 5000);
  await unfold(opened, '#power');
  await opened.locator('#health dd', { hasText: 'power' }).waitFor();
  assert.ok(await said.isVisible(), 'good answers and the poll of the status do not take it away');
  assert.equal(await opened.evaluate(() => window.lizard.file), 'robot');
  await opened.unroute('**/files/large.toml');
  await opened.locator('#robot').selectOption('large');
  await opened.waitForFunction(() => window.lizard.file === 'large');
  assert.equal(await trouble(opened).isVisible(), false, 'a robot that can be read ends it');
  // The browser itself reports what the test removed.
  complaints.splice(0, complaints.length, ...complaints.filter((said) => !/404/.test(said)));
});

test('a page whose first robot cannot be read says so, and takes another one', async () => {
  const opened = await openBlank();
  await opened.route('**/files/robot.toml', (route) => route.fulfill({ status: 404 }));
  await opened.goto(address());
  await trouble(opened).getByText('files/robot.toml is not there (404)').waitFor();
  assert.equal(await text(opened, '#where'), 'No robot could be read.');
  await opened.locator('#robot').selectOption('paper');
  await opened.waitForFunction(() => window.lizard?.file === 'paper');
  await advance(opened, 2500);
  assert.match(await text(opened, '#where'), /^on a simulated UNO, robot paper [0-9a-f]{8}$/);
  assert.equal(await trouble(opened).isVisible(), false);
});

test('the message about a busy port stays until the user dismisses it', async () => {
  const opened = await page({}, fakeSerial);
  await opened.evaluate(() => {
    window.openPort = () => {
      throw new DOMException('Failed to open serial port.', 'NetworkError');
    };
  });
  await opened.locator('#connect').click();
  const said = trouble(opened).getByText('No board is connected: Failed to open serial port.');
  await said.waitFor();
  await unfold(opened, '#power');
  await opened.clock.runFor(8000);
  await opened.locator('#health dd', { hasText: 'power' }).waitFor();
  assert.ok(await said.isVisible());
  await opened.getByRole('button', { name: 'Dismiss' }).click();
  assert.equal(await trouble(opened).isVisible(), false);
});

test('picking no port reports no problem', async () => {
  const opened = await page({}, fakeSerial);
  await opened.evaluate(() => {
    window.pick = () => {
      window.picked = true;
      throw new DOMException('No port selected by the user.', 'NotFoundError');
    };
  });
  await opened.locator('#connect').click();
  await opened.waitForFunction(() => window.picked);
  await opened.clock.runFor(500);
  assert.equal(await trouble(opened).isVisible(), false);
  assert.match(await text(opened, '#where'), /simulated UNO/);
});

test('if ports are forbidden, the page says why, and the simulation continues', async () => {
  const opened = await openForbidden('serial');
  await opened.locator('#connect').click();
  await trouble(opened).getByText('Access to the feature "serial" is disallowed by permissions policy.').waitFor();
  assert.match(await trouble(opened).innerText(), /^No board is connected: /);
  assert.match(await text(opened, '#where'), /simulated UNO/);
});

test('without Web Serial the page says so before anything is pressed', async () => {
  const opened = await page({}, () => Object.defineProperty(navigator, 'serial', { value: undefined }));
  await opened.getByText('This browser cannot reach a board on USB').waitFor();
});

test('a refused button says why beside the buttons, on a phone too', async () => {
  const opened = await openStanding({ viewport: { width: 390, height: 844 }, hasTouch: true });
  await opened.locator('[data-command="rest"]').click();
  await advance(opened, 300);
  await opened.locator('#gaits button[data-command="walk"]').click();
  await advance(opened, 300);
  const said = opened.locator('#drive-said');
  await said.getByText('walk: servos are resting, send stand first').waitFor();
  const { y, height } = await said.boundingBox();
  assert.ok(y >= 0 && y + height <= 844, `it is on the screen: ${y} to ${y + height}`);
  await opened.locator('#gaits button[data-command="stand"]').click();
  await advance(opened, 300);
  await said.waitFor({ state: 'hidden' });
});

test('the browser reported no error or warning', () => assert.deepEqual(complaints, []));
