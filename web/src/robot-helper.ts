// Starts workers that have a robot of their own.
import type { Remote } from 'comlink';

import { files } from './files';
import { Helper } from './helper';
import { LatestQuestion } from './latest-question';
import type { RobotFunctions } from './robot-worker';

/** Starts a worker that has a robot of its own. */
export async function robotHelper(): Promise<Helper<RobotFunctions>> {
  const module = await files.wasm();
  const helper = new Helper<RobotFunctions>(new Worker(new URL('./robot-worker.ts', import.meta.url), { type: 'module' }));
  void helper.ask((robot) => robot.load(module));
  return helper;
}

/** Prepares questions to a worker with a robot of its own, which is started with the first question. */
export function robotQuestion<Question, Answer>(
  call: (robot: Remote<RobotFunctions>, question: Question) => Promise<Answer>,
  onAnswer: (answer: Answer) => void,
): LatestQuestion<Question, Answer> {
  let helper: Promise<Helper<RobotFunctions>> | null = null;
  return new LatestQuestion(async (question) => (await (helper ??= robotHelper())).ask((robot) => call(robot, question)), onAnswer);
}
