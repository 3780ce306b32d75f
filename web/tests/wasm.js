// The page's robot in WebAssembly, without a browser, from the files that the page is served with.
import { readFile } from 'node:fs/promises';

import { DIST } from './browser.js';

/** A file beside the page; bytes, or text in an encoding. */
export const file = (name, encoding) => readFile(new URL(`files/${name}`, `file://${DIST}`), encoding);

/** The robot: `call` writes an input, calls a function of web/wasm/src/abi.rs and returns the bytes that it answers. */
export async function robot() {
  const { instance } = await WebAssembly.instantiate(await file('lizard.wasm'), {});
  const wasm = instance.exports;
  const call = (name, input = '', ...numbers) => {
    const bytes = new TextEncoder().encode(input);
    const at = wasm.lizard_input(bytes.length);
    new Uint8Array(wasm.memory.buffer).set(bytes, at);
    wasm[name](...numbers);
    return new Uint8Array(wasm.memory.buffer, wasm.lizard_output(), wasm.lizard_output_length()).slice();
  };
  const said = (...question) => JSON.parse(new TextDecoder().decode(call(...question)));
  return { memory: wasm.memory, call, said };
}
