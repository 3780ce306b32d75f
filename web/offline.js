// Builds the page's service worker, which contains a list of the page's files.
import { createHash } from 'node:crypto';
import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

const WORKER_NAME = 'service-worker.js';
/** The picture that a chat shows with a link to the page; the page itself does not use it. */
const PREVIEW_NAME = 'preview.png';

/** Writes the service worker for the page in `folder` into that folder. */
export function writeServiceWorker(folder) {
  const paths = readdirSync(folder, { recursive: true, withFileTypes: true })
    .filter((entry) => entry.isFile())
    .map((entry) => join(entry.parentPath ?? entry.path, entry.name).slice(join(folder, '/').length).replaceAll('\\', '/'))
    .filter((path) => path !== WORKER_NAME && path !== PREVIEW_NAME)
    .sort();
  const computeHash = (path) => createHash('sha256').update(readFileSync(join(folder, path))).digest('hex');
  const fileList = paths.map((path) => `  [${JSON.stringify(path)}, '${computeHash(path)}'],`).join('\n');
  const workerSource = readFileSync(new URL(WORKER_NAME, import.meta.url), 'utf8');
  const buildHash = createHash('sha256').update(fileList).digest('hex');
  const constantsSource = `const BUILD = '${buildHash}';\nconst FILES = [\n${fileList}\n];\n\n`;
  writeFileSync(join(folder, WORKER_NAME), constantsSource + workerSource);
}

/** A Vite plugin that writes the service worker after all other files are built. */
export const offline = () => ({ name: 'offline', apply: 'build', closeBundle: () => writeServiceWorker(new URL('dist', import.meta.url).pathname) });
