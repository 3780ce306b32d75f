// The files that `make web` puts beside the page: robots, the firmware's code, the boot loader.
import type { Predictions } from './robot';

async function getFile(path: string): Promise<Response> {
  const response = await fetch(new URL(path, document.baseURI));
  if (!response.ok) throw new Error(`${path} is not there (${response.status}); was the page built by make web?`);
  return response;
}

const getBytes = async (path: string): Promise<Uint8Array> => new Uint8Array(await (await getFile(path)).arrayBuffer());

const getText = async (path: string): Promise<string> => (await getFile(path)).text();

const getJson = async <T>(path: string): Promise<T> => (await getFile(path)).json() as Promise<T>;

/** Modules by their paths: workers share what the browser has compiled. */
const modules = new Map<string, Promise<WebAssembly.Module>>();

function compileWasm(path: string): Promise<WebAssembly.Module> {
  const compile = async () => WebAssembly.compile(await (await getFile(path)).arrayBuffer());
  const module = modules.get(path) ?? compile();
  modules.set(path, module);
  module.catch(() => modules.delete(path));
  return module;
}

export const files = {
  /** The names of the robots' files, without extension: of all robots, and of those that are meant for tests. */
  robots: (): Promise<{ all: string[]; tests: string[] }> => getJson('files/robots.json'),
  /** The robot.toml of a robot, by the name of its file. */
  toml: (name: string): Promise<string> => getText(`files/${name}.toml`),
  /** The predictions of a robot's gaits; null if the file is missing, since the page can compute them, too. */
  predictions: (name: string): Promise<Predictions | null> => getJson<Predictions>(`files/${name}.predictions.json`).catch(() => null),
  /** The firmware without a robot, from address 0 on. */
  code: (): Promise<Uint8Array> => getBytes('files/code.bin'),
  /** The boot loader of a UNO, from its start on. */
  bootLoader: (): Promise<Uint8Array> => getBytes('files/optiboot.bin'),
  /** The module of the robot itself. */
  wasm: (): Promise<WebAssembly.Module> => compileWasm('files/lizard.wasm'),
  /** The module of the robot with the search for a faster gait; loaded on demand. */
  tune: (): Promise<WebAssembly.Module> => compileWasm('files/tune.wasm'),
  /** The module of the robot's parts; loaded when their panel is opened. */
  parts: (): Promise<WebAssembly.Module> => compileWasm('files/parts.wasm'),
  /** The module that writes to boards and calibrates them; loaded for that, or to identify a board without this firmware. */
  board: (): Promise<WebAssembly.Module> => compileWasm('files/board.wasm'),
  /** The module that measures films; loaded when a camera, a film or the sheet of tags is asked for. */
  measure: (): Promise<WebAssembly.Module> => compileWasm('files/measure.wasm'),
};
