// What `make web` has put beside the page: robots, their images, the boot loader.

export interface RobotFile {
  /** The file's name without its end. */
  name: string;
  /** Whether it has an image. */
  image: boolean;
}

async function get(path: string): Promise<Response> {
  const response = await fetch(new URL(path, document.baseURI));
  if (!response.ok) throw new Error(`${path} is not there (${response.status}); was the page built by make web?`);
  return response;
}

const text = async (path: string): Promise<string> => (await get(path)).text();

export const files = {
  robots: async (): Promise<RobotFile[]> => (await get('files/robots.json')).json() as Promise<RobotFile[]>,
  toml: (name: string): Promise<string> => text(`files/${name}.toml`),
  image: (name: string): Promise<string> => text(`files/${name}.hex`),
  bootLoader: (): Promise<string> => text('files/optiboot.hex'),
  wasm: async (): Promise<WebAssembly.Module> => WebAssembly.compile(await (await get('files/lizard.wasm')).arrayBuffer()),
};
