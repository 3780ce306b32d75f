// The browser of the tests, and a web server that serves the page below a folder, as any server may.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import { extname, join, normalize } from 'node:path';

import { chromium, firefox } from 'playwright-core';

export const DIST = new URL('../dist/', import.meta.url).pathname;
const FOLDER = '/somewhere/below/';
const TYPES = {
  '.html': 'text/html',
  '.js': 'text/javascript',
  '.css': 'text/css',
  '.wasm': 'application/wasm',
  '.json': 'application/json',
  '.svg': 'image/svg+xml',
  '.png': 'image/png',
  '.webmanifest': 'application/manifest+json',
};
/** Debian's Chromium without a window, which opens a page with half the work; the variable CHROMIUM names another. */
const CHROMIUM = { type: chromium, executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium-headless-shell', args: ['--no-sandbox'] };
/**
 * Debian's Firefox, driven by WebDriver BiDi; the variable FIREFOX names another. Emulated media features come from its
 * preferences, because the command that playwright-core 1.65 sends for them needs a newer Firefox.
 */
const FIREFOX = {
  type: firefox,
  channel: 'moz-firefox',
  executablePath: process.env.FIREFOX ?? '/usr/bin/firefox-esr',
  firefoxUserPrefs: { 'ui.prefersReducedMotion': 1 },
};
/**
 * Time limit of a wait, ms: long, so that only a hang fails on a busy machine. PATIENCE sets another while a test is
 * written.
 */
export const PATIENCE = Number(process.env.PATIENCE ?? 300_000);

/** Awaits a promise; fails with the name of the wait if it does not settle in time. */
export function within(waitName, promise) {
  let timer;
  const timeout = new Promise((_, reject) => {
    const message = `waited ${PATIENCE / 1000} s for ${waitName}`;
    timer = setTimeout(() => reject(new Error(message)), PATIENCE);
  });
  return Promise.race([promise, timeout]).finally(() => clearTimeout(timer));
}

/** Adds time limits to calls that Playwright leaves without one. */
function limit(object, name, methods) {
  for (const method of methods) {
    const original = object[method].bind(object);
    object[method] = (...args) => within(`${name}.${method} of the browser`, original(...args));
  }
}

/** Errors and warnings of all pages so far. */
export const complaints = [];

let browser;
let server;
const pages = [];
/** The servers of single tests. */
const servers = [];

/** Opens a session of the browser's DevTools protocol. */
export const devTools = () => browser.newBrowserCDPSession();

/** Closes the pages of a test, which would go on walking. */
export async function closePages() {
  await within('the pages to close', Promise.all(pages.splice(0).map((openedPage) => openedPage.close())));
  for (const strictServer of servers.splice(0)) strictServer.close();
}

/**
 * Starts a web server for a folder's files with some headers, below a path of its own; `requestedPaths` lists the paths
 * of the requests.
 */
export async function serve(folder, requestedPaths = [], headers = {}) {
  const webServer = createServer(async (request, response) => {
    const path = request.url.split('?')[0].replace(FOLDER, '/');
    requestedPaths.push(path);
    for (const [name, value] of Object.entries(headers)) response.setHeader(name, value);
    const file = join(folder, normalize(path === '/' ? '/index.html' : path));
    try {
      const bytes = await readFile(file);
      response.setHeader('content-type', TYPES[extname(file)] ?? 'text/plain');
      response.end(bytes);
    } catch {
      response.statusCode = 404;
      response.end();
    }
  });
  await within('a web server', new Promise((resolve) => webServer.listen(0, '127.0.0.1', resolve)));
  return webServer;
}

async function start({ type, ...options }) {
  server = await serve(DIST);
  browser = await type.launch({ ...options, timeout: PATIENCE });
}

export const open = () => start(CHROMIUM);
/** Opens the browser with Web Bluetooth, which Chromium on Linux hides behind a flag. */
export const openWithBluetooth = () => start({ ...CHROMIUM, args: [...CHROMIUM.args, '--enable-features=WebBluetooth'] });
/** Opens the browser with a film in Y4M as its camera, or without a camera if there is no film. */
export const openWithCamera = (film) => start({ ...CHROMIUM, args: [...CHROMIUM.args, ...(film ? ['--use-fake-device-for-media-stream', '--use-fake-ui-for-media-stream', `--use-file-for-fake-video-capture=${film}`] : [])] });
export const openFirefox = () => start(FIREFOX);

export async function close() {
  if (browser) await within('the browser to close', browser.close());
  server?.close();
}

/** Opens the room and the panels of an element, by the links and headings that a user would press. */
async function reveal(locator) {
  const [element] = await locator.elementHandles();
  await element?.evaluate(async (element) => {
    const room = element.closest('.room');
    if (room?.hidden) {
      const hashChange = new Promise((resolve) => addEventListener('hashchange', resolve, { once: true }));
      document.querySelector(`a[href="#room=${room.id.replace('room-', '')}"]`).click();
      await hashChange;
    }
    for (let panel = element.closest('details'); panel; panel = panel.parentElement.closest('details')) {
      const summary = panel.querySelector('summary');
      if (!panel.open && !summary.contains(element)) summary.click();
    }
  });
}

/** Unfolds a panel in its room, unless it is unfolded. */
export async function unfold(openedPage, panel) {
  await reveal(openedPage.locator(`${panel} > :not(summary)`).first());
}

/** Opens the room of any element that a test uses, so that tests need not mention rooms. */
function openRooms(openedPage) {
  const prototype = Object.getPrototypeOf(openedPage.locator('body'));
  if (prototype.opensRooms) return;
  prototype.opensRooms = true;
  for (const name of ['click', 'fill', 'selectOption', 'tap', 'press', 'focus', 'check', 'uncheck', 'boundingBox', 'screenshot', 'dragTo', 'hover', 'scrollIntoViewIfNeeded']) {
    const original = prototype[name];
    prototype[name] = async function (...args) {
      await reveal(this);
      return original.apply(this, args);
    };
  }
  const { waitFor } = prototype;
  prototype.waitFor = async function (options = {}) {
    if ((options.state ?? 'visible') === 'visible') {
      await waitFor.call(this, { ...options, state: 'attached' });
      await reveal(this);
    }
    return waitFor.call(this, options);
  };
}

/** Returns the address of the page. */
export const address = (target = server) => `http://127.0.0.1:${target.address().port}${FOLDER}`;

/**
 * Opens an empty page with reduced motion, so that nothing moves unless a test asks for it. Files come from the server,
 * unless a test asks for service workers.
 */
export async function openBlank(options = {}) {
  const openedPage = await within('a new page', browser.newPage({ reducedMotion: 'reduce', serviceWorkers: 'block', ...options }));
  pages.push(openedPage);
  openRooms(openedPage);
  limit(openedPage, 'page', ['evaluate', 'addInitScript', 'addScriptTag', 'addStyleTag']);
  limit(openedPage.clock, 'clock', ['install', 'pauseAt', 'runFor']);
  limit(openedPage.keyboard, 'keyboard', ['press', 'down', 'up']);
  limit(openedPage.mouse, 'mouse', ['move', 'down', 'up', 'wheel']);
  openedPage.setDefaultTimeout(PATIENCE);
  const originalWait = openedPage.waitForFunction.bind(openedPage);
  openedPage.waitForFunction = (condition, ...args) => {
    assert.notEqual(condition.constructor.name, 'AsyncFunction', 'a promise passes for a yes here: use until');
    return originalWait(condition, ...args);
  };
  return openedPage;
}

/** Returns the number of pixels by which the page is wider than its window; 0 if it fits. */
export const overflow = (openedPage) =>
  openedPage.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);

