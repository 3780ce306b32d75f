// A search for a gait that walks faster than the edited one, in a worker of its own that ends with the search.
import type { Bars, Floor, Found, Trial, SearchTask } from '../robot';
import { messageOf } from '../trouble';

export interface Question {
  module: WebAssembly.Module;
  toml: string;
  floor: Floor;
  servos: string;
  wish: SearchTask;
}

/** A gait that the search found, with its trial on the page's floor and servos. */
export interface Best extends Found {
  trial: Trial;
}

export type Answer =
  | { of: 'start'; all: number; rate: number; before: Trial }
  | { of: 'progress'; done: number }
  | { of: 'best'; best: Best }
  /** The last answer: the best of all gaits that were tried, if any was valid. */
  | { of: 'end'; best: Best | null; done: number }
  | { of: 'end'; refused: string };

export class FasterSearch {
  private readonly worker = new Worker(new URL('./faster-worker.ts', import.meta.url), { type: 'module' });

  /** Starts the search of `module`; `onAnswer` gets every answer, the last one included. */
  constructor(
    module: Promise<WebAssembly.Module>,
    readonly question: Omit<Question, 'module'>,
    onAnswer: (answer: Answer) => void,
  ) {
    this.worker.addEventListener('message', ({ data }: MessageEvent<Answer>) => {
      if (data.of === 'end') this.drop();
      onAnswer(data);
    });
    this.worker.addEventListener('error', ({ message }) => {
      this.drop();
      onAnswer({ of: 'end', refused: message || 'the worker could not be loaded' });
    });
    module.then(
      (module) => this.worker.postMessage({ ...question, module } satisfies Question),
      (error: unknown) => {
        this.drop();
        onAnswer({ of: 'end', refused: messageOf(error) });
      },
    );
  }

  /** The gait to beat. */
  get bars(): Bars {
    return this.question.wish.bars;
  }

  /** Ends the search; the worker answers with the best so far. */
  stop(): void {
    this.worker.postMessage('stop');
  }

  /** Ends the search without an answer. */
  drop(): void {
    this.worker.terminate();
  }
}
