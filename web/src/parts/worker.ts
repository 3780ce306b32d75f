// The web worker that makes the robot's parts in WebAssembly. Its functions throw a `Refusal` if the parts cannot be
// made.
import { expose, transfer } from 'comlink';
import { zipSync } from 'fflate';

import { initSync, Parts } from '../../generated/parts';

/** Progress of a stage in making a robot's files: `done` of `total` steps. */
export interface Progress {
  stage: 'prove' | 'make';
  done: number;
  total: number;
}

/** The shown parts; null until they are made. */
let shownParts: Parts | null = null;

/** Makes all files of a robot; returns their bytes by path. */
function makeFiles(parts: Parts, onProgress: (progress: Progress) => void): Record<string, Uint8Array> {
  const filesByPath: Record<string, Uint8Array> = {};
  const groupCount = parts.describe().file_group_count;
  for (let index = 0; index < groupCount; index++) {
    onProgress({ stage: 'make', done: index, total: groupCount });
    for (const { path, bytes } of parts.files(index)) filesByPath[path] = bytes;
  }
  return filesByPath;
}

const areEqual = (bytes: Uint8Array, otherBytes: Uint8Array | undefined) => bytes.length === otherBytes?.length && bytes.every((byte, index) => byte === otherBytes[index]);

const api = {
  load: (module: WebAssembly.Module) => void initSync({ module }),

  /** Makes the parts to show; returns their model and solids. */
  makeModel(toml: string) {
    shownParts = null;
    shownParts = new Parts(toml);
    const solids = shownParts.solids().map(({ corners, triangles }) => ({ corners, triangles }));
    return transfer({ model: shownParts.describe(), solids }, solids.flatMap(({ corners, triangles }) => [corners.buffer, triangles.buffer]));
  },

  /** Returns the places of the shown parts' mounts; null if no parts are shown or a loop does not close. */
  computeMountPlaces: (angles: number[], lags: number[]) => shownParts?.pose(angles, lags) ?? null,

  /** Proves that a robot's parts fit; returns their smallest distance, mm, or null if no pair was checked. */
  proveFit: (toml: string) => new Parts(toml).prove(() => {}) ?? null,

  /**
   * Proves that the parts fit, makes all files and packs them. If `previousToml` is not null, packs only the files that
   * differ from the previous robot's files.
   */
  makeArchive(toml: string, previousToml: string | null, onProgress: (progress: Progress) => void) {
    const parts = new Parts(toml);
    const minDistanceMm = parts.prove((done, total) => onProgress({ stage: 'prove', done, total })) ?? null;
    const files = makeFiles(parts, onProgress);
    const fileCount = Object.keys(files).length;
    if (previousToml !== null) {
      const previousFiles = makeFiles(new Parts(previousToml), onProgress);
      for (const [path, bytes] of Object.entries(previousFiles)) if (areEqual(bytes, files[path])) delete files[path];
    }
    // With a fixed date, equal files give equal archives.
    const zip = zipSync(files, { mtime: '1980-01-02T00:00:00' }) as Uint8Array<ArrayBuffer>;
    return transfer({ zip, paths: Object.keys(files), fileCount, minDistanceMm }, [zip.buffer]);
  },
};

export type PartsWorkerApi = typeof api;
expose(api);
