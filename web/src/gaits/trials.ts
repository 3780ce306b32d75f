// Where a gait would lead, asked of a worker while a person drags: of what is asked while it
// is at work, only the last is answered.
import type { Floor, Made, NoTrial, Trial } from '../robot';

export interface Question {
  toml: string;
  floor: Floor;
  servos: string;
  made: Made;
}

export interface Answer {
  made: Made;
  /** Null of a line without length. */
  trial: Trial | NoTrial | null;
}

export class Trials {
  private readonly worker = new Worker(new URL('./worker.ts', import.meta.url), { type: 'module' });
  private next: Question | null = null;
  private isBusy = false;

  constructor(module: WebAssembly.Module, onAnswer: (answer: Answer) => void) {
    this.worker.postMessage(module);
    this.worker.addEventListener('message', ({ data }: MessageEvent<Answer>) => {
      this.isBusy = false;
      onAnswer(data);
      if (this.next) this.ask(this.next);
    });
  }

  ask(question: Question): void {
    this.next = this.isBusy ? question : null;
    if (this.isBusy) return;
    this.isBusy = true;
    this.worker.postMessage(question);
  }
}
