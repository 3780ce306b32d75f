// Starts workers, each with its own robot, and queues requests to them.
import type { Remote } from 'comlink';

import { files } from './files';
import { CallableWorker } from './callable-worker';
import { LatestRequestQueue } from './latest-request-queue';
import type { RobotWorkerApi } from './robot-worker';

export async function startRobotWorker(): Promise<CallableWorker<RobotWorkerApi>> {
  const module = await files.robotModule();
  const worker = new CallableWorker<RobotWorkerApi>(new Worker(new URL('./robot-worker.ts', import.meta.url), { type: 'module' }));
  void worker.call((robot) => robot.load(module));
  return worker;
}

/** Creates a queue of requests to a worker with its own robot; the first request starts the worker. */
export function createRobotQueue<Request, Response>(
  call: (robot: Remote<RobotWorkerApi>, request: Request) => Promise<Response>,
  onResponse: (response: Response) => void,
): LatestRequestQueue<Request, Response> {
  let worker: Promise<CallableWorker<RobotWorkerApi>> | null = null;
  return new LatestRequestQueue(async (request) => (await (worker ??= startRobotWorker())).call((robot) => call(robot, request)), onResponse);
}
