// A web worker whose functions the page calls. Computations of tenths of a second run in a worker, since the page has
// 16 ms for a picture.
import { type Remote, wrap } from 'comlink';

export class Helper<Functions> {
  private readonly functions: Remote<Functions>;
  /** The reason why the worker cannot be loaded; null while no failure is known. */
  private loadError: Error | null = null;
  /** The reject functions of the calls that wait for an answer. */
  private readonly pendingRejects = new Set<(error: Error) => void>();

  constructor(private readonly worker: Worker) {
    this.functions = wrap<Functions>(worker);
    worker.addEventListener('error', ({ message }) => {
      this.loadError = new Error(message || 'the worker could not be loaded');
      for (const reject of this.pendingRejects) reject(this.loadError);
    });
  }

  /**
   * Calls a function of the worker. Rejects with the error that the function throws, or if the worker cannot be
   * loaded.
   */
  async ask<Answer>(call: (functions: Remote<Functions>) => Promise<Answer>): Promise<Answer> {
    if (this.loadError) throw this.loadError;
    let rejectCall: (error: Error) => void = () => {};
    try {
      return await new Promise<Answer>((resolve, reject) => {
        this.pendingRejects.add((rejectCall = reject));
        call(this.functions).then(resolve, reject);
      });
    } finally {
      this.pendingRejects.delete(rejectCall);
    }
  }

  /** Ends the worker; calls under way are not answered. */
  end(): void {
    this.worker.terminate();
  }
}
