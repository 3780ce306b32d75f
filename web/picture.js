// The moving picture of README: the page, walking, a cycle of the gait. Writes pictures into the folder that is named;
// scripts/page-picture makes one of them.
import { mkdir } from 'node:fs/promises';
import { join } from 'node:path';

import { advance, close, open, standing } from './tests/browser.js';

const [, , folder] = process.argv;
/** A cycle of walk, after as many as it takes to be even; and pictures of one. */
const [CYCLE, BEFORE, PICTURES] = [1000, 3, 16];

await mkdir(folder, { recursive: true });
await open();
const opened = await standing({ viewport: { width: 1240, height: 800 }, deviceScaleFactor: 0.75, colorScheme: 'light' });
await opened.locator('#gaits button[data-command="walk"]').click();
await opened.evaluate(() => {
  document.activeElement.blur();
  scrollTo(0, 0);
});
await advance(opened, BEFORE * CYCLE);
for (let n = 0; n < PICTURES; n++) {
  await advance(opened, CYCLE / PICTURES);
  await opened.screenshot({ path: join(folder, `${String(n).padStart(2, '0')}.png`) });
}
await close();
