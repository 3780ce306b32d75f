// A worker whose functions the page calls. What takes tenths of a second is computed in one, since the page has 16 ms for a picture.
import { type Remote, wrap } from 'comlink';

export class Helper<Functions> {
  private readonly functions: Remote<Functions>;
  /** Fails if the worker cannot be loaded. */
  private readonly failed: Promise<never>;

  constructor(private readonly worker: Worker) {
    this.functions = wrap<Functions>(worker);
    this.failed = new Promise((_, fail) => {
      worker.addEventListener('error', ({ message }) => fail(new Error(message || 'the worker could not be loaded')));
    });
    this.failed.catch(() => {});
  }

  /** Calls a function. Fails with what it throws, or if the worker cannot be loaded; calls are answered in their order. */
  ask<Answer>(call: (functions: Remote<Functions>) => Promise<Answer>): Promise<Answer> {
    return Promise.race([call(this.functions), this.failed]);
  }

  /** Ends the worker; calls under way are not answered. */
  end(): void {
    this.worker.terminate();
  }
}
