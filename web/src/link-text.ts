// A robot as a link: its compressed robot.toml in the fragment of the page's address, which no server sees.

/** Size of the largest robot.toml that is accepted, bytes; a typical one has a few thousand. */
const MAX_BYTES = 200_000;

async function pipe(bytes: Uint8Array<ArrayBuffer>, stream: CompressionStream | DecompressionStream): Promise<Uint8Array<ArrayBuffer>> {
  const output = new Blob([bytes]).stream().pipeThrough(stream);
  const reader = output.getReader();
  const chunks: BlobPart[] = [];
  let length = 0;
  for (let chunk = await reader.read(); !chunk.done; chunk = await reader.read()) {
    length += chunk.value.length;
    if (length > MAX_BYTES) throw new Error('the robot in this address is too large');
    chunks.push(chunk.value);
  }
  return new Uint8Array(await new Blob(chunks).arrayBuffer());
}

/** Compresses a robot.toml to the parameter `robot` of an address. */
export async function pack(toml: string): Promise<string> {
  const bytes = await pipe(new TextEncoder().encode(toml), new CompressionStream('deflate-raw'));
  const base64 = btoa(String.fromCharCode(...bytes));
  // base64url, which needs no escapes in an address.
  return base64.replaceAll('+', '-').replaceAll('/', '_').replaceAll('=', '');
}

/**
 * Returns a robot.toml without its comments, which would be most of a link's characters. Returns the text unchanged if
 * it would parse to other values without them, for example because of a # in a multi-line string.
 */
async function stripComments(toml: string): Promise<string> {
  const { parse } = await import('smol-toml');
  const shortText = toml.replaceAll(/^[ \t]*#.*\n/gm, '').replaceAll(/[ \t]+#[^"'\n]*$/gm, '');
  return JSON.stringify(parse(shortText)) === JSON.stringify(parse(toml)) ? shortText : toml;
}

/** Returns a link that opens this page with a robot, short enough for a chat or a QR code. */
export async function linkTo(toml: string): Promise<string> {
  return `${location.href.split('#')[0]}#robot=${await pack(await stripComments(toml))}`;
}

/** Reads the robot.toml from the parameter `robot` of an address. Throws an error with a message for the user. */
export async function unpack(encoded: string): Promise<string> {
  try {
    const base64 = atob(encoded.replaceAll('-', '+').replaceAll('_', '/'));
    const bytes = Uint8Array.from(base64, (character) => character.charCodeAt(0));
    return new TextDecoder('utf-8', { fatal: true }).decode(await pipe(bytes, new DecompressionStream('deflate-raw')));
  } catch {
    throw new Error('The robot in the address is incomplete; was the whole link copied?');
  }
}
