// Asks a worker for the robot's parts: solids, places at a pose, and all files as one archive.
import { proxy, type Remote } from 'comlink';

import type { Meeting, ModelEntry, Refused } from '../../generated/parts';
import { files } from '../files';
import { Helper } from '../helper';
import type { PartsFunctions, Progress } from './worker';

export type { Meeting, Progress };
export type Model = ModelEntry;
/** The triangles of a solid: the corners' coordinates in mm, and three corner indices for each triangle. */
export type Solid = { corners: Float32Array; triangles: Uint32Array };
/**
 * The archive with its paths, the number of all files of the robot, and the least proved distance between two parts,
 * mm.
 */
export type PartsArchive = ReturnType<PartsFunctions['make']>;

/** Thrown for a robot whose parts cannot be made; its message is for the user. */
export class UnfitError extends Error {
  readonly meeting: Meeting | null;

  constructor({ refused, meeting }: Refused) {
    super(refused);
    this.meeting = meeting;
  }
}

/** A worker with the parts; what it refuses is thrown as an {@link UnfitError}. */
class Workshop extends Helper<PartsFunctions> {
  constructor() {
    super(new Worker(new URL('./worker.ts', import.meta.url), { type: 'module' }));
  }

  /** Loads the WebAssembly module, then calls a function of the worker. */
  async loadAndAsk<Answer>(call: (parts: Remote<PartsFunctions>) => Promise<Answer>): Promise<Answer> {
    const module = await files.parts();
    await this.ask((parts) => parts.load(module));
    return this.ask(call).catch((error: Error | Refused) => {
      throw 'refused' in error ? new UnfitError(error) : error;
    });
  }
}

/** A robot's solids and their places at a pose. */
export class Solids {
  private isAsking = false;

  private constructor(private readonly workshop: Workshop) {}

  /**
   * Makes the solids of a robot.toml, in the order of `BodyEntry.solid`. Throws {@link UnfitError} for a robot that
   * cannot be built.
   */
  static async make(toml: string): Promise<{ solids: Solids; model: Model; meshes: Solid[] }> {
    const workshop = new Workshop();
    try {
      const { model, solids } = await workshop.loadAndAsk((parts) => parts.model(toml));
      return { solids: new Solids(workshop), model, meshes: solids };
    } catch (error) {
      workshop.end();
      throw error;
    }
  }

  /**
   * Returns the places of all mounts; null if a loop does not close, or if the worker still computes an earlier pose.
   */
  async pose(angles: number[], lags: number[]): Promise<Float64Array | null> {
    if (this.isAsking) return null;
    this.isAsking = true;
    return this.workshop.ask((parts) => parts.pose(angles, lags)).finally(() => (this.isAsking = false));
  }

  end(): void {
    this.workshop.end();
  }
}

/** An answer to come; `stop` ends the work without one. */
interface Work<Answer> {
  answer: Promise<Answer>;
  stop: () => void;
}

function startWork<Answer>(call: (parts: Remote<PartsFunctions>) => Promise<Answer>): Work<Answer> {
  const workshop = new Workshop();
  return { answer: workshop.loadAndAsk(call).finally(() => workshop.end()), stop: () => workshop.end() };
}

/**
 * Proves that the parts of a robot.toml fit; answers with the least distance between two, mm, null if no pair was
 * checked. Throws {@link UnfitError}.
 */
export const proveFit = (toml: string): Work<number | null> => startWork((parts) => parts.fit(toml));

/**
 * Proves that the parts fit, makes all files and packs them; if `previousToml` is a robot.toml, packs only files that
 * differ from its files.
 */
export const makeArchive = (toml: string, previousToml: string | null, progress: (progress: Progress) => void): Work<PartsArchive> =>
  startWork((parts) => parts.make(toml, previousToml, proxy(progress)));
