// Builds the page's service worker, with the list of all files of the page.
import { createHash } from 'node:crypto';
import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

const NAME = 'service-worker.js';
/** For those who show links to the page, and not for the page. */
const PREVIEW = 'preview.png';

/** Writes the service worker of the page in a folder. */
export function writeServiceWorker(folder) {
  const paths = readdirSync(folder, { recursive: true, withFileTypes: true })
    .filter((entry) => entry.isFile())
    .map((entry) => join(entry.parentPath ?? entry.path, entry.name).slice(join(folder, '/').length).replaceAll('\\', '/'))
    .filter((path) => path !== NAME && path !== PREVIEW)
    .sort();
  const hash = (path) => createHash('sha256').update(readFileSync(join(folder, path))).digest('hex');
  const list = paths.map((path) => `  [${JSON.stringify(path)}, '${hash(path)}'],`).join('\n');
  const source = readFileSync(new URL(NAME, import.meta.url), 'utf8');
  const build = createHash('sha256').update(list).digest('hex');
  writeFileSync(join(folder, NAME), `const BUILD = '${build}';\nconst FILES = [\n${list}\n];\n\n${source}`);
}

/** A plugin that writes the service worker when Vite has built everything else. */
export const offline = () => ({ name: 'offline', apply: 'build', closeBundle: () => writeServiceWorker(new URL('dist', import.meta.url).pathname) });
