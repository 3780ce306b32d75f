// The page's robot in WebAssembly, without a browser, from the page's own files.
import { readFile } from 'node:fs/promises';

import { robotOf } from '../wasm.js';
import { DIST } from './browser.js';

/** Reads a file beside the page, as bytes, or as text in an encoding. */
export const file = (name, encoding) => readFile(new URL(`files/${name}`, `file://${DIST}`), encoding);

export const robot = async () => robotOf(await file('lizard.wasm'));
