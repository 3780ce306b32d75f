// The worker of Workshop: the parts in WebAssembly.
import { zipSync } from 'fflate';

import { messageOf } from '../trouble';
import { PartsModel, Unfit } from './model';
import type { Answer, Question } from './workshop';

/** The model of the page; null until it is read. */
let current: PartsModel | null = null;

const say = (answer: Answer, transfer: Transferable[] = []) => postMessage(answer, { transfer });

addEventListener('message', ({ data }: MessageEvent<Question>) => {
  void answer(data).catch((error: unknown) => say({ of: data.ask, refused: messageOf(error), meeting: error instanceof Unfit ? error.meeting : null }));
});

async function answer(question: Question): Promise<void> {
  switch (question.ask) {
    case 'model': {
      current = null;
      current = await PartsModel.read(question.module, question.toml);
      const solids = current.solids();
      const transfer = solids.flatMap(({ corners, triangles }) => [corners.buffer, triangles.buffer]);
      say({ of: 'model', model: current.model, solids }, transfer);
      break;
    }
    case 'pose':
      say({ of: 'pose', places: current?.pose(question.angles, question.lags) ?? null });
      break;
    case 'fit':
      say({ of: 'fit', least: (await PartsModel.read(question.module, question.toml)).prove() });
      break;
    case 'files': {
      const { module, toml, before } = question;
      const parts = await PartsModel.read(module, toml, (done, all) => {
        say({ of: 'progress', doing: 'prove', done, all });
      });
      const least = parts.prove();
      const files = filesOf(parts);
      const count = Object.keys(files).length;
      if (before !== null) {
        const known = filesOf(await PartsModel.read(module, before));
        for (const [path, bytes] of Object.entries(known)) if (isSame(bytes, files[path])) delete files[path];
      }
      // A fixed date, so that the same files make the same archive.
      const zip = zipSync(files, { mtime: '1980-01-02T00:00:00' });
      say({ of: 'files', zip, paths: Object.keys(files), count, least }, [zip.buffer]);
    }
  }
}

/** Makes all files of a robot, by their paths. */
function filesOf(parts: PartsModel): Record<string, Uint8Array> {
  const made: Record<string, Uint8Array> = {};
  const all = parts.model.files;
  for (let number = 0; number < all; number++) {
    say({ of: 'progress', doing: 'make', done: number, all });
    for (const { path, bytes } of parts.files(number)) made[path] = bytes;
  }
  return made;
}

const isSame = (one: Uint8Array, other: Uint8Array | undefined) => one.length === other?.length && one.every((byte, at) => byte === other[at]);
