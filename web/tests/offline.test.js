// A page that was opened once works without a network, is updated as a whole, and contacts no other server.
import assert from 'node:assert/strict';
import { cp, mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, afterEach, before, test } from 'node:test';
import { gzipSync } from 'node:zlib';

import { writeServiceWorker } from '../offline.js';
import { DIST, TIMEOUT_MS, address, advance, openBlank, closeBrowser, complaints, openBrowser, serve, closePages, waitUntil, withTimeout } from './browser.js';

let folder;
const servers = [];

before(async () => {
  await openBrowser();
  folder = await mkdtemp(join(tmpdir(), 'lizard-page-'));
});
afterEach(async () => {
  await closePages();
  for (const server of servers.splice(0)) {
    server.closeAllConnections();
    server.close();
  }
});
after(async () => {
  await closeBrowser();
  if (folder) await rm(folder, { recursive: true });
});

/** Starts a web server for a copy of the page. */
async function serveCopy(name, requestedPaths = []) {
  const copyFolder = join(folder, name);
  await cp(DIST, copyFolder, { recursive: true });
  const server = await serve(copyFolder, requestedPaths);
  servers.push(server);
  return { copyFolder, server, requestedPaths };
}

const openWithServiceWorkers = () => openBlank({ serviceWorkers: 'allow' });
const waitUntilStarted = (page) => page.waitForFunction(() => window.lizard);

/** Waits until the service worker has stored the page and answers its requests. */
async function waitUntilStored(page) {
  await waitUntilStarted(page);
  await waitUntil(page, async () =>
    (await navigator.serviceWorker.ready) && navigator.serviceWorker.controller !== null);
}

test('once opened, the page works without a server, with any of its robots', async () => {
  const { server } = await serveCopy('offline');
  const page = await openWithServiceWorkers();
  await page.goto(address(server));
  await waitUntilStored(page);
  server.closeAllConnections();
  await withTimeout('the server to close', new Promise((resolve) => server.close(resolve)));
  await page.reload();
  await waitUntilStarted(page);
  await page.locator('#robot').selectOption('large');
  await page.waitForFunction(() => window.lizard.file === 'large');
  await advance(page, 3000);
  await page.locator('#gaits button[data-command="walk"]').click();
  await advance(page, 3000);
  assert.ok((await page.evaluate(() => window.lizard.last.place.y)) > 20);
  assert.equal(await page.locator('#problems').isVisible(), false);
});

test('a newer page is offered, loaded as a whole on request, and replaces the older one', async () => {
  const { copyFolder, server } = await serveCopy('newer');
  const page = await openWithServiceWorkers();
  await page.goto(address(server));
  await waitUntilStored(page);
  const readCacheNames = () => page.evaluate(() => window.caches.keys());
  const [firstCache] = await readCacheNames();
  const indexHtml = await readFile(join(copyFolder, 'index.html'), 'utf8');
  assert.ok(indexHtml.includes('>lizard</a>'));
  await writeFile(join(copyFolder, 'index.html'), indexHtml.replace('>lizard</a>', '>lizard, newer</a>'));
  writeServiceWorker(copyFolder);
  await page.reload();
  await waitUntilStarted(page);
  assert.equal(await page.locator('h1').innerText(), 'lizard', 'nothing changes without the user');
  await page.getByRole('button', { name: 'Load it now' }).click();
  await page.locator('h1', { hasText: 'lizard, newer' }).waitFor();
  await waitUntilStarted(page);
  await waitUntil(page, async (firstCache) => !(await window.caches.keys()).includes(firstCache), firstCache);
  assert.equal((await readCacheNames()).length, 1);
});

test('a new page with a missing file is rejected, and the stored one stays in use', async () => {
  const { copyFolder, server, requestedPaths } = await serveCopy('incomplete');
  const page = await openWithServiceWorkers();
  await page.goto(address(server));
  await waitUntilStored(page);
  const previousCaches = await page.evaluate(() => window.caches.keys());
  const indexHtml = await readFile(join(copyFolder, 'index.html'), 'utf8');
  await writeFile(join(copyFolder, 'index.html'), indexHtml.replace('>lizard</a>', '>lizard, newer</a>'));
  writeServiceWorker(copyFolder);
  // A half-finished update of the server: the list is new, the page is not.
  await writeFile(join(copyFolder, 'index.html'), indexHtml);
  requestedPaths.length = 0;
  await page.reload();
  await waitUntilStarted(page);
  await waitUntil(page, async () => {
    const registration = await navigator.serviceWorker.ready;
    return !registration.installing && !registration.waiting;
  });
  for (let ms = 0; ms < TIMEOUT_MS && !requestedPaths.includes('/index.html'); ms += 100) await new Promise((resolve) => setTimeout(resolve, 100));
  assert.ok(requestedPaths.includes('/index.html'), 'the worker has requested the page');
  assert.equal(await page.locator('#fresh').isVisible(), false);
  assert.ok((await page.evaluate(() => window.caches.keys())).includes(previousCaches[0]));
  server.closeAllConnections();
  await page.reload();
  await waitUntilStarted(page);
});

test('the first load is below 500 KB compressed, and nothing is requested from another origin', async () => {
  const requestedPaths = [];
  const { server } = await serveCopy('size', requestedPaths);
  const page = await openBlank();
  const foreignUrls = [];
  page.on('request', (request) => {
    if (!request.url().startsWith(address(server)) && !/^(data|blob):/.test(request.url())) foreignUrls.push(request.url());
  });
  await page.goto(address(server));
  await waitUntilStarted(page);
  await advance(page, 3000);
  await page.waitForFunction(() => document.querySelector('#gaits button[data-command="walk"] small').textContent !== '');
  const paths = [...new Set(requestedPaths)].map((path) => (path === '/' ? '/index.html' : path));
  assert.ok(paths.some((path) => path.endsWith('.wasm')) && paths.some((path) => path.endsWith('.js')), paths.join());
  const sizes = await Promise.all(paths.map(async (path) => [path, gzipSync(await readFile(join(DIST, path))).length]));
  const totalBytes = sizes.reduce((sum, [, size]) => sum + size, 0);
  assert.ok(totalBytes < 500_000, `${totalBytes} bytes: ${sizes.map(([path, size]) => `${path} ${size}`).join(', ')}`);
  assert.deepEqual(foreignUrls, []);
});

test('the browser reported no error or warning', () => assert.deepEqual(complaints, []));
