// If questions arrive faster than a worker answers, only the last one is answered.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { createRequire } from 'node:module';
import { test } from 'node:test';
import { pathToFileURL } from 'node:url';

/** Loads the class as a browser would, compiled to JavaScript. */
async function loadClass() {
  const source = new URL('../src/latest.ts', import.meta.url);
  const vite = createRequire(new URL('../package.json', import.meta.url)).resolve('vite');
  const { transformWithOxc } = await import(pathToFileURL(vite));
  const { code } = await transformWithOxc(await readFile(source, 'utf8'), 'latest.ts');
  return (await import(`data:text/javascript,${encodeURIComponent(code)}`)).LatestQuestion;
}

/** A worker that answers when a test says so. */
class FakeWorker {
  asked = [];

  addEventListener(_, hear) {
    this.hear = hear;
  }

  postMessage(question) {
    this.asked.push(question);
  }

  answer() {
    this.hear({ data: `answer to ${this.asked.at(-1)}` });
  }
}

test('of the questions asked while the worker is busy only the last is answered', async () => {
  const worker = new FakeWorker();
  const said = [];
  const questions = new (await loadClass())(worker, 'module', (answer) => said.push(answer));
  for (const question of ['first', 'second', 'third']) questions.ask(question);
  assert.deepEqual(worker.asked, ['module', 'first']);
  worker.answer();
  assert.deepEqual(worker.asked, ['module', 'first', 'third']);
  worker.answer();
  assert.deepEqual(said, ['answer to first', 'answer to third']);
});

test('a question asked when an answer arrives replaces the waiting one, or is answered after it', async () => {
  const worker = new FakeWorker();
  const said = [];
  const questions = new (await loadClass())(worker, 'module', (answer) => {
    said.push(answer);
    if (answer === 'answer to first') questions.ask('newest');
  });
  questions.ask('first');
  questions.ask('older');
  for (let n = 0; n < 2; n++) worker.answer();
  assert.deepEqual(said.at(-1), 'answer to newest', `${worker.asked}`);
  assert.equal(worker.asked.at(-1), 'newest', 'and nothing older is asked after it');
});
