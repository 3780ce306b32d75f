// Where each gait leads, asked of a worker: a prediction takes tenths of a second, and the page
// has 16 ms for a picture.
import type { Floor, Outlook } from './robot';

/** What is asked: every gait of a robot on a floor. */
export interface Question {
  toml: string;
  floor: Floor;
  /** The name of what its servos are taken for. */
  servos: string;
  gaits: number;
  /** The gait to begin with. */
  first: number;
}

/** One gait's answer, to the question of this number. */
export interface Answer {
  question: number;
  gait: number;
  outlook: Outlook | null;
}

export class Predictor {
  private readonly worker = new Worker(new URL('./predictor-worker.ts', import.meta.url), { type: 'module' });
  private question = 0;

  constructor(module: WebAssembly.Module, onOutlook: (gait: number, outlook: Outlook) => void) {
    this.worker.postMessage(module);
    this.worker.addEventListener('message', ({ data: { question, gait, outlook } }: MessageEvent<Answer>) => {
      if (question === this.question && outlook) onOutlook(gait, outlook);
    });
  }

  /** Asks anew; what was asked before is not answered any more. */
  ask(question: Question): void {
    this.question += 1;
    this.worker.postMessage({ ...question, question: this.question });
  }
}
