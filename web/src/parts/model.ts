// Types and calls of the robot's parts in WebAssembly (wasm-parts/src/abi.rs). Runs in a worker, since
// triangles and proofs take seconds.
export interface Body {
  name: string;
  kind: string;
  /** The body that it moves with, an index of the places of a pose. */
  mount: number;
  /** The body's servo, 0 to 3; null for a body of the chassis or of a side. */
  servo: number | null;
  /** The step of the guide that adds it, from 1. */
  step: number;
  /** Lift in the guide's exploded picture, as a share. */
  lift: number;
  /** Index of the printed part; null for a bought one. */
  part: number | null;
  /** The position in the mount's frame: the columns of a 4 x 4 matrix. */
  place: number[];
  /** Index of its solid. */
  solid: number;
}

export interface Part {
  name: string;
  /** The name of its files, without folder and extension. */
  file: string;
  count: number;
}

export interface Model {
  bodies: Body[];
  parts: Part[];
  /** The steps of the guide; the words are Markdown. */
  steps: { title: string; words: string }[];
  mounts: number;
  /** Height of the plate's top above the soles, mm. */
  floor: number;
  /** Number of calls that make all files. */
  files: number;
}

/** Triangles: corners in mm, and three corner indices for each triangle. */
export interface Solid {
  corners: Float32Array;
  triangles: Uint32Array;
}

export interface File {
  path: string;
  bytes: Uint8Array;
}

interface Exports {
  memory: WebAssembly.Memory;
  parts_input(length: number): number;
  parts_output(): number;
  parts_output_length(): number;
  parts_read(): void;
  parts_solids(): number;
  parts_pose(...anglesAndLags: number[]): void;
  parts_prove(): void;
  parts_files(number: number): number;
}

/** Two parts that meet. */
export interface Meeting {
  first: string;
  second: string;
  /** Their distance, mm; below 0 they overlap. */
  mm: number;
  /** Servo angles there, deg; null if it is so at every pose, or none is known. */
  pose: number[] | null;
}

/** The refusal of a robot whose parts cannot be made, with the parts that meet, if that is why. */
export interface NotMade {
  refused: string;
  meeting: Meeting | null;
}

/** Thrown for a robot whose parts cannot be made; its message is for the user. */
export class Unfit extends Error {
  constructor(
    message: string,
    readonly meeting: Meeting | null,
  ) {
    super(message);
  }
}

export class PartsModel {
  private constructor(
    private readonly wasm: Exports,
    readonly model: Model,
  ) {}

  /** Makes the parts of a robot.toml. `progress` gets the share of the proof that is done. Throws {@link Unfit}. */
  static async read(
    module: WebAssembly.Module,
    toml: string,
    progress: (done: number, all: number) => void = () => {},
  ): Promise<PartsModel> {
    const { exports } = await WebAssembly.instantiate(module, { page: { progress } });
    const wasm = exports as unknown as Exports;
    const text = new TextEncoder().encode(toml);
    const at = wasm.parts_input(text.length);
    new Uint8Array(wasm.memory.buffer).set(text, at);
    wasm.parts_read();
    return new PartsModel(wasm, json<Model>(wasm));
  }

  /** The solids in the order of {@link Body.solid}. Throws {@link Unfit}. */
  solids(): Solid[] {
    if (!this.wasm.parts_solids()) json(this.wasm);
    const bytes = output(this.wasm).slice().buffer;
    const counts = new DataView(bytes);
    const solids: Solid[] = [];
    for (let at = 0; at < bytes.byteLength; ) {
      const [corners, triangles] = [3 * counts.getUint32(at, true), 3 * counts.getUint32(at + 4, true)];
      solids.push({
        corners: new Float32Array(bytes.slice(at + 8, at + 8 + 4 * corners)),
        triangles: new Uint32Array(bytes.slice(at + 8 + 4 * corners, at + 8 + 4 * (corners + triangles))),
      });
      at += 8 + 4 * (corners + triangles);
    }
    return solids;
  }

  /** x, y, cosine and sine of every mount, at angles and lags in deg; null where a loop does not close. */
  pose(angles: number[], lags: number[]): Float64Array | null {
    this.wasm.parts_pose(...angles, ...lags);
    const bytes = output(this.wasm);
    return bytes.length === 0 ? null : new Float64Array(bytes.slice().buffer);
  }

  /** Proves that no two parts meet; the least distance, mm. Throws {@link Unfit}. */
  prove(): number | null {
    this.wasm.parts_prove();
    return json<{ least: number | null }>(this.wasm).least;
  }

  /** Makes some of the files; `number` counts the calls that the model asks for. Throws {@link Unfit}. */
  files(number: number): File[] {
    if (!this.wasm.parts_files(number)) json(this.wasm);
    const bytes = output(this.wasm).slice();
    const lengths = new DataView(bytes.buffer);
    let at = 0;
    const piece = () => {
      const length = lengths.getUint32(at, true);
      at += 4 + length;
      return bytes.subarray(at - length, at);
    };
    const files: File[] = [];
    while (at < bytes.length) files.push({ path: new TextDecoder().decode(piece()), bytes: piece() });
    return files;
  }
}

const output = (wasm: Exports) =>
  new Uint8Array(wasm.memory.buffer, wasm.parts_output(), wasm.parts_output_length());

function json<T>(wasm: Exports): T {
  const answer = JSON.parse(new TextDecoder().decode(output(wasm))) as T | NotMade;
  if (answer !== null && typeof answer === 'object' && 'refused' in answer) throw new Unfit(answer.refused, answer.meeting);
  return answer as T;
}
