// A page that was opened once works without a network, is updated completely or not at all, and contacts no other
// server.
import assert from 'node:assert/strict';
import { cp, readFile, writeFile } from 'node:fs/promises';
import { join } from 'node:path';
import { test } from 'node:test';
import { gzipSync } from 'node:zlib';

import { writeServiceWorker } from '../offline.js';
import { DIST, address, advance, openBlankPage, reload, waitUntil, repeatUntil, serveInTest, stopServer, useBrowser, chooseRobot, openStored, clickAndAdvance } from './browser.js';
import { makeFolder } from './temporary-folder.js';

useBrowser();

/** Starts a web server for a copy of the page. */
async function serveCopy() {
  const copyFolder = await makeFolder();
  await cp(DIST, copyFolder, { recursive: true });
  const requestedPaths = [];
  return { copyFolder, server: await serveInTest(copyFolder, requestedPaths), requestedPaths };
}

const waitUntilStarted = (page) => page.waitForFunction(() => window.lizard);

/** Changes a copy to a newer version of the page, with another heading. Returns the older version's index.html. */
async function makeNewer(copyFolder) {
  const indexHtml = await readFile(join(copyFolder, 'index.html'), 'utf8');
  assert.ok(indexHtml.includes('>lizard</a>'));
  await writeFile(join(copyFolder, 'index.html'), indexHtml.replace('>lizard</a>', '>lizard, newer</a>'));
  writeServiceWorker(copyFolder);
  return indexHtml;
}

test('the page works without a server, with any of its robots, once it was opened', async () => {
  const { server } = await serveCopy();
  const page = await openStored(server);
  const licenceAddress = `${address(server)}licence-mit.txt`;
  await stopServer(server);
  await reload(page);
  await chooseRobot(page, 'large');
  await advance(page, 3000);
  await clickAndAdvance(page, '#gaits button[data-command="walk"]', 3000);
  assert.ok((await page.evaluate(() => window.lizard.robot.last.place.y)) > 20);
  assert.equal(await page.locator('#problems').isVisible(), false);
  await page.goto(licenceAddress);
  assert.match(await page.locator('body').innerText(), /^MIT License/);
});

test('a newer page replaces all files of the older page, but only on request', async () => {
  const { copyFolder, server } = await serveCopy();
  const page = await openStored(server);
  const readCacheNames = () => page.evaluate(() => window.caches.keys());
  const [firstCache] = await readCacheNames();
  await makeNewer(copyFolder);
  await reload(page);
  assert.equal(await page.locator('h1').innerText(), 'lizard', 'nothing changes without the user');
  await page.getByRole('button', { name: 'Load it now' }).click();
  await page.locator('h1', { hasText: 'lizard, newer' }).waitFor();
  await waitUntilStarted(page);
  await waitUntil(page, async (firstCache) => !(await window.caches.keys()).includes(firstCache), firstCache);
  assert.equal((await readCacheNames()).length, 1);
});

test('an older page that stays open can load the newer page after another page has loaded it', async () => {
  const { copyFolder, server } = await serveCopy();
  const page = await openStored(server);
  const [olderPage] = await Promise.all([page.waitForEvent('popup'), page.evaluate((address) => void window.open(address), address(server))]);
  await waitUntilStarted(olderPage);
  await makeNewer(copyFolder);
  await reload(page);
  for (const openPage of [page, olderPage]) {
    await openPage.getByRole('button', { name: 'Load it now' }).click();
    await openPage.locator('h1', { hasText: 'lizard, newer' }).waitFor();
  }
});

test('an incomplete newer page is rejected, and the stored page stays in use', async () => {
  const { copyFolder, server, requestedPaths } = await serveCopy();
  const page = await openStored(server);
  const previousCaches = await page.evaluate(() => window.caches.keys());
  const indexHtml = await makeNewer(copyFolder);
  // The server is updated by half: its list of files is new, but index.html is old.
  await writeFile(join(copyFolder, 'index.html'), indexHtml);
  requestedPaths.length = 0;
  await reload(page);
  await waitUntil(page, async () => {
    const registration = await navigator.serviceWorker.ready;
    return !registration.installing && !registration.waiting;
  });
  await repeatUntil('the worker requests the page', async () => requestedPaths.includes('/index.html'), () => page.waitForTimeout(100));
  assert.equal(await page.locator('#fresh').isVisible(), false);
  assert.ok((await page.evaluate(() => window.caches.keys())).includes(previousCaches[0]));
  server.closeAllConnections();
  await reload(page);
});

test('the first load is below 500 KB compressed, and nothing is requested from another origin', async () => {
  const { server, requestedPaths } = await serveCopy();
  const page = await openBlankPage();
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
