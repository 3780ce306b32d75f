// Writes pictures of the page into a folder: the frames of the README's animation, which shows one cycle of a walk; the
// gait editor for docs/web.md; and the preview that a chat shows with a link. scripts/update-page-pictures runs this
// script.
import { mkdir } from 'node:fs/promises';
import { join } from 'node:path';

import { address, closeBrowser, openBrowser, openPage } from './tests/browser.js';

const [, , folder] = process.argv;
/** Duration of a cycle of `walk`. */
const CYCLE_MS = 1000;
/** Number of cycles after which all later cycles are equal. */
const WARM_UP_CYCLES = 3;
const FRAME_COUNT = 16;

await mkdir(folder, { recursive: true });
await openBrowser();
// The script advances the page's clock, so that the frames are evenly spaced and the view follows the robot.
const page = await openPage({ viewport: { width: 1240, height: 800 }, deviceScaleFactor: 0.75, colorScheme: 'light' }, () => {});
await page.goto(`${address()}#room=drive`);
await page.clock.runFor(3000);
await page.locator('#gaits button[data-command="walk"]').click();
await page.evaluate(() => {
  document.activeElement.blur();
  scrollTo(0, 0);
});
// Waits until the button of every gait except `stand` shows a prediction.
await page.waitForFunction(() => [...document.querySelectorAll('#gaits button:not([data-command="stand"]) small')].every((note) => note.textContent !== ''));
await page.clock.runFor(WARM_UP_CYCLES * CYCLE_MS);
for (let n = 0; n < FRAME_COUNT; n++) {
  await page.clock.runFor(CYCLE_MS / FRAME_COUNT);
  await page.screenshot({ path: join(folder, `${String(n).padStart(2, '0')}.png`) });
}
// The gait editor with the result of a short search.
await page.setViewportSize({ width: 1240, height: 1300 });
await page.goto(`${address()}#room=gaits`);
await page.getByLabel('Rounds of 40 gaits').fill('1');
await page.getByRole('button', { name: 'Make it faster' }).click();
await page.waitForFunction(() => document.querySelector('#faster-message').textContent.startsWith('Faster on'));
await page.getByRole('button', { name: 'Use this gait' }).click();
await page.waitForFunction(() => document.querySelector('#gait-distance').textContent === document.querySelector('#faster-rows tr:nth-child(2) td:last-child').textContent);
await page.locator('#gait-editor').screenshot({ path: join(folder, 'editor.png') });
// The preview: the first room, with the robot in 3D. Without a GPU the page halves the resolution of 3D, so the picture
// is taken with twice the pixels, and scripts/update-page-pictures reduces it.
const previewPage = await openPage({ viewport: { width: 1600, height: 840 }, deviceScaleFactor: 1.5, colorScheme: 'light' }, () => {});
await previewPage.goto(`${address()}#room=start`);
await previewPage.locator('#button-3d').click();
await previewPage.waitForFunction(() => document.querySelector('#parts-message').textContent.startsWith('Click'));
await previewPage.clock.runFor(1500);
await previewPage.screenshot({ path: join(folder, 'preview.png') });
await closeBrowser();
