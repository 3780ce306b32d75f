// The worker of FasterSearch: a robot in WebAssembly with the search for a faster gait.
import { expose } from 'comlink';

import { type Found, initSync, Robot, type SearchTask, type Trial } from '../../generated/tune';
import { isRefused, type OnFloor } from '../robot';

let robot: Robot;

/** A gait that the search found, with its trial on the page's floor and servos. */
export interface Best extends Found {
  trial: Trial;
}

const functions = {
  /** Prepares a search: the number of gaits to try, the servos' deg/s, and the trial of the gait to beat. Throws why there is nothing to search. */
  begin(module: WebAssembly.Module, { toml, floor, servos, task }: OnFloor & { task: SearchTask }) {
    initSync({ module });
    robot = new Robot();
    robot.read(toml);
    robot.setFloor(floor);
    robot.setServos(servos);
    const search = robot.makeFaster(task);
    if (isRefused(search)) throw new Error(search.refused);
    return { ...search, before: robot.trial(task.bars) as Trial };
  },

  /** Tries one more gait. */
  step: () => robot.fasterStep(),

  /** The best so far, compared on a number of random robots. The search only returns gaits within the robot's limits. */
  best(robots: number): Best | null {
    const found = robot.fasterFound(robots);
    return found && { ...found, trial: robot.trial(found.bars) as Trial };
  },
};

export type FasterFunctions = typeof functions;
expose(functions);
