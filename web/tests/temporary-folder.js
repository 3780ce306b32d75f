// Temporary folders of tests.
import { mkdtemp, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after } from 'node:test';

/** Makes a folder that is removed after the test that makes it, or after all tests of the file. */
export async function makeFolder() {
  const folder = await mkdtemp(join(tmpdir(), 'lizard-'));
  after(() => rm(folder, { recursive: true, force: true }));
  return folder;
}
