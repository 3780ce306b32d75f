// The browser of the tests, and a web server that serves the page from a subfolder.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import { extname, join, normalize } from 'node:path';
import { after, afterEach, before, test } from 'node:test';
import { setTimeout as sleep } from 'node:timers/promises';

import { chromium, firefox } from 'playwright-core';

export const DIST = new URL('../dist/', import.meta.url).pathname;
const BASE_PATH = '/somewhere/below/';
const CONTENT_TYPES = {
  '.html': 'text/html',
  '.js': 'text/javascript',
  '.css': 'text/css',
  '.wasm': 'application/wasm',
  '.json': 'application/json',
  '.svg': 'image/svg+xml',
  '.png': 'image/png',
  '.webmanifest': 'application/manifest+json',
};
/** Debian's headless Chromium, which opens pages faster than Chromium. The variable CHROMIUM names another browser. */
const CHROMIUM = { type: chromium, executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium-headless-shell', args: ['--no-sandbox'] };
/**
 * Debian's Firefox, driven by WebDriver BiDi. The environment variable FIREFOX names another. A preference sets reduced
 * motion. playwright-core stays at 1.64, because 1.65 sets media features by a command that needs a newer Firefox.
 */
const FIREFOX = {
  type: firefox,
  channel: 'moz-firefox',
  executablePath: process.env.FIREFOX ?? '/usr/bin/firefox-esr',
  firefoxUserPrefs: { 'ui.prefersReducedMotion': 1 },
};
/**
 * Time limit of a wait: long, so that only a hang fails on a busy machine. The environment variable PATIENCE sets
 * another, in ms, which is useful while writing a test.
 */
export const TIMEOUT_MS = Number(process.env.PATIENCE ?? 300_000);

/** Awaits a promise; rejects with the name of the wait if the promise does not settle in time. */
export function withTimeout(awaitedEvent, promise) {
  let timer;
  const timeout = new Promise((_, reject) => {
    const message = `timed out after ${TIMEOUT_MS / 1000} s while waiting for this: ${awaitedEvent}`;
    timer = setTimeout(() => reject(new Error(message)), TIMEOUT_MS);
  });
  return Promise.race([promise, timeout]).finally(() => clearTimeout(timer));
}

/**
 * Repeats `step` until `condition` returns true. The limit applies to real time and not to the number of steps, because
 * a step may be slow on a busy machine.
 */
export async function repeatUntil(awaitedEvent, condition, step) {
  let isWaiting = true;
  const repeat = async () => {
    while (isWaiting && !(await condition())) await step();
  };
  await withTimeout(awaitedEvent, repeat()).finally(() => (isWaiting = false));
}

/** Adds a time limit to methods that have none in Playwright. */
function addTimeouts(object, name, methods) {
  for (const method of methods) {
    const original = object[method].bind(object);
    object[method] = (...args) => withTimeout(`${name}.${method} of the browser`, original(...args));
  }
}

/** A phone that is held upright. */
export const PHONE = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };
/** A phone that is held sideways. */
export const LANDSCAPE = { viewport: { width: 844, height: 390 }, hasTouch: true, isMobile: true };

/** Errors and warnings of the current test's pages. */
export const browserErrors = [];

let browser;
let server;
const pages = [];
/** The servers of single tests. */
const testServers = [];

export const openDevTools = () => browser.newBrowserCDPSession();

/**
 * Closes the pages of a test; otherwise their robots would continue to walk. Asserts that the browser has reported no
 * error or warning.
 */
export async function closePages() {
  await withTimeout('the pages to close', Promise.all(pages.splice(0).map((page) => page.close())));
  await Promise.all(testServers.splice(0).map(stopServer));
  assert.deepEqual(browserErrors.splice(0), []);
}

/** Drops the errors and warnings that a test expects. */
export function dropBrowserErrors(pattern) {
  browserErrors.splice(0, browserErrors.length, ...browserErrors.filter((browserError) => !pattern.test(browserError)));
}

/**
 * Starts a web server for a folder's files at BASE_PATH, with additional headers. Appends the paths of the requests to
 * `requestedPaths`.
 */
