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
/** Time limit of a wait, ms: long, so that only a hang fails on a busy machine. PATIENCE sets another while a test is written. */
export const PATIENCE = Number(process.env.PATIENCE ?? 300_000);

/** Awaits a promise; fails with the name of the wait if it does not settle in time. */
export function within(what, promise) {
  let timer;
  const late = new Promise((_, fail) => {
    const message = `waited ${PATIENCE / 1000} s for ${what}`;
    timer = setTimeout(() => fail(new Error(message)), PATIENCE);
  });
  return Promise.race([promise, late]).finally(() => clearTimeout(timer));
}

/** Adds time limits to calls that Playwright leaves without one. */
function limit(object, name, methods) {
  for (const method of methods) {
    const unlimited = object[method].bind(object);
    object[method] = (...values) => within(`${name}.${method} of the browser`, unlimited(...values));
  }
}

/** Errors and warnings of all pages so far. */
export const complaints = [];

let browser;
let server;
const pages = [];
/** The servers of single tests. */
const servers = [];

/** The browser's own session of its DevTools protocol. */
export const devTools = () => browser.newBrowserCDPSession();

/** Closes the pages of a test, which would go on walking. */
export async function closePages() {
  await within('the pages to close', Promise.all(pages.splice(0).map((opened) => opened.close())));
  for (const strict of servers.splice(0)) strict.close();
}

/** Starts a web server for a folder's files with some headers, below a path of its own; `asked` lists the paths of the requests. */
export async function serve(folder, asked = [], headers = {}) {
  const made = createServer(async (request, response) => {
    const path = request.url.split('?')[0].replace(FOLDER, '/');
    asked.push(path);
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
  await within('a web server', new Promise((ready) => made.listen(0, '127.0.0.1', ready)));
  return made;
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
      const opened = new Promise((done) => addEventListener('hashchange', done, { once: true }));
      document.querySelector(`a[href="#room=${room.id.replace('room-', '')}"]`).click();
      await opened;
    }
    for (let panel = element.closest('details'); panel; panel = panel.parentElement.closest('details')) {
      const summary = panel.querySelector('summary');
      if (!panel.open && !summary.contains(element)) summary.click();
    }
  });
}

/** Unfolds a panel in its room, unless it is unfolded. */
export async function unfold(opened, panel) {
  await reveal(opened.locator(`${panel} > :not(summary)`).first());
}

