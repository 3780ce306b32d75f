// What `make web` has put beside the page: robots, the firmware's code, the boot loader.

/** A robot.toml says in the comment at its top what it is for. */
const FOR_TESTS = /\bIt is for the tests\b/;

/** Whether a robot.toml says of itself that it is for tests first of all. */
export function isForTests(toml: string): boolean {
  const lines = toml.split('\n');
  const end = lines.findIndex((line) => !line.startsWith('#'));
  return FOR_TESTS.test(lines.slice(0, Math.max(0, end)).map((line) => line.slice(1).trim()).join(' '));
}

async function get(path: string): Promise<Response> {
  const response = await fetch(new URL(path, document.baseURI));
  if (!response.ok) throw new Error(`${path} is not there (${response.status}); was the page built by make web?`);
  return response;
}

const text = async (path: string): Promise<string> => (await get(path)).text();

const compiled = async (path: string): Promise<WebAssembly.Module> => WebAssembly.compile(await (await get(path)).arrayBuffer());

export const files = {
  /** The names of the robots' files, without their ends. */
  robots: async (): Promise<string[]> => (await get('files/robots.json')).json() as Promise<string[]>,
  toml: (name: string): Promise<string> => text(`files/${name}.toml`),
  /** The firmware without a robot, as a HEX file. */
  code: (): Promise<string> => text('files/code.hex'),
  bootLoader: (): Promise<string> => text('files/optiboot.hex'),
  wasm: (): Promise<WebAssembly.Module> => compiled('files/lizard.wasm'),
  /** The same with the search of a gait, for who wants one. */
  tune: (): Promise<WebAssembly.Module> => compiled('files/tune.wasm'),
  /** The parts, which only their panel asks for. */
  parts: (): Promise<WebAssembly.Module> => compiled('files/parts.wasm'),
};
