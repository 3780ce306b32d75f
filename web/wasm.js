// The page's robot in WebAssembly, without a browser.

/** Starts the robot of a module's bytes: `ask` asks a question of web/wasm/src/abi.rs and returns its answer. */
export async function robotOf(bytes) {
  const { instance } = await WebAssembly.instantiate(bytes, {});
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
