// Loads the page's WebAssembly into Node from the built page, for tests that need no browser.
import { readFile } from 'node:fs/promises';

import { initSync, Robot } from '../generated/lizard.js';
import { DIST } from './browser.js';

/** Reads a file of the page: as bytes, or as text if an encoding is given. */
export const readPageFile = (name, encoding) => readFile(new URL(`files/${name}`, `file://${DIST}`), encoding);

export const { memory } = initSync({ module: await readPageFile('lizard.wasm') });
export { Robot };
