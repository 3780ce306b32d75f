// While a worker is busy, only the latest new request is kept.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { importSource } from './source.js';

const { LatestRequestQueue } = await importSource('latest-request-queue.ts');

/** A worker that responds when a test calls `respond`. */
class FakeWorker {
  receivedRequests = [];

  getResponse = (request) => {
    this.receivedRequests.push(request);
    return new Promise((resolve, reject) => Object.assign(this, { resolveResponse: resolve, rejectResponse: reject }));
  };

  async respond() {
    this.resolveResponse(`response to ${this.receivedRequests.at(-1)}`);
    await new Promise((resolve) => setTimeout(resolve));
  }
}

test('a busy worker responds only to the last of the queued requests', async () => {
  const worker = new FakeWorker();
  const responses = [];
  const queue = new LatestRequestQueue(worker.getResponse, (response) => responses.push(response));
  for (const request of ['first', 'second', 'third']) queue.submit(request);
  assert.deepEqual(worker.receivedRequests, ['first']);
  await worker.respond();
  assert.deepEqual(worker.receivedRequests, ['first', 'third']);
  await worker.respond();
  assert.deepEqual(responses, ['response to first', 'response to third']);
});

test('the newest request gets the last response, even if it is submitted when a response arrives', async () => {
  const worker = new FakeWorker();
  const responses = [];
  const queue = new LatestRequestQueue(worker.getResponse, (response) => {
    responses.push(response);
    if (response === 'response to first') queue.submit('newest');
  });
  queue.submit('first');
  queue.submit('older');
  for (let n = 0; n < 2; n++) await worker.respond();
  assert.deepEqual(responses.at(-1), 'response to newest', `${worker.receivedRequests}`);
  assert.equal(worker.receivedRequests.at(-1), 'newest', 'no older request is sent after the newest request');
});

test('an error is reported, and the queued request is sent', async () => {
  const worker = new FakeWorker();
  const errors = [];
  const queue = new LatestRequestQueue(worker.getResponse, assert.fail, (error) => errors.push(error));
  queue.submit('first');
  queue.submit('second');
  worker.rejectResponse('no worker');
  await new Promise((resolve) => setTimeout(resolve));
  assert.deepEqual(errors, ['no worker']);
  assert.deepEqual(worker.receivedRequests, ['first', 'second']);
});
