// If questions arrive faster than a worker answers, only the latest one is answered.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { importSource } from './source.js';

const { LatestQuestion } = await importSource('latest-question.ts');

/** A worker that answers when a test says so. */
class FakeWorker {
  receivedQuestions = [];

  ask = (question) => {
    this.receivedQuestions.push(question);
    return new Promise((resolve) => (this.resolveAnswer = resolve));
  };

  async answer() {
    this.resolveAnswer(`answer to ${this.receivedQuestions.at(-1)}`);
    await new Promise((resolve) => setTimeout(resolve));
  }
}

test('of the questions asked while the worker is busy only the last is answered', async () => {
  const worker = new FakeWorker();
  const answers = [];
  const questions = new LatestQuestion(worker.ask, (answer) => answers.push(answer));
  for (const question of ['first', 'second', 'third']) questions.ask(question);
  assert.deepEqual(worker.receivedQuestions, ['first']);
  await worker.answer();
  assert.deepEqual(worker.receivedQuestions, ['first', 'third']);
  await worker.answer();
  assert.deepEqual(answers, ['answer to first', 'answer to third']);
});

test('a question asked when an answer arrives replaces the waiting one, or is answered after it', async () => {
  const worker = new FakeWorker();
  const answers = [];
  const questions = new LatestQuestion(worker.ask, (answer) => {
    answers.push(answer);
    if (answer === 'answer to first') questions.ask('newest');
  });
  questions.ask('first');
  questions.ask('older');
  for (let n = 0; n < 2; n++) await worker.answer();
  assert.deepEqual(answers.at(-1), 'answer to newest', `${worker.receivedQuestions}`);
  assert.equal(worker.receivedQuestions.at(-1), 'newest', 'and nothing older is asked after it');
});
