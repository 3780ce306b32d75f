// The page's robot in WebAssembly, without a browser, from the files that the page is served with.
import { readFile } from 'node:fs/promises';

import { robotOf } from '../wasm.js';
import { DIST } from './browser.js';

/** A file beside the page; bytes, or text in an encoding. */
export const file = (name, encoding) => readFile(new URL(`files/${name}`, `file://${DIST}`), encoding);

export const robot = async () => robotOf(await file('lizard.wasm'));
