// The files that `make web` puts beside the page: robots, the firmware's code, the boot loader.
import type { Predictions } from './robot';

async function get(path: string): Promise<Response> {
  const response = await fetch(new URL(path, document.baseURI));
  if (!response.ok) throw new Error(`${path} is not there (${response.status}); was the page built by make web?`);
  return response;
}

const bytes = async (path: string): Promise<Uint8Array> => new Uint8Array(await (await get(path)).arrayBuffer());

const text = async (path: string): Promise<string> => (await get(path)).text();

const json = async <T>(path: string): Promise<T> => (await get(path)).json() as Promise<T>;

const compiled = async (path: string): Promise<WebAssembly.Module> => WebAssembly.compile(await (await get(path)).arrayBuffer());

export const files = {
  /** The names of the robots' files, without extension: of all robots, and of those that are meant for tests. */
  robots: (): Promise<{ all: string[]; tests: string[] }> => json('files/robots.json'),
  toml: (name: string): Promise<string> => text(`files/${name}.toml`),
  /** The predictions of a robot's gaits; null if the file is missing, since the page can compute them, too. */
  predictions: (name: string): Promise<Predictions | null> => json<Predictions>(`files/${name}.predictions.json`).catch(() => null),
  /** The firmware without a robot, from address 0 on. */
  code: (): Promise<Uint8Array> => bytes('files/code.bin'),
  /** The boot loader of a UNO, from its start on. */
  bootLoader: (): Promise<Uint8Array> => bytes('files/optiboot.bin'),
  wasm: (): Promise<WebAssembly.Module> => compiled('files/lizard.wasm'),
  /** The module of the robot with the search for a faster gait; loaded on demand. */
  tune: (): Promise<WebAssembly.Module> => compiled('files/tune.wasm'),
  /** The module of the robot's parts; loaded when their panel is opened. */
  parts: (): Promise<WebAssembly.Module> => compiled('files/parts.wasm'),
  /** The module that writes to boards; loaded when something is written, or a board without this firmware is identified. */
  upload: (): Promise<WebAssembly.Module> => compiled('files/upload.wasm'),
  /** The module that measures films; loaded when a camera, a film or the sheet of tags is asked for. */
  measure: (): Promise<WebAssembly.Module> => compiled('files/measure.wasm'),
};
