// A search for a gait that walks faster than one that is being made, in a worker of its own, which ends with it.
import type { Bars, Floor, Found, Trial, Wish } from '../robot';
import { sentence } from '../trouble';

export interface Question {
  module: WebAssembly.Module;
  toml: string;
  floor: Floor;
  servos: string;
  wish: Wish;
}

/** What was found, and what becomes of it on the page's floor with the page's servos. */
export interface Best extends Found {
  trial: Trial;
}

export type Answer =
  | { of: 'begun'; all: number; rate: number; before: Trial }
  | { of: 'tried'; done: number }
  | { of: 'best'; best: Best }
  /** The last one: the best of all that were tried, if any is a gait at all. */
  | { of: 'end'; best: Best | null; done: number }
  | { of: 'end'; refused: string };

export class FasterSearch {
  private readonly worker = new Worker(new URL('./faster-worker.ts', import.meta.url), { type: 'module' });

  /** `module` has the search; `hear` gets the answers up to the one of the end. */
  constructor(
    module: Promise<WebAssembly.Module>,
    readonly question: Omit<Question, 'module'>,
    hear: (answer: Answer) => void,
  ) {
    this.worker.addEventListener('message', ({ data }: MessageEvent<Answer>) => {
      if (data.of === 'end') this.drop();
      hear(data);
    });
    this.worker.addEventListener('error', ({ message }) => {
      this.drop();
      hear({ of: 'end', refused: message || 'the worker could not be loaded' });
    });
    module.then(
      (module) => this.worker.postMessage({ ...question, module } satisfies Question),
      (error: unknown) => {
        this.drop();
        hear({ of: 'end', refused: sentence(error) });
      },
    );
  }

  /** The gait that is to be surpassed. */
  get bars(): Bars {
    return this.question.wish.bars;
  }

  /** Ends the search with the best so far, which is answered. */
  stop(): void {
    this.worker.postMessage('stop');
  }

  /** Ends it without an answer. */
  drop(): void {
    this.worker.terminate();
  }
}
