// Access to the files that `make web` adds to the page: robots, firmware, boot loader, WebAssembly modules.
import type { Predictions } from './robot';

async function getFile(path: string): Promise<Response> {
  const response = await fetch(new URL(path, document.baseURI));
  if (!response.ok) throw new Error(`${path} is missing (status ${response.status}): build the page with make web`);
  return response;
}

const getBytes = async (path: string): Promise<Uint8Array> => new Uint8Array(await (await getFile(path)).arrayBuffer());

const getJson = async <T>(path: string): Promise<T> => (await getFile(path)).json() as Promise<T>;

/** Compiled modules by their paths; workers share them. */
const modules = new Map<string, Promise<WebAssembly.Module>>();

function compileWasm(path: string): Promise<WebAssembly.Module> {
  const compile = async () => WebAssembly.compile(await (await getFile(path)).arrayBuffer());
  const module = modules.get(path) ?? compile();
  modules.set(path, module);
  module.catch(() => modules.delete(path));
  return module;
}

export const files = {
  /** The names of the robot files without extension: of `all` robots, and of the robots for `tests`. */
  robots: (): Promise<{ all: string[]; tests: string[] }> => getJson('files/robots.json'),
  /** The robot.toml with this file name. */
  toml: async (name: string): Promise<string> => (await getFile(`files/${name}.toml`)).text(),
  /** The predictions of a robot's gaits; null if the file is missing, because the page can also compute predictions. */
  predictions: (name: string): Promise<Predictions | null> => getJson<Predictions>(`files/${name}.predictions.json`).catch(() => null),
  /** The firmware's image without a robot, from address 0. */
  firmware: (): Promise<Uint8Array> => getBytes('files/code.bin'),
  /** The UNO's boot loader, from its first byte on. */
  bootLoader: (): Promise<Uint8Array> => getBytes('files/optiboot.bin'),
  /** The WebAssembly module of the robot. */
  robotModule: (): Promise<WebAssembly.Module> => compileWasm('files/lizard.wasm'),
  /** The module of the robot with the search for a faster gait; loaded on demand. */
  searchModule: (): Promise<WebAssembly.Module> => compileWasm('files/tune.wasm'),
  /** The module of the robot's parts; loaded when their panel is opened. */
  partsModule: (): Promise<WebAssembly.Module> => compileWasm('files/parts.wasm'),
  /** The module that writes to boards, calibrates and identifies them; loaded on demand. */
  boardModule: (): Promise<WebAssembly.Module> => compileWasm('files/board.wasm'),
  /** The module that measures videos; loaded when the user opens a camera or a video, or saves the sheet of tags. */
  measureModule: (): Promise<WebAssembly.Module> => compileWasm('files/measure.wasm'),
};
