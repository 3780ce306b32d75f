// Starts a worker that has a robot of its own.
import { Helper } from './helper';
import type { RobotFunctions } from './robot-worker';

export function robotHelper(module: WebAssembly.Module): Helper<RobotFunctions> {
  const helper = new Helper<RobotFunctions>(new Worker(new URL('./robot-worker.ts', import.meta.url), { type: 'module' }));
  void helper.ask((robot) => robot.load(module));
  return helper;
}
