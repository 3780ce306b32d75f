// The robot's parts in WebAssembly: what wasm-parts/src/abi.rs exports, with types. It is run in a
// worker, since triangles and proofs take seconds.
import type { Refused } from '../robot';

export interface Body {
  name: string;
  kind: string;
  /** What it moves with, an index of the places of a pose. */
  mount: number;
  /** 0 to 3; null for what belongs to the chassis or to a side. */
  servo: number | null;
  /** The step of the guide that adds it, from 1. */
  step: number;
  /** How far the guide's exploded picture lifts it, as a share. */
  lift: number;
  /** Which of the printed parts it is; null for what is bought. */
  part: number | null;
  /** Its place in its mount's frame: the columns of a 4 x 4 matrix. */
  place: number[];
  /** Which of the solids it is. */
  solid: number;
}

export interface Part {
  name: string;
  /** The name of its files, without folder and ending. */
  file: string;
  count: number;
}

export interface Model {
  bodies: Body[];
  parts: Part[];
  /** Of the guide; the words as Markdown. */
  steps: { title: string; words: string }[];
  mounts: number;
  /** How far the soles are below the plate's top, mm. */
  floor: number;
  /** How many calls make all files. */
  files: number;
}

/** Triangles: corners in mm, and three of them each. */
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

/** Thrown for a robot of which no parts can be made; its message is the sentence. */
export class Unfit extends Error {}

export class PartsModel {
  private constructor(
    private readonly wasm: Exports,
    readonly model: Model,
  ) {}

  /** Of a robot.toml. `progress` hears what of the proof is done. Throws {@link Unfit}. */
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

  /** In the order of {@link Body.solid}. Throws {@link Unfit}. */
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

  /** Some of the files, of as many calls as the model says. Throws {@link Unfit}. */
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
  const answer = JSON.parse(new TextDecoder().decode(output(wasm))) as T | Refused;
  if (answer !== null && typeof answer === 'object' && 'refused' in answer) throw new Unfit(answer.refused);
  return answer as T;
}
