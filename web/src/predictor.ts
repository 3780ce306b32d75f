// Predicts each gait's displacement in a worker: a prediction takes tenths of a second, on a phone seconds, and the page
// has 16 ms for a picture. Those of the files' own robots come with the page.
import type { Floor, GaitPrediction } from './robot';

/** The question: every gait of a robot on a floor; none ends the question before. */
export interface Question {
  toml: string;
  floor: Floor;
  /** The name of the servo model. */
  servos: string;
  gaits: number;
  /** The gait to predict first. */
  first: number;
}

/** The prediction of one gait, and the number of its question. */
export interface Answer {
  question: number;
  gait: number;
  prediction: GaitPrediction | null;
}

export class Predictor {
  private worker: Worker | null = null;
  private question = 0;

  constructor(
    private readonly module: WebAssembly.Module,
    private readonly onPrediction: (gait: number, prediction: GaitPrediction) => void,
  ) {}

  /** Asks a new question; the previous one is not answered any further. */
  ask(question: Question): void {
    this.question += 1;
    if (question.gaits > 0) this.worker ??= this.start();
    this.worker?.postMessage({ ...question, question: this.question });
  }

  private start(): Worker {
    const worker = new Worker(new URL('./predictor-worker.ts', import.meta.url), { type: 'module' });
    worker.postMessage(this.module);
    worker.addEventListener('message', ({ data: { question, gait, prediction } }: MessageEvent<Answer>) => {
      if (question === this.question && prediction) this.onPrediction(gait, prediction);
    });
    return worker;
  }
}