async function serve(folder, requestedPaths = [], headers = {}) {
  const webServer = createServer(async (request, response) => {
    const path = request.url.split('?')[0].replace(BASE_PATH, '/');
    requestedPaths.push(path);
    for (const [name, value] of Object.entries(headers)) response.setHeader(name, value);
    // Redirects, as some servers do.
    if (path === '/index.html') return void response.writeHead(301, { location: './' }).end();
    const file = join(folder, normalize(path === '/' ? '/index.html' : path));
    try {
      const bytes = await readFile(file);
      response.setHeader('content-type', CONTENT_TYPES[extname(file)] ?? 'text/plain');
      response.end(bytes);
    } catch {
      response.writeHead(404).end();
    }
  });
  await withTimeout('a web server', new Promise((resolve) => webServer.listen(0, '127.0.0.1', resolve)));
  return webServer;
}

/** Starts a web server that is stopped after the test. */
export async function serveInTest(...args) {
  const webServer = await serve(...args);
  testServers.push(webServer);
  return webServer;
}

export async function stopServer(webServer) {
  webServer.closeAllConnections();
  await withTimeout('the server to close', new Promise((resolve) => webServer.close(resolve)));
}

async function startBrowser({ type, ...options }) {
  server = await serve(DIST);
  browser = await type.launch({ ...options, timeout: TIMEOUT_MS });
}

export const openBrowser = () => startBrowser(CHROMIUM);
/** Opens the browser with Web Bluetooth, which Chromium on Linux hides behind a flag. */
export const openBrowserWithBluetooth = () => startBrowser({ ...CHROMIUM, args: [...CHROMIUM.args, '--enable-features=WebBluetooth'] });
/** Opens the browser with a Y4M video as its camera, or without a camera if there is no video. */
export const openBrowserWithCamera = (video) => startBrowser({ ...CHROMIUM, args: [...CHROMIUM.args, ...(video ? ['--use-fake-device-for-media-stream', '--use-fake-ui-for-media-stream', `--use-file-for-fake-video-capture=${video}`] : [])] });
export const openFirefox = () => startBrowser(FIREFOX);

export async function closeBrowser() {
  if (browser) await withTimeout('the browser to close', browser.close());
  server?.close();
}

/** Opens a browser for the tests of a file, and closes each test's pages after it. */
export function useBrowser(open = openBrowser) {
  before(open);
  afterEach(closePages);
  after(closeBrowser);
}

/** Defines a test of the page that `open` opens; `check` gets what `open` returns, and the test's context. */
export const testPage = (name, open, check) => test(name, async (context) => check(await open(), context));

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

/** Opens the room of a panel and unfolds the panel. */
export async function unfold(page, panel) {
  await reveal(page.locator(`${panel} > :not(summary)`).first());
}

/** Makes Playwright open the room of each element that a test uses, so that tests need not mention rooms. */
function openRoomsOnUse(page) {
  const prototype = Object.getPrototypeOf(page.locator('body'));
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

export const address = (webServer = server) => `http://127.0.0.1:${webServer.address().port}${BASE_PATH}`;

/**
 * Opens an empty page with reduced motion, so that nothing moves unless a test starts it. Files come from the server,
 * unless a test allows service workers.
 */
export async function openBlankPage(options = {}) {
  const page = await withTimeout('a new page', browser.newPage({ reducedMotion: 'reduce', serviceWorkers: 'block', ...options }));
  pages.push(page);
  openRoomsOnUse(page);
  addTimeouts(page, 'page', ['evaluate', 'addInitScript', 'addScriptTag', 'addStyleTag']);
  addTimeouts(page.clock, 'clock', ['install', 'pauseAt', 'runFor']);
  addTimeouts(page.keyboard, 'keyboard', ['press', 'down', 'up']);
  addTimeouts(page.mouse, 'mouse', ['move', 'down', 'up', 'wheel']);
  page.setDefaultTimeout(TIMEOUT_MS);
  const originalWait = page.waitForFunction.bind(page);
  page.waitForFunction = (condition, ...args) => {
    assert.notEqual(condition.constructor.name, 'AsyncFunction', 'waitForFunction does not await: use waitUntil');
    return originalWait(condition, ...args);
  };
  return page;
}

/** Returns the number of pixels by which the page is wider than its window; 0 if it fits. */
export const measureOverflow = (page) =>
  page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);

