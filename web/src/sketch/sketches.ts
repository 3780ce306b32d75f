// What a robot becomes with other lengths, asked of a worker while a person drags: of what is asked while it is at work,
// only the last is answered.
import type { Refused, Scene } from '../robot';

/** Lengths by their keys in robot.toml. */
export type Edits = [key: string, value: number][];

export interface Question {
  toml: string;
  edits: Edits;
  /** Whether the nearest that would do is looked for, where this will not. */
  isLast: boolean;
}

export interface Answer {
  edits: Edits;
  /** The robot.toml with them. */
  toml: string;
  /** Why it will not do. */
  refused: Refused | null;
  /** Its neutral pose, if it will. */
  scene: Scene | null;
  /** The nearest on the way to it that will do, where that was asked for and is any. */
  nearest: { edits: Edits; toml: string } | null;
  isLast: boolean;
}

export class Sketches {
  private readonly worker = new Worker(new URL('./worker.ts', import.meta.url), { type: 'module' });
  private next: Question | null = null;
  private isBusy = false;

  constructor(module: WebAssembly.Module, onAnswer: (answer: Answer) => void) {
    this.worker.postMessage(module);
    this.worker.addEventListener('message', ({ data }: MessageEvent<Answer>) => {
      const { next } = this;
      this.isBusy = false;
      onAnswer(data);
      if (next) this.ask(next);
    });
  }

  ask(question: Question): void {
    this.next = this.isBusy ? question : null;
    if (this.isBusy) return;
    this.isBusy = true;
    this.worker.postMessage(question);
  }
}
