// The frames of two animations: of the README, one cycle of a walk in the page; of docs/web.md, the gait editor. And the picture
// that a chat shows beside a link. Writes them into a folder; scripts/page-picture makes the animations.
import { mkdir } from 'node:fs/promises';
import { join } from 'node:path';

import { address, close, open, page } from './tests/browser.js';

const [, , folder] = process.argv;
/** A cycle of walk, after as many as it takes to be even; and pictures of one. */
const [CYCLE, BEFORE, PICTURES] = [1000, 3, 16];

await mkdir(folder, { recursive: true });
await open();
// This script drives the page's clock, so that frames are evenly spaced and the view follows the robot.
const opened = await page({ viewport: { width: 1240, height: 800 }, deviceScaleFactor: 0.75, colorScheme: 'light' }, () => {});
await opened.goto(`${address()}#room=drive`);
await opened.clock.runFor(3000);
await opened.locator('#gaits button[data-command="walk"]').click();
await opened.evaluate(() => {
  document.activeElement.blur();
  scrollTo(0, 0);
});
// Waits until every gait that moves shows its prediction.
await opened.waitForFunction(() => [...document.querySelectorAll('#gaits button:not([data-command="stand"]) small')].every((way) => way.textContent !== ''));
await opened.clock.runFor(BEFORE * CYCLE);
for (let n = 0; n < PICTURES; n++) {
  await opened.clock.runFor(CYCLE / PICTURES);
  await opened.screenshot({ path: join(folder, `${String(n).padStart(2, '0')}.png`) });
}
// A short search, and its result on the screen.
await opened.setViewportSize({ width: 1240, height: 1300 });
await opened.goto(`${address()}#room=gaits`);
await opened.getByLabel('Rounds of 40 gaits').fill('1');
await opened.getByRole('button', { name: 'Make it faster' }).click();
await opened.waitForFunction(() => document.querySelector('#faster-said').textContent.startsWith('Faster on'));
await opened.getByRole('button', { name: 'Use this gait' }).click();
await opened.waitForFunction(() => document.querySelector('#gait-way').textContent === document.querySelector('#faster-rows tr:nth-child(2) td:last-child').textContent);
await opened.locator('#gait-editor').screenshot({ path: join(folder, 'editor.png') });
// The first screen with the robot in 3D.
await opened.setViewportSize({ width: 1600, height: 840 });
await opened.goto(`${address()}#room=start`);
await opened.locator('#solid').click();
await opened.waitForFunction(() => document.querySelector('#parts-said').textContent.startsWith('Click'));
await opened.clock.runFor(1500);
await opened.screenshot({ path: join(folder, 'preview.png') });
await close();
