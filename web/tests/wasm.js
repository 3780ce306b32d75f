// The page's robot in WebAssembly, without a browser, from the page's own files.
import { readFile } from 'node:fs/promises';

import { initSync, Robot } from '../generated/lizard.js';
import { DIST } from './browser.js';

/** Reads a file of the page: as bytes, or as text if an encoding is given. */
export const readPageFile = (name, encoding) => readFile(new URL(`files/${name}`, `file://${DIST}`), encoding);

export const { memory } = initSync({ module: await readPageFile('lizard.wasm') });
export { Robot };
