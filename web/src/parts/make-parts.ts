// Makes the robot's parts in a worker: solids, their places in a pose, and all files as one archive.
import { proxy, type Remote } from 'comlink';

import type { Clash, ModelEntry, Refusal } from '../../generated/parts';
import { files } from '../files';
import { CallableWorker } from '../callable-worker';
import type { PartsWorkerApi, Progress } from './worker';

export type { Clash, Progress };
export type Model = ModelEntry;
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
  readonly clash: Clash | null;

  constructor({ refused, clash }: Refusal) {
    super(refused);
    this.clash = clash;
  }
}

/** A worker that makes parts; it throws a refusal as an {@link UnfitError}. */
class PartsWorker extends CallableWorker<PartsWorkerApi> {
  constructor() {
    super(new Worker(new URL('./worker.ts', import.meta.url), { type: 'module' }));
  }

  /** Loads the WebAssembly module, then calls a function of the worker. */
  async loadAndCall<Result>(invoke: (parts: Remote<PartsWorkerApi>) => Promise<Result>): Promise<Result> {
    const module = await files.partsModule();
    await this.call((parts) => parts.load(module));
    return this.call(invoke).catch((error: Error | Refusal) => {
      throw 'refused' in error ? new UnfitError(error) : error;
    });
  }
}

/** A robot's solids and their places in a pose. */
export class Solids {
  /** True while the worker computes a pose. */
  private isBusy = false;

  private constructor(private readonly worker: PartsWorker) {}

  /**
   * Makes the solids of a robot.toml, in the order of `BodyEntry.solid`. Throws an {@link UnfitError} for a robot that
   * cannot be built.
   */
  static async make(toml: string): Promise<{ solids: Solids; model: Model; meshes: Solid[] }> {
    const worker = new PartsWorker();
    try {
      const { model, solids } = await worker.loadAndCall((parts) => parts.makeModel(toml));
      return { solids: new Solids(worker), model, meshes: solids };
    } catch (error) {
      worker.terminate();
      throw error;
    }
  }

  /**
   * Returns the places of all mounts for the servos' `angles` and the legs' `lags`, deg; null if a loop does not close,
   * or if the worker is still computing an earlier pose.
   */
  async computeMountPlaces(angles: number[], lags: number[]): Promise<Float64Array | null> {
    if (this.isBusy) return null;
    this.isBusy = true;
    return this.worker.call((parts) => parts.computeMountPlaces(angles, lags)).finally(() => (this.isBusy = false));
  }

  dispose(): void {
    this.worker.terminate();
  }
}

/** A running computation; after `cancel`, `result` never settles. */
interface Job<Result> {
  result: Promise<Result>;
  cancel: () => void;
}

function startJob<Result>(invoke: (parts: Remote<PartsWorkerApi>) => Promise<Result>): Job<Result> {
  const worker = new PartsWorker();
  return { result: worker.loadAndCall(invoke).finally(() => worker.terminate()), cancel: () => worker.terminate() };
}

/**
 * Proves that the parts of a robot.toml fit. The result is the smallest distance between two parts, mm, or null if no
 * pair was checked. Rejects with an {@link UnfitError} if the parts do not fit.
 */
export const proveFit = (toml: string): Job<number | null> => startJob((parts) => parts.proveFit(toml));

/**
 * Proves that the parts fit, makes all files and packs them. If `previousToml` is not null, packs only the files that
 * differ from the previous robot's files.
 */
export const makeArchive = (toml: string, previousToml: string | null, onProgress: (progress: Progress) => void): Job<PartsArchive> =>
  startJob((parts) => parts.makeArchive(toml, previousToml, proxy(onProgress)));
