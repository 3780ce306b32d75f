// Asks a worker for the tags in pictures, for the movement of gaits in a film, and for the sheet of tags. No picture
// leaves the machine.
import { files } from '../files';
import type { Answer, Asked, Question, Results, Sight } from './question';

interface Waiting {
  resolve: (well: unknown) => void;
  reject: (error: Error) => void;
}

export class Film {
  private readonly waiting: Waiting[] = [];

  private constructor(private readonly worker: Worker) {
    // Answers come in the order of the questions.
    worker.addEventListener('message', ({ data }: MessageEvent<Answer>) => {
      const asked = this.waiting.shift();
      if ('well' in data) asked?.resolve(data.well);
      else asked?.reject(new Error(data.refused));
    });
    worker.addEventListener('error', ({ message }) => {
      for (const { reject } of this.waiting.splice(0)) reject(new Error(message || 'the worker could not be loaded'));
    });
  }

  static async load(): Promise<Film> {
    const module = await files.measure();
    const worker = new Worker(new URL('./worker.ts', import.meta.url), { type: 'module' });
    worker.postMessage(module);
    return new Film(worker);
  }

  /** Finds the tags of a picture that was taken at a time, s; one that is kept belongs to the film. */
  look(picture: VideoFrame | ImageBitmap, seconds: number, isKept: boolean): Promise<Sight> {
    return this.ask({ ask: 'picture', picture, seconds, isKept }, [picture]);
  }

  /** Begins a new film. */
  clear(): Promise<null> {
    return this.ask({ ask: 'clear' });
  }

  /** Measures gaits in the film. Throws the reason where the film does not show what is needed. */
  measure(asked: Asked): Promise<Results> {
    return this.ask({ ask: 'measure', asked });
  }

  /** The sheet of tags as PDF, for A4 or for letter paper. */
  sheet(isLetter: boolean): Promise<Uint8Array<ArrayBuffer>> {
    return this.ask({ ask: 'sheet', isLetter });
  }

  private ask<T>(question: Question, give: Transferable[] = []): Promise<T> {
    const answer = new Promise((resolve, reject) => this.waiting.push({ resolve, reject }));
    this.worker.postMessage(question, give);
    return answer as Promise<T>;
  }
}