/** Returns the text of an element. */
export const text = (openedPage, selector) => openedPage.locator(selector).innerText();

/** Waits until a question to the page is answered with true. */
export function until(openedPage, condition, value) {
  const waitForYes = async () => {
    while (!(await openedPage.evaluate(condition, value))) await new Promise((resolve) => setTimeout(resolve, 50));
  };
  return within(`${condition} in Chromium`, waitForYes());
}

/**
 * Loads the page. `initScript` runs in it before anything else; the page's timers then run only when the test says so.
 * `url` is the address.
 */
export async function page(options = {}, initScript = undefined, url = address()) {
  const openedPage = await openBlank(options);
  openedPage.on('console', (message) => {
    // Expected: these pages take their files from the server.
    if (message.text() === 'Service Worker registration blocked by Playwright') return;
    // Without a graphics chip the browser warns that its software painter is slow.
    if (message.text().includes('GL Driver Message (OpenGL, Performance')) return;
    // Expected where a test forbids a feature.
    if (message.text().startsWith('Permissions policy violation:')) return;
    if (message.text().startsWith('Web Bluetooth is experimental on this platform')) return;
    if (['error', 'warning'].includes(message.type())) complaints.push(message.text());
  });
  openedPage.on('pageerror', (error) => complaints.push(error.stack ?? String(error)));
  if (initScript) {
    // The clock needs an event-loop turn for each timer, and the browser limits nested ones to one in 4 ms.
    await openedPage.addInitScript(() => {
      const { setTimeout } = window;
      window.setTimeout = (callback, ms, ...args) => {
        if (ms) return setTimeout(callback, ms, ...args);
        const { port1, port2 } = new MessageChannel();
        port1.onmessage = () => callback(...args);
        port2.postMessage(null);
      };
    });
    await openedPage.clock.install({ time: 0 });
    // Otherwise the clock would also advance by itself, at a pace that depends on the machine, and it has done so since
    // it was installed: it is paused at a time that even a busy machine has not reached.
    await openedPage.clock.pauseAt(60_000);
    await openedPage.addInitScript(initScript);
  }
  await openedPage.goto(url);
  await openedPage.waitForFunction(() => window.lizard);
  return openedPage;
}