/** Returns an element's box in the window, CSS pixels. */
export const readBox = (page, selector) => page.evaluate((selector) => document.querySelector(selector).getBoundingClientRect().toJSON(), selector);

export async function chooseRobot(page, name) {
  await page.locator('#robot').selectOption(name);
  await page.waitForFunction((name) => window.lizard?.robot.file === name, name);
}

/** Returns a length of the robot, mm. */
export const readLength = (page, key) => page.evaluate((key) => window.lizard.robot.description.lengths.find((length) => length.key === key).value, key);

/** Waits until a length of the robot has a value. */
export const waitForLength = (page, key, mm) =>
  page.waitForFunction(([key, mm]) => window.lizard.robot.description.lengths.find((length) => length.key === key).value === mm, [key, mm]);

/** Types a length into its box and presses Enter. */
export async function typeLength(page, key, mm) {
  const box = page.locator(`#lengths input[name="${key}"]`);
  await box.fill(String(mm));
  await box.press('Enter');
  return box;
}

/** Presses a button that saves a file, and returns the file's name and bytes. */
export async function download(page, button) {
  const [file] = await Promise.all([page.waitForEvent('download'), button.click()]);
  return { name: file.suggestedFilename(), bytes: await readFile(await file.path()) };
}

/** Opens the page of a server, and waits until its service worker has stored it and answers its requests. */
export async function openStored(webServer) {
  const page = await openBlankPage({ serviceWorkers: 'allow' });
  await page.goto(address(webServer));
  await waitUntil(page, async () => (await navigator.serviceWorker.ready) && navigator.serviceWorker.controller !== null);
  return page;
}

/** Makes the document report that its tab is hidden. */
export const hidePage = (page) =>
  page.evaluate(() => {
    Object.defineProperty(document, 'hidden', { value: true });
    document.dispatchEvent(new Event('visibilitychange'));
  });

export const readText = (page, selector) => page.locator(selector).innerText();

/** Returns the text of the page's robot. */
export const readToml = (page) => page.evaluate(() => window.lizard.robot.toml);
/** Returns the robot's running gait, or its last command. */
export const readGait = (page) => page.evaluate(() => window.lizard.board.gait);
export const waitForGait = (page, gait) => page.waitForFunction((gait) => window.lizard.board.gait === gait, gait);
/** Returns the place of the robot on the floor: `x` and `y` in mm, `heading` in deg. */
export const readPlace = (page) => page.evaluate(() => window.lizard.robot.last.place);
export const findGaitButton = (page, command) => page.locator(`#gaits button[data-command="${command}"]`);

/** Returns the page's prediction for a gait, and the body's displacement in the last cycle. */
export const readDisplacements = (page, name) =>
  page.evaluate((name) => {
    const { robot } = window.lizard;
    const index = robot.description.gaits.findIndex(({ command }) => command === name);
    return { predicted: robot.wasm.predict(index), measured: robot.measureCycle() };
  }, name);

/** Waits until the gait editor shows the prediction of its gait. */
export const waitForPrediction = (page) => page.waitForFunction(() => /mm$|may drift/.test(document.querySelector('#gait-distance').textContent));

/** Presses the mouse at a point, and moves it to another point without releasing it. */
export async function startDrag(page, from, to, stepCount = 1) {
  await page.mouse.move(...from);
  await page.mouse.down();
  await page.mouse.move(...to, { steps: stepCount });
}

/** Waits until a function in the page returns true, or a promise of true. */
export function waitUntil(page, condition, value) {
  return repeatUntil(`${condition} in the page`, () => page.evaluate(condition, value), () => sleep(50));
}

/**
 * Loads the page from `url`. An `initScript` runs in the page before any other script, and the page's clock then runs
 * only when the test advances it.
 */
