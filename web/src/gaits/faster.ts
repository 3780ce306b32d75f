// A search for a gait that is faster than the edited gait. It runs in its own worker, which is terminated at the end of
// the search.
import type { SearchTask } from '../../generated/tune';
import { CallableWorker } from '../callable-worker';
import type { OnFloor, Trial } from '../robot';
import { getMessage } from '../problem';
import type { BestGait, FasterWorkerApi } from './faster-worker';

export type { BestGait };

/** Number of gaits between two reports of the best gait so far: a population of the search. */
const GAITS_PER_REPORT = 20;
/**
 * Number of random robots on which gaits are compared, for a report during the search and for the final report, as in
 * `lizard tune`.
 */
const ROBOT_COUNT = { progress: 20, final: 200 };

/** A report of the search: `done` of `total` gaits are tried; `rate` is the servos' speed limit, deg/s. */
export type SearchReport =
  | { kind: 'start'; total: number; rate: number; referenceTrial: Trial }
  | { kind: 'progress'; done: number }
  | { kind: 'best'; best: BestGait }
  /** The last report: the best of all tried gaits, or null if no gait was valid. */
  | { kind: 'end'; best: BestGait | null; done: number }
  | { kind: 'end'; refused: string };

export class FasterSearch {
  private readonly worker = new CallableWorker<FasterWorkerApi>(new Worker(new URL('./faster-worker.ts', import.meta.url), { type: 'module' }));
  private isStopped = false;

  /** Starts the search with the WebAssembly module; `onReport` receives every report, including the last one. */
  constructor(module: Promise<WebAssembly.Module>, request: OnFloor & { task: SearchTask }, onReport: (report: SearchReport) => void) {
    this.search(module, request, onReport)
      .catch((error: unknown): SearchReport => ({ kind: 'end', refused: getMessage(error) }))
      .then((lastReport) => {
        this.cancel();
        onReport(lastReport);
      });
  }

  /** Ends the search after the current gait; the last report then has the best gait so far. */
  stop(): void {
    this.isStopped = true;
  }

  /** Ends the search at once, without a last report. */
  cancel(): void {
    this.worker.terminate();
  }

  private async search(module: Promise<WebAssembly.Module>, request: OnFloor & { task: SearchTask }, onReport: (report: SearchReport) => void): Promise<SearchReport> {
    const { worker } = this;
    const loadedModule = await module;
    const start = await worker.call((search) => search.begin(loadedModule, request));
    onReport({ kind: 'start', ...start });
    let [reportedScore, done] = [-Infinity, 0];
    while (done < start.total && !this.isStopped) {
      const progress = await worker.call((search) => search.tryNext());
      done = progress.done;
      onReport({ kind: 'progress', done });
      if (done % GAITS_PER_REPORT !== 0 || done === start.total || progress.best_score === null || progress.best_score <= reportedScore) continue;
      reportedScore = progress.best_score;
      const best = await worker.call((search) => search.compareBest(ROBOT_COUNT.progress));
      if (best) onReport({ kind: 'best', best });
    }
    const best = await worker.call((search) => search.compareBest(ROBOT_COUNT.final));
    return { kind: 'end', best, done };
  }
}
