// Starts workers, each with its own robot, and queues requests to them.
import { signal } from '@preact/signals-core';
import type { Remote } from 'comlink';

import { files } from './files';
import { CallableWorker } from './callable-worker';
import { LatestRequestQueue } from './latest-request-queue';
import { getMessage } from './problem';
import type { RobotWorkerApi } from './robot-worker';

/** The message about the first failure of a worker; null while none has failed. */
export const workerFailure = signal<string | null>(null);

export function reportWorkerFailure(error: unknown): void {
  console.error(error);
  workerFailure.value ??= `The page cannot compute predictions or check changes (${getMessage(error)}). Reload it to try again.`;
}

export async function startRobotWorker(): Promise<CallableWorker<RobotWorkerApi>> {
  const module = await files.robotModule();
  const worker = new CallableWorker<RobotWorkerApi>(new Worker(new URL('./robot-worker.ts', import.meta.url), { type: 'module' }));
  worker.call((robot) => robot.load(module)).catch(reportWorkerFailure);
  return worker;
}

/** Creates a queue of requests to a worker with its own robot; the first request starts the worker. */
export function createRobotQueue<Query, Answer>(
  sendRequest: (robot: Remote<RobotWorkerApi>, request: Query) => Promise<Answer>,
  onResponse: (response: Answer) => void,
): LatestRequestQueue<Query, Answer> {
  let worker: Promise<CallableWorker<RobotWorkerApi>> | null = null;
  return new LatestRequestQueue(async (request) => (await (worker ??= startRobotWorker())).call((robot) => sendRequest(robot, request)), onResponse, reportWorkerFailure);
}
