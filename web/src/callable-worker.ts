// A web worker whose functions the page calls. Computations that take tenths of a second run in a worker, because
// the page has only 16 ms per animation frame.
import { type Remote, wrap } from 'comlink';

export class CallableWorker<Api> {
  private readonly api: Remote<Api>;
  /** The error that prevented the worker from loading; null while no error is known. */
  private loadError: Error | null = null;
  /** The reject functions of the pending calls. */
  private readonly pendingRejects = new Set<(error: Error) => void>();

  constructor(private readonly worker: Worker) {
    this.api = wrap<Api>(worker);
    worker.addEventListener('error', ({ message }) => {
      this.loadError = new Error(message || 'the worker could not be loaded');
      for (const reject of this.pendingRejects) reject(this.loadError);
    });
  }

  /** Calls a function of the worker. Rejects with the function's error, or if the worker cannot be loaded. */
  async call<Result>(invoke: (api: Remote<Api>) => Promise<Result>): Promise<Result> {
    if (this.loadError) throw this.loadError;
    let rejectCall: (error: Error) => void = () => {};
    try {
      return await new Promise<Result>((resolve, reject) => {
        this.pendingRejects.add((rejectCall = reject));
        invoke(this.api).then(resolve, reject);
      });
    } finally {
      this.pendingRejects.delete(rejectCall);
    }
  }

  /** Terminates the worker; pending calls are never settled. */
  terminate(): void {
    this.worker.terminate();
  }
}
