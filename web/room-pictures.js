// Takes pictures of every room on a phone and on a desktop, to look at after a change of the page: node web/room-pictures.js FOLDER [dark]
import { mkdir } from 'node:fs/promises';
import { join } from 'node:path';

import { address, advance, close, open, openStanding } from './tests/browser.js';

const [, , folder, colorScheme = 'light'] = process.argv;
const ROOMS = ['start', 'drive', 'gaits', 'build', 'board', 'measure', 'learn'];
const SIZES = [[390, 844], [360, 640], [844, 390], [1280, 800]];

await mkdir(folder, { recursive: true });
await open();
for (const [width, height] of SIZES) {
  const isPhone = Math.min(width, height) < 500;
  const opened = await openStanding({ viewport: { width, height }, colorScheme, hasTouch: isPhone, isMobile: isPhone });
  await opened.evaluate(() => window.lizard.ask('walk'));
  for (const room of ROOMS) {
    await opened.goto(`${address()}#room=${room}`);
    await advance(opened, 2000);
    await opened.waitForTimeout(1500);
    await opened.screenshot({ path: join(folder, `${room}-${width}x${height}.png`) });
    if (width === 390 || width === 1280) await opened.screenshot({ path: join(folder, `${room}-${width}-whole.png`), fullPage: true });
  }
}
await close();
