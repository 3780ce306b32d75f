// A browser, and the page as any web server would serve it, below a folder of its own.
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
/** Debian's; CHROMIUM and FIREFOX name others. */
const CHROMIUM = { type: chromium, executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args: ['--no-sandbox'] };
/**
 * By WebDriver BiDi, which Debian's Firefox speaks itself. playwright-core 1.65 asks it for emulated media features, which only a
 * newer Firefox has; this one takes them from its preferences.
 */
const FIREFOX = {
  type: firefox,
  channel: 'moz-firefox',
  executablePath: process.env.FIREFOX ?? '/usr/bin/firefox-esr',
  firefoxUserPrefs: { 'ui.prefersReducedMotion': 1 },
};
/** A machine may be busy: only what hangs is to fail by time. PATIENCE names another one, ms, for who writes a test. */
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

/** Playwright gives these no limit of their own. */
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
export async function tidy() {
  await within('the pages to close', Promise.all(pages.splice(0).map((opened) => opened.close())));
  for (const strict of servers.splice(0)) strict.close();
}

/** A web server with a folder's files and these headers, below a path of its own; `asked` has the path of each request. */
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
/** With Web Bluetooth, which Chromium on Linux has behind a flag. */
export const openWithBluetooth = () => start({ ...CHROMIUM, args: [...CHROMIUM.args, '--enable-features=WebBluetooth'] });
/** With a film in Y4M as its camera; without one it has no camera. */
export const openWithCamera = (film) => start({ ...CHROMIUM, args: [...CHROMIUM.args, ...(film ? ['--use-fake-device-for-media-stream', '--use-fake-ui-for-media-stream', `--use-file-for-fake-video-capture=${film}`] : [])] });
export const openFirefox = () => start(FIREFOX);

export async function close() {
  if (browser) await within('the browser to close', browser.close());
  server?.close();
}

/** Opens the room of an element, and the panels around it, by the links and headings that a person would press. */
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

/** Unfolds a panel in its room, unless that is done. */
export async function unfold(opened, panel) {
  await reveal(opened.locator(`${panel} > :not(summary)`).first());
}

/** Whatever a test uses is in one of the rooms: the test is about the thing, and its room is opened for it. */
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
 * A page of the browser with nothing in it yet. It is to move only when a test says so, and has its files from the server
 * unless a test asks for service workers.
 */
export async function blank(options = {}) {
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

/** By how many pixels the page is wider than its window, 0 if it fits. */
export const sideways = (opened) =>
  opened.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);

/** Until the page answers a question with yes, which may take it a while. */
export function until(opened, question, value) {
  const answered = async () => {
    while (!(await opened.evaluate(question, value))) await new Promise((next) => setTimeout(next, 50));
  };
  return within(`${question} in Chromium`, answered());
}

/**
 * The page, loaded; `before` runs in it before anything else, and then its timers only run when
 * the test says so. `at` is its address.
 */
export async function page(options = {}, before = undefined, at = address()) {
  const opened = await blank(options);
  opened.on('console', (message) => {
    // Said of the pages that are to have their files from the server.
    if (message.text() === 'Service Worker registration blocked by Playwright') return;
    // Without a graphics chip the browser's own painter says of itself that it is slow.
    if (message.text().includes('GL Driver Message (OpenGL, Performance')) return;
    // What a test forbids.
    if (message.text().startsWith('Permissions policy violation:')) return;
    if (message.text().startsWith('Web Bluetooth is experimental on this platform')) return;
    if (['error', 'warning'].includes(message.type())) complaints.push(message.text());
  });
  opened.on('pageerror', (error) => complaints.push(error.stack ?? String(error)));
  if (before) {
    // The clock takes a turn of the browser for each timer, and a chain of turns is slowed to one in 4 ms.
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
    // Else it would also go on by itself, and how far would depend on the machine.
    await opened.clock.pauseAt(1000);
    await opened.addInitScript(before);
  }
  await opened.goto(at);
  await opened.waitForFunction(() => window.lizard);
  return opened;
}

/** The page from a server that forbids it one of the browser's features, such as `serial`: the browser itself refuses it. */
export async function forbidden(feature, before) {
  const strict = await serve(DIST, [], { 'permissions-policy': `${feature}=()` });
  servers.push(strict);
  return page({}, before, address(strict));
}

/** Lets the simulation run, as fast as it goes. */
export async function advance(opened, ms) {
  // In parts, so that answers and what follows from them come in between.
  await opened.evaluate(async (ms) => {
    for (let left = ms; left > 0; left -= 4) {
      window.lizard.advance(Math.min(4, left));
      await Promise.resolve();
    }
  }, ms);
}

/** The page with a robot that has woken and stands. */
export async function standing(options) {
  const opened = await page(options);
  await advance(opened, 2500);
  return opened;
}

/** After Esc: the robot stays where it stands, but for the last way of its servos to their targets, a hair's width. */
export async function stops(opened) {
  const place = () => opened.evaluate(() => window.lizard.last.place);
  await opened.keyboard.press('Escape');
  await advance(opened, 500);
  const stopped = await place();
  await advance(opened, 1000);
  const later = await place();
  for (const key of ['x', 'y']) assert.ok(Math.abs(later[key] - stopped[key]) < 0.05, `${key}: ${stopped[key]} mm, then ${later[key]}`);
}

/** Types a line and waits for a line of the log that begins so; the room that was open is open again afterwards. */
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
