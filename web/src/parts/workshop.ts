// Asks a worker for the robot's parts: solids, places at a pose, and all files as one archive.
import { files } from '../files';
import { type Model, type NotMade, type Solid, Unfit } from './model';

export { Unfit };

export type Question =
  | { ask: 'model'; module: WebAssembly.Module; toml: string }
  | { ask: 'pose'; angles: number[]; lags: number[] }
  | { ask: 'fit'; module: WebAssembly.Module; toml: string }
  | { ask: 'files'; module: WebAssembly.Module; toml: string; before: string | null };

export type Answer =
  | { of: 'model'; model: Model; solids: Solid[] }
  | { of: 'pose'; places: Float64Array | null }
  | { of: 'fit'; least: number | null }
  | { of: 'progress'; doing: 'prove' | 'make'; done: number; all: number }
  | { of: 'files'; zip: Uint8Array<ArrayBuffer>; paths: string[]; count: number; least: number | null }
  | ({ of: Question['ask'] } & NotMade);

/** Progress of the making of a robot's files. */
export interface Progress {
  doing: 'prove' | 'make';
  done: number;
  all: number;
}

/** Files in an archive, and the least distance that was proved, mm. */
export interface Made {
  zip: Uint8Array<ArrayBuffer>;
  /** The paths in the archive. */
  paths: string[];
  /** The number of all files that the robot has. */
  count: number;
  least: number | null;
}

function worker(): Worker {
  return new Worker(new URL('./worker.ts', import.meta.url), { type: 'module' });
}

/** Asks a worker and calls `onAnswer` with each answer, up to the last. Throws {@link Unfit}. */
function asked<T extends Answer>(of: Worker, question: Question, onAnswer: (answer: Answer) => void = () => {}): Promise<T> {
  return new Promise((resolve, reject) => {
    const listen = ({ data }: MessageEvent<Answer>) => {
      onAnswer(data);
      if (data.of !== question.ask) return;
      of.removeEventListener('message', listen);
      if ('refused' in data) reject(new Unfit(data.refused, data.meeting));
      else resolve(data as T);
    };
    of.addEventListener('message', listen);
    of.addEventListener('error', ({ message }) => reject(new Error(message || 'the worker could not be loaded')), { once: true });
    of.postMessage(question);
  });
}

/** A robot's solids and their places at a pose. */
export class Solids {
  private readonly worker = worker();
  private asking = false;

  private constructor() {}

  /** Makes the solids of a robot.toml. Throws the message of a robot that cannot be built. */
  static async of(toml: string): Promise<{ solids: Solids; model: Model; meshes: Solid[] }> {
    const solids = new Solids();
    try {
      const question: Question = { ask: 'model', module: await files.parts(), toml };
      const { model, solids: meshes } = await asked<{ of: 'model'; model: Model; solids: Solid[] }>(solids.worker, question);
      return { solids, model, meshes };
    } catch (error) {
      solids.end();
      throw error;
    }
  }

  /** The places of all mounts; null if a loop does not close, or if another pose was requested meanwhile. */
  async pose(angles: number[], lags: number[]): Promise<Float64Array | null> {
    if (this.asking) return null;
    this.asking = true;
    try {
      const { places } = await asked<{ of: 'pose'; places: Float64Array | null }>(this.worker, { ask: 'pose', angles, lags });
      return places;
    } finally {
      this.asking = false;
    }
  }

  end(): void {
    this.worker.terminate();
  }
}

/** Proves that the parts of a robot.toml fit: the least distance of two, mm. Throws {@link Unfit}; `stop` ends it without an answer. */
export function fit(toml: string): { fits: Promise<number | null>; stop: () => void } {
  const prover = worker();
  const proved = files.parts().then((module) => asked<{ of: 'fit'; least: number | null }>(prover, { ask: 'fit', module, toml }));
  return { fits: proved.then(({ least }) => least).finally(() => prover.terminate()), stop: () => prover.terminate() };
}

/**
 * Proves that the parts fit, makes all files and packs them, or only those that are not the same for the robot `before`. `stop` ends it
 * without an answer.
 */
export function make(toml: string, before: string | null, progress: (progress: Progress) => void): { made: Promise<Made>; stop: () => void } {
  const maker = worker();
  const made = files.parts().then((module) =>
    asked<{ of: 'files' } & Made>(maker, { ask: 'files', module, toml, before }, (answer) => {
      if (answer.of === 'progress' && 'doing' in answer) progress(answer);
    }),
  );
  return { made: made.finally(() => maker.terminate()), stop: () => maker.terminate() };
}
