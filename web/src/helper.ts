// A worker whose functions the page calls. What takes tenths of a second is computed in one, since the page has 16 ms for a picture.
import { type Remote, wrap } from 'comlink';

export class Helper<Functions> {
  private readonly functions: Remote<Functions>;
  /** The reason why the worker cannot be loaded. */
  private trouble: Error | null = null;
  /** Those who wait for an answer, by the functions that tell them of a failure. */
  private readonly waiting = new Set<(error: Error) => void>();

  constructor(private readonly worker: Worker) {
    this.functions = wrap<Functions>(worker);
    worker.addEventListener('error', ({ message }) => {
      this.trouble = new Error(message || 'the worker could not be loaded');
      for (const fail of this.waiting) fail(this.trouble);
    });
  }

  /** Calls a function. Fails with what it throws, or if the worker cannot be loaded. */
  async ask<Answer>(call: (functions: Remote<Functions>) => Promise<Answer>): Promise<Answer> {
    if (this.trouble) throw this.trouble;
    let failed: (error: Error) => void = () => {};
    try {
      return await new Promise<Answer>((done, fail) => {
        this.waiting.add((failed = fail));
        call(this.functions).then(done, fail);
      });
    } finally {
      this.waiting.delete(failed);
    }
  }

  /** Ends the worker; calls under way are not answered. */
  end(): void {
    this.worker.terminate();
  }
}
