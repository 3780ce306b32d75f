// Starts workers, each with its own robot.
import type { Remote } from 'comlink';

import { files } from './files';
import { Helper } from './helper';
import { LatestQuestion } from './latest-question';
import type { RobotWorkerApi } from './robot-worker';

/** Starts a worker with its own robot. */
export async function startRobotHelper(): Promise<Helper<RobotWorkerApi>> {
  const module = await files.wasm();
  const helper = new Helper<RobotWorkerApi>(new Worker(new URL('./robot-worker.ts', import.meta.url), { type: 'module' }));
  void helper.call((robot) => robot.load(module));
  return helper;
}

/** Prepares questions to a worker with its own robot; the first question starts the worker. */
export function createRobotQuestion<Question, Answer>(
  call: (robot: Remote<RobotWorkerApi>, question: Question) => Promise<Answer>,
  onAnswer: (answer: Answer) => void,
): LatestQuestion<Question, Answer> {
  let helper: Promise<Helper<RobotWorkerApi>> | null = null;
  return new LatestQuestion(async (question) => (await (helper ??= startRobotHelper())).call((robot) => call(robot, question)), onAnswer);
}
