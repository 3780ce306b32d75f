// If questions arrive faster than a worker answers, only the latest one is answered.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { importSource } from './source.js';

const { LatestQuestion } = await importSource('latest-question.ts');

/** A worker that answers when a test calls `answer`. */
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

test('a busy worker answers only the last of the waiting questions', async () => {
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

test('the newest question is answered last, even if it is asked when an answer arrives', async () => {
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
  assert.equal(worker.receivedQuestions.at(-1), 'newest', 'no older question is asked after the newest question');
});