/** Opens the room of any element that a test uses, so that tests need not mention rooms. */
function openRooms(opened) {
  const prototype = Object.getPrototypeOf(opened.locator('body'));
  if (prototype.opensRooms) return;
  prototype.opensRooms = true;
  for (const name of ['click', 'fill', 'selectOption', 'tap', 'press', 'focus', 'check', 'uncheck', 'boundingBox', 'screenshot', 'dragTo', 'hover', 'scrollIntoViewIfNeeded']) {
    const plain = prototype[name];
    prototype[name] = async function (...values) {
      await reveal(this);
      return plain.apply(this, values);
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

/** Address of the page. */
export const address = (of = server) => `http://127.0.0.1:${of.address().port}${FOLDER}`;

/**
 * Opens an empty page with reduced motion, so that nothing moves unless a test asks for it. Files come from the server, unless a test
 * asks for service workers.
 */
export async function openBlank(options = {}) {
  const opened = await within('a new page', browser.newPage({ reducedMotion: 'reduce', serviceWorkers: 'block', ...options }));
  pages.push(opened);
  openRooms(opened);
  limit(opened, 'page', ['evaluate', 'addInitScript', 'addScriptTag', 'addStyleTag']);
  limit(opened.clock, 'clock', ['install', 'pauseAt', 'runFor']);
  limit(opened.keyboard, 'keyboard', ['press', 'down', 'up']);
  limit(opened.mouse, 'mouse', ['move', 'down', 'up', 'wheel']);
  opened.setDefaultTimeout(PATIENCE);
  const wait = opened.waitForFunction.bind(opened);
  opened.waitForFunction = (question, ...more) => {
    assert.notEqual(question.constructor.name, 'AsyncFunction', 'a promise passes for a yes here: use until');
    return wait(question, ...more);
  };
  return opened;
}

/** The number of pixels by which the page is wider than its window; 0 if it fits. */
export const overflow = (opened) =>
  opened.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);

/** Returns the text of an element. */
export const text = (opened, selector) => opened.locator(selector).innerText();

/** Waits until a question to the page is answered with true. */
export function until(opened, question, value) {
  const answered = async () => {
    while (!(await opened.evaluate(question, value))) await new Promise((next) => setTimeout(next, 50));
  };
  return within(`${question} in Chromium`, answered());
}

/**
 * Loads the page. `before` runs in it before anything else; the page's timers then run only when the test says so. `at` is the
 * address.
 */
export async function page(options = {}, before = undefined, at = address()) {
  const opened = await openBlank(options);
  opened.on('console', (message) => {
    // Expected: these pages take their files from the server.
    if (message.text() === 'Service Worker registration blocked by Playwright') return;
    // Without a graphics chip the browser warns that its software painter is slow.
    if (message.text().includes('GL Driver Message (OpenGL, Performance')) return;
    // Expected where a test forbids a feature.
    if (message.text().startsWith('Permissions policy violation:')) return;
    if (message.text().startsWith('Web Bluetooth is experimental on this platform')) return;
    if (['error', 'warning'].includes(message.type())) complaints.push(message.text());
  });
  opened.on('pageerror', (error) => complaints.push(error.stack ?? String(error)));
  if (before) {
    // The clock needs an event-loop turn for each timer, and the browser limits nested ones to one in 4 ms.
    await opened.addInitScript(() => {
      const { setTimeout } = window;
      window.setTimeout = (then, ms, ...more) => {
        if (ms) return setTimeout(then, ms, ...more);
        const { port1, port2 } = new MessageChannel();
        port1.onmessage = () => then(...more);
        port2.postMessage(null);
      };
    });
    await opened.clock.install({ time: 0 });
    // Otherwise the clock would also advance by itself, at a pace that depends on the machine, and it has done so since it was
    // installed: it is paused at a time that even a busy machine has not reached.
    await opened.clock.pauseAt(60_000);
    await opened.addInitScript(before);
  }
  await opened.goto(at);
  await opened.waitForFunction(() => window.lizard);
  return opened;
}

/** Opens the page from a server whose policy forbids a browser feature, such as `serial`. */
export async function openForbidden(feature, before) {
  const strict = await serve(DIST, [], { 'permissions-policy': `${feature}=()` });
  servers.push(strict);
  return page({}, before, address(strict));
}

/** Runs the simulation as fast as possible. */
export async function advance(opened, ms) {
  // In parts, so that answers and their consequences come in between.
  await opened.evaluate(async (ms) => {
    for (let left = ms; left > 0; left -= 4) {
      window.lizard.advance(Math.min(4, left));
      await Promise.resolve();
    }
  }, ms);
}

/** Opens the page and waits until its robot stands. */
export async function openStanding(options) {
  const opened = await page(options);
  await advance(opened, 2500);
  return opened;
}

/** Asserts that the robot stays where it was after Esc, except for a hair's width while the servos reach their targets. */
export async function assertStops(opened) {
  const place = () => opened.evaluate(() => window.lizard.last.place);
  await opened.keyboard.press('Escape');
  await advance(opened, 500);
  const stopped = await place();
  await advance(opened, 1000);
  const later = await place();
  for (const key of ['x', 'y']) assert.ok(Math.abs(later[key] - stopped[key]) < 0.05, `${key}: ${stopped[key]} mm, then ${later[key]}`);
}

/** Types a line, waits for a line of the log that begins with `answer`, and returns to the room that was open. */
export async function type(opened, line, answer) {
  const room = await opened.evaluate(() => document.body.dataset.at);
  await opened.getByLabel('A line for the robot').fill(line);
  await opened.getByRole('button', { name: 'Send' }).click();
  await advance(opened, 300);
  const found = opened.locator('#log div', { hasText: answer }).last();
  await found.waitFor();
  const text = await found.innerText();
  await reveal(opened.locator(`#${room} h2`));
  return text;
}
