// Predicts each gait's displacement in a worker: a prediction takes tenths of a second, and the page
// has 16 ms for a picture.
import type { Floor, GaitPrediction } from './robot';

/** The question: every gait of a robot on a floor. */
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
  private readonly worker = new Worker(new URL('./predictor-worker.ts', import.meta.url), { type: 'module' });
  private question = 0;

  constructor(module: WebAssembly.Module, onPrediction: (gait: number, prediction: GaitPrediction) => void) {
    this.worker.postMessage(module);
    this.worker.addEventListener('message', ({ data: { question, gait, prediction } }: MessageEvent<Answer>) => {
      if (question === this.question && prediction) onPrediction(gait, prediction);
    });
  }

  /** Asks a new question; the previous one is not answered any further. */
  ask(question: Question): void {
    this.question += 1;
    this.worker.postMessage({ ...question, question: this.question });
  }
}
