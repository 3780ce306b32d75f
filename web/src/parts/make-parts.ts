// Makes the robot's parts in a worker: solids, their places in a pose, and all files as one archive.
import { proxy, type Remote } from 'comlink';

import type { CollidingPair, ModelDescription, Refusal } from '../../generated/parts';
import { files } from '../files';
import { CallableWorker } from '../callable-worker';
import type { PartsWorkerApi, Progress } from './worker';

export type { CollidingPair, Progress };
export type Model = ModelDescription;
/** The triangles of a solid: the corners' coordinates in mm, and three corner indices per triangle. */
export type Solid = { corners: Float32Array; triangles: Uint32Array };
/**
 * The archive of a robot's files with their paths, the number of all files, and the smallest proved distance between
 * two parts, mm.
 */
export type PartsArchive = ReturnType<PartsWorkerApi['makeArchive']>;

/** The error for a robot whose parts cannot be made; its message is for the user. */
export class UnfitError extends Error {
  /** The two parts that overlap or come too close; null for another reason. */
  readonly collidingPair: CollidingPair | null;

  constructor({ reason, colliding_pair }: Refusal) {
    super(reason);
    this.collidingPair = colliding_pair;
  }
}

/** A worker that makes parts; it throws a refusal as an {@link UnfitError}. */
export class PartsWorker extends CallableWorker<PartsWorkerApi> {
  /** True while the worker computes a pose. */
  private isBusy = false;

  constructor() {
    super(new Worker(new URL('./worker.ts', import.meta.url), { type: 'module' }));
  }

  /** Loads the WebAssembly module, then calls a function of the worker. */
  async loadAndCall<Result>(invoke: (parts: Remote<PartsWorkerApi>) => Promise<Result>): Promise<Result> {
    const module = await files.partsModule();
    await this.call((parts) => parts.load(module));
    return this.call(invoke).catch((error: Error | Refusal) => {
      throw 'reason' in error ? new UnfitError(error) : error;
    });
  }

  /**
   * Returns the places of all mounts of the made model for the servos' `angles` and the legs' `lags`, deg; null if a
   * loop does not close, or if the worker is still computing an earlier pose.
   */
  async computeMountPlaces(angles: number[], lags: number[]): Promise<Float64Array | null> {
    if (this.isBusy) return null;
    this.isBusy = true;
    return this.call((parts) => parts.computeMountPlaces(angles, lags)).finally(() => (this.isBusy = false));
  }
}

/**
 * Makes the model of a robot.toml and its solids, in the order of `BodyEntry.solid`, with the worker that computes
 * their places. Throws an {@link UnfitError} for a robot that cannot be built.
 */
export async function makeModel(toml: string): Promise<{ worker: PartsWorker; model: Model; solids: Solid[] }> {
  const worker = new PartsWorker();
  try {
    const { model, solids } = await worker.loadAndCall((parts) => parts.makeModel(toml));
    return { worker, model, solids };
  } catch (error) {
    worker.terminate();
    throw error;
  }
}

/** Runs a computation in its own worker; resolves to null once `signal` is aborted. */
function runInWorker<Result>(invoke: (parts: Remote<PartsWorkerApi>) => Promise<Result>, signal: AbortSignal): Promise<Result | null> {
  const worker = new PartsWorker();
  const result = new Promise<Result | null>((resolve, reject) => {
    signal.addEventListener('abort', () => resolve(null));
    worker.loadAndCall(invoke).then(resolve, reject);
  });
  return result.finally(() => worker.terminate());
}

/**
 * Proves that the parts of a robot.toml fit. The result is the smallest distance between two parts, mm, or null if no
 * pair was checked or `signal` was aborted. Rejects with an {@link UnfitError} if the parts do not fit.
 */
export const proveFit = (toml: string, signal: AbortSignal): Promise<number | null> => runInWorker((parts) => parts.proveFit(toml), signal);

/**
 * Proves that the parts fit, makes all files and packs them. If `previousToml` is not null, packs only the files that
 * differ from the previous robot's files. Resolves to null once `signal` is aborted.
 */
export const makeArchive = (toml: string, previousToml: string | null, onProgress: (progress: Progress) => void, signal: AbortSignal): Promise<PartsArchive | null> =>
  runInWorker((parts) => parts.makeArchive(toml, previousToml, proxy(onProgress)), signal);
