// A page that was opened once works without a network, is updated as a whole, and contacts no other server.
import assert from 'node:assert/strict';
import { cp, mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, afterEach, before, test } from 'node:test';
import { gzipSync } from 'node:zlib';

import { writeServiceWorker } from '../offline.js';
import { DIST, PATIENCE, address, advance, openBlank, close, complaints, open, serve, closePages, until, within } from './browser.js';

let folder;
const servers = [];

before(async () => {
  await open();
  folder = await mkdtemp(join(tmpdir(), 'lizard-page-'));
});
afterEach(async () => {
  await closePages();
  for (const each of servers.splice(0)) {
    each.closeAllConnections();
    each.close();
  }
});
after(async () => {
  await close();
  if (folder) await rm(folder, { recursive: true });
});

/** Serves a copy of the page on a server of its own. */
async function serveCopy(name, asked = []) {
  const own = join(folder, name);
  await cp(DIST, own, { recursive: true });
  const server = await serve(own, asked);
  servers.push(server);
  return { own, server, asked };
}

const openWithWorkers = () => openBlank({ serviceWorkers: 'allow' });
const waitUntilStarted = (opened) => opened.waitForFunction(() => window.lizard);

/** Waits until the service worker has stored the page and answers its requests. */
async function waitUntilStored(opened) {
  await waitUntilStarted(opened);
  await until(opened, async () => (await navigator.serviceWorker.ready) && navigator.serviceWorker.controller !== null);
}

test('once opened, the page walks without a server, with any of its robots', async () => {
  const { server } = await serveCopy('offline');
  const opened = await openWithWorkers();
  await opened.goto(address(server));
  await waitUntilStored(opened);
  server.closeAllConnections();
  await within('the server to close', new Promise((closed) => server.close(closed)));
  await opened.reload();
  await waitUntilStarted(opened);
  await opened.locator('#robot').selectOption('large');
  await opened.waitForFunction(() => window.lizard.file === 'large');
  await advance(opened, 3000);
  await opened.locator('#gaits button[data-command="walk"]').click();
  await advance(opened, 3000);
  assert.ok((await opened.evaluate(() => window.lizard.last.place.y)) > 20);
  assert.equal(await opened.locator('#trouble').isVisible(), false);
});

test('a newer page is offered, loaded as a whole on request, and replaces the older one', async () => {
  const { own, server } = await serveCopy('newer');
  const opened = await openWithWorkers();
  await opened.goto(address(server));
  await waitUntilStored(opened);
  const caches = () => opened.evaluate(() => window.caches.keys());
  const [first] = await caches();
  const page = await readFile(join(own, 'index.html'), 'utf8');
  assert.ok(page.includes('>lizard</a>'));
  await writeFile(join(own, 'index.html'), page.replace('>lizard</a>', '>lizard, newer</a>'));
  writeServiceWorker(own);
  await opened.reload();
  await waitUntilStarted(opened);
  assert.equal(await opened.locator('h1').innerText(), 'lizard', 'nothing changes under a person');
  await opened.getByRole('button', { name: 'Load it now' }).click();
  await opened.locator('h1', { hasText: 'lizard, newer' }).waitFor();
  await waitUntilStarted(opened);
  await until(opened, async (first) => !(await window.caches.keys()).includes(first), first);
  assert.equal((await caches()).length, 1);
});

test('a new page with a missing file is rejected, and the stored one stays in use', async () => {
  const { own, server, asked } = await serveCopy('torn');
  const opened = await openWithWorkers();
  await opened.goto(address(server));
  await waitUntilStored(opened);
  const before = await opened.evaluate(() => window.caches.keys());
  const page = await readFile(join(own, 'index.html'), 'utf8');
  await writeFile(join(own, 'index.html'), page.replace('>lizard</a>', '>lizard, newer</a>'));
  writeServiceWorker(own);
  // A half-finished update of the server: the list is new, the page is not.
  await writeFile(join(own, 'index.html'), page);
  asked.length = 0;
  await opened.reload();
  await waitUntilStarted(opened);
  await until(opened, async () => {
    const registration = await navigator.serviceWorker.ready;
    return !registration.installing && !registration.waiting;
  });
  for (let ms = 0; ms < PATIENCE && !asked.includes('/index.html'); ms += 100) await new Promise((next) => setTimeout(next, 100));
  assert.ok(asked.includes('/index.html'), 'it was asked for');
  assert.equal(await opened.locator('#fresh').isVisible(), false);
  assert.ok((await opened.evaluate(() => window.caches.keys())).includes(before[0]));
  server.closeAllConnections();
  await opened.reload();
  await waitUntilStarted(opened);
});

test('the first load is below 500 KB compressed, and nothing is asked of another origin', async () => {
  const asked = [];
  const { server } = await serveCopy('size', asked);
  const opened = await openBlank();
  const strangers = [];
  opened.on('request', (request) => {
    if (!request.url().startsWith(address(server)) && !/^(data|blob):/.test(request.url())) strangers.push(request.url());
  });
  await opened.goto(address(server));
  await waitUntilStarted(opened);
  await advance(opened, 3000);
  await opened.waitForFunction(() => document.querySelector('#gaits button[data-command="walk"] small').textContent !== '');
  const paths = [...new Set(asked)].map((path) => (path === '/' ? '/index.html' : path));
  assert.ok(paths.some((path) => path.endsWith('.wasm')) && paths.some((path) => path.endsWith('.js')), paths.join());
  const sizes = await Promise.all(paths.map(async (path) => [path, gzipSync(await readFile(join(DIST, path))).length]));
  const all = sizes.reduce((sum, [, size]) => sum + size, 0);
  assert.ok(all < 500_000, `${all} bytes: ${sizes.map(([path, size]) => `${path} ${size}`).join(', ')}`);
  assert.deepEqual(strangers, []);
});

test('the browser reported no error or warning', () => assert.deepEqual(complaints, []));