/** Opens the page from a server whose policy forbids a browser feature, such as `serial`. */
export async function openForbidden(feature, initScript) {
  const strictServer = await serve(DIST, [], { 'permissions-policy': `${feature}=()` });
  servers.push(strictServer);
  return page({}, initScript, address(strictServer));
}

/** Runs the simulation as fast as possible. */
export async function advance(openedPage, ms) {
  // In short steps, so that answers and their consequences come in between.
  await openedPage.evaluate(async (ms) => {
    for (let remainingMs = ms; remainingMs > 0; remainingMs -= 4) {
      window.lizard.advance(Math.min(4, remainingMs));
      await Promise.resolve();
    }
  }, ms);
}

/** Opens the page and waits until its robot stands. */
export async function openStanding(options) {
  const openedPage = await page(options);
  await advance(openedPage, 2500);
  return openedPage;
}

/**
 * Asserts that the robot stays where it was after Esc, except for a hair's width while the servos reach their targets.
 */
export async function assertStops(openedPage) {
  const readPlace = () => openedPage.evaluate(() => window.lizard.last.place);
  await openedPage.keyboard.press('Escape');
  await advance(openedPage, 500);
  const stopPlace = await readPlace();
  await advance(openedPage, 1000);
  const laterPlace = await readPlace();
  for (const key of ['x', 'y']) assert.ok(Math.abs(laterPlace[key] - stopPlace[key]) < 0.05, `${key}: ${stopPlace[key]} mm, then ${laterPlace[key]}`);
}

/** Types a line, waits for a line of the log that begins with `answer`, and returns to the room that was open. */
export async function type(openedPage, line, answer) {
  const room = await openedPage.evaluate(() => document.body.dataset.at);
  await openedPage.getByLabel('A line for the robot').fill(line);
  await openedPage.getByRole('button', { name: 'Send' }).click();
  await advance(openedPage, 300);
  const logLine = openedPage.locator('#log div', { hasText: answer }).last();
  await logLine.waitFor();
  const lineText = await logLine.innerText();
  await reveal(openedPage.locator(`#${room} h2`));
  return lineText;
}
