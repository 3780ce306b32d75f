// A search for a gait that walks faster than the edited one, in a worker of its own, which is terminated with the
// search.
import type { SearchTask } from '../../generated/tune';
import { Helper } from '../helper';
import type { OnFloor, Trial } from '../robot';
import { messageOf } from '../trouble';
import type { Best, FasterFunctions } from './faster-worker';

export type { Best };

/** Number of gaits between two reports of the best so far: one population of the search. */
const GAITS_PER_REPORT = 20;
/**
 * Number of random robots for a report (`look`) and for the final comparison (`end`), the latter as in `lizard tune`.
 */
const ROBOTS = { look: 20, end: 200 };

export type Answer =
  | { of: 'start'; all: number; rate: number; before: Trial }
  | { of: 'progress'; done: number }
  | { of: 'best'; best: Best }
  /** The last answer: the best of all gaits that were tried, if any was valid. */
  | { of: 'end'; best: Best | null; done: number }
  | { of: 'end'; refused: string };

export class FasterSearch {
  private readonly helper = new Helper<FasterFunctions>(new Worker(new URL('./faster-worker.ts', import.meta.url), { type: 'module' }));
  private isStopped = false;

  /** Starts the search with the WebAssembly module; `onAnswer` gets every answer, the last one included. */
  constructor(module: Promise<WebAssembly.Module>, question: OnFloor & { task: SearchTask }, onAnswer: (answer: Answer) => void) {
    this.search(module, question, onAnswer)
      .catch((error: unknown): Answer => ({ of: 'end', refused: messageOf(error) }))
      .then((lastAnswer) => {
        this.drop();
        onAnswer(lastAnswer);
      });
  }

  /** Ends the search after the current gait; the last answer has the best gait so far. */
  stop(): void {
    this.isStopped = true;
  }

  /** Ends the search without an answer. */
  drop(): void {
    this.helper.end();
  }

  private async search(module: Promise<WebAssembly.Module>, question: OnFloor & { task: SearchTask }, say: (answer: Answer) => void): Promise<Answer> {
    const { helper } = this;
    const loadedModule = await module;
    const start = await helper.ask((search) => search.begin(loadedModule, question));
    say({ of: 'start', ...start });
    let [shownScore, done] = [-Infinity, 0];
    while (done < start.all && !this.isStopped) {
      const progress = await helper.ask((search) => search.step());
      done = progress.done;
      say({ of: 'progress', done });
      if (done % GAITS_PER_REPORT !== 0 || done === start.all || progress.best === null || progress.best <= shownScore) continue;
      shownScore = progress.best;
      const best = await helper.ask((search) => search.best(ROBOTS.look));
      if (best) say({ of: 'best', best });
    }
    const best = await helper.ask((search) => search.best(ROBOTS.end));
    return { of: 'end', best, done };
  }
}
