// The worker of FasterSearch: its own instance of the robot in WebAssembly, which tries one gait after another.
import { isRefused, Robot, type Trial } from '../robot';
import { messageOf } from '../trouble';
import type { Answer, Best, Question } from './faster';

/** Gaits between two reports of the best so far: one population of the search. */
const LOOK = 20;
/** Random robots for a report and for the final comparison, which has as many as `lizard tune`. */
const ROBOTS = { look: 20, end: 200 };

let isStopped = false;

const say = (answer: Answer) => postMessage(answer);
/** Yields, so that waiting messages are handled. */
const turn = () => new Promise((next) => setTimeout(next));

addEventListener('message', ({ data }: MessageEvent<Question | 'stop'>) => {
  if (data === 'stop') isStopped = true;
  else void search(data).catch((error: unknown) => say({ of: 'end', refused: messageOf(error) }));
});

async function search({ module, toml, floor, servos, wish }: Question): Promise<void> {
  const robot = await Robot.load(module);
  robot.read(toml);
  robot.setFloor(floor);
  robot.setServos(servos);
  const search = robot.makeFaster(wish);
  if (isRefused(search)) return say({ of: 'end', refused: search.refused });
  say({ of: 'start', ...search, before: robot.trial(wish.bars) as Trial });
  const best = (robots: number): Best | null => {
    const found = robot.fasterFound(robots);
    // The search only returns gaits within the robot's limits.
    return found && { ...found, trial: robot.trial(found.bars) as Trial };
  };
  let shown = -Infinity;
  let done = 0;
  while (done < search.all) {
    await turn();
    if (isStopped) break;
    const tried = robot.fasterStep();
    done = tried.done;
    say({ of: 'progress', done });
    if (done % LOOK !== 0 || done === search.all || tried.best === null || tried.best <= shown) continue;
    shown = tried.best;
    const now = best(ROBOTS.look);
    if (now) say({ of: 'best', best: now });
  }
  say({ of: 'end', best: best(ROBOTS.end), done });
}
