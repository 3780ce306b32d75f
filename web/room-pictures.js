// Takes screenshots of every room at the sizes of phones and a desktop, for a visual check of a change.
// Usage: node web/room-pictures.js FOLDER [dark]
import { mkdir } from 'node:fs/promises';
import { join } from 'node:path';

import { address, advance, closeBrowser, openBrowser, openStanding } from './tests/browser.js';

const [, , folder, colorScheme = 'light'] = process.argv;
const ROOMS = ['start', 'drive', 'gaits', 'build', 'board', 'measure', 'learn'];
const SIZES = [[390, 844], [360, 640], [844, 390], [1280, 800]];

await mkdir(folder, { recursive: true });
await openBrowser();
for (const [width, height] of SIZES) {
  const isPhone = Math.min(width, height) < 500;
  const page = await openStanding({ viewport: { width, height }, colorScheme, hasTouch: isPhone, isMobile: isPhone });
  await page.evaluate(() => window.lizard.board.ask('walk'));
  for (const room of ROOMS) {
    await page.goto(`${address()}#room=${room}`);
    await advance(page, 2000);
    await page.waitForTimeout(1500);
    await page.screenshot({ path: join(folder, `${room}-${width}x${height}.png`) });
    if (width === 390 || width === 1280) await page.screenshot({ path: join(folder, `${room}-${width}-whole.png`), fullPage: true });
  }
}
await closeBrowser();
