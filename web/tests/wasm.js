// The page's robot in WebAssembly, without a browser, from the files that the page is served with.
import { readFile } from 'node:fs/promises';

import { DIST } from './browser.js';

/** A file beside the page; bytes, or text in an encoding. */
export const file = (name, encoding) => readFile(new URL(`files/${name}`, `file://${DIST}`), encoding);

/** The robot: `ask` asks a question of web/wasm/src/abi.rs and returns its answer. */
export async function robot() {
  const { instance } = await WebAssembly.instantiate(await file('lizard.wasm'), {});
  const wasm = instance.exports;
  const ask = (question, needs = null) => {
    const bytes = new TextEncoder().encode(JSON.stringify({ [question]: needs }));
    const at = wasm.lizard_input(bytes.length);
    new Uint8Array(wasm.memory.buffer).set(bytes, at);
    const length = wasm.lizard_ask();
    return JSON.parse(new TextDecoder().decode(new Uint8Array(wasm.memory.buffer, wasm.lizard_output(), length)));
  };
  return { memory: wasm.memory, ask };
}
