// The page for everyone: axe-core finds nothing, a phone shows all of it, keys reach all of it.
import assert from 'node:assert/strict';
import { createRequire } from 'node:module';
import { after, afterEach, before, test } from 'node:test';

import { advance, close, complaints, open, standing, tidy } from './browser.js';

before(open);
afterEach(tidy);
after(close);

const AXE = createRequire(import.meta.url).resolve('axe-core/axe.min.js');
const PHONE = { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, hasTouch: true };

async function opened(options) {
  // axe-core is put into the page, which its policy would not have.
  const page = await standing({ ...options, bypassCSP: true });
  for (const name of ['Keep and compare', 'Make a gait', 'Draw a gesture', 'Lengths', 'Calibrate', 'Flash']) await page.getByText(name, { exact: true }).click();
  await page.locator('#robot-editor summary').click();
  await page.locator('#parts summary').click();
  await page.getByText('Click a part for its name').waitFor();
  await advance(page, 500);
  await page.getByRole('group', { name: 'A4' }).waitFor();
  return page;
}

for (const [name, options] of [
  ['light', { colorScheme: 'light' }],
  ['dark', { colorScheme: 'dark' }],
  ['on a phone', PHONE],
]) {
  test(`axe-core finds nothing, ${name}`, async () => {
    const page = await opened(options);
    await page.addScriptTag({ path: AXE });
    const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ['violations'] }));
    const found = violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html).join('\n')}`);
    assert.deepEqual(found, []);
  });
}

for (const [name, options] of [
  ['light', { colorScheme: 'light' }],
  ['dark, on a phone', { ...PHONE, colorScheme: 'dark' }],
  ['in colours of the user\'s own', { forcedColors: 'active' }],
]) {
  test(`axe-core finds nothing in any step of the first connection, ${name}`, async () => {
    const page = await standing({ ...options, bypassCSP: true });
    await page.addScriptTag({ path: AXE });
    await page.getByRole('button', { name: 'Set up…' }).click();
    const steps = await page.locator('#setup-steps button').all();
    assert.equal(steps.length, 9);
    for (const step of steps) {
      await step.click();
      await advance(page, 1500);
      const { violations } = await page.evaluate(() => window.axe.run('#setup', { resultTypes: ['violations'] }));
      const found = violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html).join('\n')}`);
      assert.deepEqual(found, [], await page.locator('#setup-step').innerText());
    }
  });
}

test('a phone shows it without scrolling sideways', async () => {
  const page = await opened(PHONE);
  const { wide, seen } = await page.evaluate(() => ({
    wide: document.documentElement.scrollWidth,
    seen: document.documentElement.clientWidth,
  }));
  assert.ok(wide <= seen, `${wide} of ${seen} pixels`);
});

test('the floor is moved by keys, and drags by a pointer', async () => {
  const page = await standing();
  const floor = page.locator('#floor');
  const follow = page.getByRole('button', { name: 'Follow' });
  assert.equal(await follow.getAttribute('aria-pressed'), 'true');
  await floor.focus();
  await floor.press('ArrowLeft');
  assert.equal(await follow.getAttribute('aria-pressed'), 'false');
  await follow.click();
  const box = await floor.boundingBox();
  await page.mouse.move(box.x + 300, box.y + 300);
  await page.mouse.down();
  await page.mouse.move(box.x + 350, box.y + 320);
  await page.mouse.up();
  assert.equal(await follow.getAttribute('aria-pressed'), 'false');
});

test('nothing was complained of', () => assert.deepEqual(complaints, []));