export async function openPage(options = {}, initScript = undefined, url = address()) {
  const page = await openBlankPage(options);
  page.on('console', (message) => {
    // Expected: these pages load their files from the server.
    if (message.text() === 'Service Worker registration blocked by Playwright') return;
    // Without a graphics chip the browser warns that software rendering is slow.
    if (message.text().includes('GL Driver Message (OpenGL, Performance')) return;
    // Expected where a test forbids a feature.
    if (message.text().startsWith('Permissions policy violation:')) return;
    if (message.text().startsWith('Web Bluetooth is experimental on this platform')) return;
    if (['error', 'warning'].includes(message.type())) browserErrors.push(message.text());
  });
  page.on('pageerror', (error) => browserErrors.push(error.stack ?? String(error)));
  if (initScript) {
    // The clock needs an event-loop turn for each timer, and the browser runs nested timers only every 4 ms.
    await page.addInitScript(() => {
      const { setTimeout } = window;
      window.setTimeout = (callback, ms, ...args) => {
        if (ms) return setTimeout(callback, ms, ...args);
        const { port1, port2 } = new MessageChannel();
        port1.onmessage = () => callback(...args);
        port2.postMessage(null);
      };
    });
    await page.clock.install({ time: 0 });
    // Without a pause the clock would also advance by itself. It has run since it was installed, so it is paused at a
    // time that even a busy machine has not reached.
    await page.clock.pauseAt(60_000);
    await page.addInitScript(initScript);
  }
  await page.goto(url);
  await page.waitForFunction(() => window.lizard);
  return page;
}

/** Opens the page from a server whose policy forbids a browser feature, such as `serial`. */
export async function openForbidden(feature, initScript) {
  const strictServer = await serveInTest(DIST, [], { 'permissions-policy': `${feature}=()` });
  return openPage({}, initScript, address(strictServer));
}

/** Advances the simulation by some ms, as fast as possible. */
export async function advance(page, ms) {
  // In short steps, so that the page handles each answer before the next step.
  await page.evaluate(async (ms) => {
    for (let remainingMs = ms; remainingMs > 0; remainingMs -= 4) {
      window.lizard.advance(Math.min(4, remainingMs));
      await Promise.resolve();
    }
  }, ms);
}

/** Presses an element, and advances the simulation by some ms. */
export async function clickAndAdvance(page, selector, ms) {
  await page.locator(selector).click();
  await advance(page, ms);
}

/** Opens the page and waits until its robot stands. */
export async function openStanding(options) {
  const page = await openPage(options);
  await advance(page, 2500);
  return page;
}

/** Opens the page, waits until its robot stands, and unfolds a panel. */
export async function openUnfolded(panel, options) {
  const page = await openStanding(options);
  await unfold(page, panel);
  return page;
}

/** Waits until the robot has a new gait, whose table in robot.toml is given, and walks with it. */
export async function waitForNewGait(page, name, table) {
  await page.waitForFunction((table) => window.lizard.robot.toml.includes(table), table);
  await advance(page, 3000);
  await waitForGait(page, name);
}

/** Loads the page again, and waits until it has started. */
export async function reload(page) {
  await page.reload();
  await page.waitForFunction(() => window.lizard);
}

/** Presses Esc, and asserts that the robot then does not move by more than 0.05 mm. */
export async function assertStops(page) {
  await page.keyboard.press('Escape');
  await advance(page, 500);
  const stopPlace = await readPlace(page);
  await advance(page, 1000);
  const laterPlace = await readPlace(page);
  for (const key of ['x', 'y']) assert.ok(Math.abs(laterPlace[key] - stopPlace[key]) < 0.05, `${key}: ${stopPlace[key]} mm, then ${laterPlace[key]}`);
}

/**
 * Sends a line to the robot, waits for a line of the log that has `answer`, and returns that line. The open room stays
 * open.
 */
export async function sendLine(page, line, answer) {
  const room = await page.evaluate(() => document.body.dataset.at);
  await page.getByLabel('A line for the robot').fill(line);
  await page.getByRole('button', { name: 'Send' }).click();
  await advance(page, 300);
  const logLine = page.locator('#log div', { hasText: answer }).last();
  await logLine.waitFor();
  const lineText = await logLine.innerText();
  await reveal(page.locator(`#${room} h2`));
  return lineText;
}
