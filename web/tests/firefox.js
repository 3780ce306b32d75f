// Debian's Firefox, by WebDriver BiDi, which it speaks itself: playwright-core asks it for what only newer ones know.
import { spawn } from 'node:child_process';
import { mkdtemp, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

import WebSocket from 'ws';

import { within } from './browser.js';

/** Debian's; FIREFOX names another. */
const FIREFOX = process.env.FIREFOX ?? '/usr/bin/firefox-esr';
/** The page is to move only when a test says so; nothing is asked of Mozilla. */
const PREFERENCES = {
  'ui.prefersReducedMotion': 1,
  'app.update.enabled': false,
  'datareporting.policy.dataSubmissionEnabled': false,
  'browser.shell.checkDefaultBrowser': false,
  'network.captive-portal-service.enabled': false,
  'network.connectivity-service.enabled': false,
};

/** What BiDi calls a value, as a value. */
function plain({ type, value }) {
  if (type === 'array') return value.map(plain);
  if (type === 'object') return Object.fromEntries(value.map(([key, each]) => [key, plain(each)]));
  return type === 'null' || type === 'undefined' ? null : value;
}

export class Firefox {
  /** What its console has complained of. */
  complaints = [];
  #process;
  #profile;
  #socket;
  #page;
  #last = 0;
  #waiting = new Map();

  /** Starts it with a profile of its own. */
  static async start() {
    const made = new Firefox();
    made.#profile = await mkdtemp(join(tmpdir(), 'lizard-firefox-'));
    const lines = Object.entries(PREFERENCES).map(([key, value]) => `user_pref(${JSON.stringify(key)}, ${JSON.stringify(value)});`);
    await writeFile(join(made.#profile, 'user.js'), lines.join('\n'));
    const args = ['--headless', '--remote-debugging-port=0', '--profile', made.#profile, '--no-remote'];
    made.#process = spawn(FIREFOX, args, { stdio: ['ignore', 'ignore', 'pipe'], env: { ...process.env, HOME: made.#profile } });
    // A test that is ended by its time limit leaves none of it running.
    process.once('exit', () => made.#process.kill('SIGKILL'));
    process.once('SIGTERM', () => process.exit(143));
    const listens = new Promise((found, fail) => {
      let said = '';
      made.#process.on('error', fail);
      made.#process.on('exit', (code) => fail(new Error(`Firefox ended with ${code}: ${said.slice(-500)}`)));
      made.#process.stderr.on('data', (bytes) => {
        said += bytes;
        const [, address] = /WebDriver BiDi listening on (ws:\/\/\S+)/.exec(said) ?? [];
        if (address) found(address);
      });
    });
    made.#socket = new WebSocket(`${await within('Firefox', listens)}/session`);
    await within('the line to Firefox', new Promise((open, fail) => made.#socket.on('open', open).on('error', fail)));
    made.#socket.on('message', (bytes) => made.#came(JSON.parse(bytes)));
    await made.#ask('session.new', { capabilities: {} });
    await made.#ask('session.subscribe', { events: ['log.entryAdded'] });
    made.#page = (await made.#ask('browsingContext.getTree', {})).contexts[0].context;
    return made;
  }

  #came({ id, type, error, message, result, method, params }) {
    if (method === 'log.entryAdded' && ['error', 'warn'].includes(params.level)) this.complaints.push(params.text);
    const waiting = this.#waiting.get(id);
    if (!waiting) return;
    this.#waiting.delete(id);
    if (type === 'error') waiting.fail(new Error(`${error}: ${message}`));
    else waiting.answered(result);
  }

  #ask(method, params) {
    const id = ++this.#last;
    const answer = new Promise((answered, fail) => this.#waiting.set(id, { answered, fail }));
    this.#socket.send(JSON.stringify({ id, method, params }));
    return within(`${method} of Firefox`, answer);
  }

  async goto(url) {
    await this.#ask('browsingContext.navigate', { context: this.#page, url, wait: 'complete' });
  }

  async reload() {
    await this.#ask('browsingContext.reload', { context: this.#page, wait: 'complete' });
  }

  async size(width, height) {
    await this.#ask('browsingContext.setViewport', { context: this.#page, viewport: { width, height } });
  }

  /** What a function comes to in the page; its values are copied. */
  async evaluate(work, ...values) {
    const { type, result, exceptionDetails } = await this.#ask('script.callFunction', {
      functionDeclaration: `(text) => (async () => JSON.stringify((await (${work})(...JSON.parse(text))) ?? null))()`,
      arguments: [{ type: 'string', value: JSON.stringify(values) }],
      target: { context: this.#page },
      awaitPromise: true,
    });
    if (type === 'exception') throw new Error(exceptionDetails.text);
    return JSON.parse(plain(result));
  }

  /** Until a function in the page comes to something. */
  async until(work, ...values) {
    const found = async () => {
      for (;;) {
        const value = await this.evaluate(work, ...values);
        if (value) return value;
        await new Promise((next) => setTimeout(next, 50));
      }
    };
    return within(`${work} in Firefox`, found());
  }

  /** Presses a key and lets go of it. A window without a screen has no focus: buttons take no keys in it, the page does. */
  async press(key) {
    const actions = ['keyDown', 'keyUp'].map((type) => ({ type, value: key }));
    await this.#ask('input.performActions', { context: this.#page, actions: [{ type: 'key', id: 'keyboard', actions }] });
  }

  async stop() {
    const gone = new Promise((ended) => this.#process.once('exit', ended));
    this.#process.kill();
    this.#socket?.terminate();
    await within('Firefox to end', gone);
    await rm(this.#profile, { recursive: true, force: true });
  }
}
