// A robot as a link: its robot.toml, compressed, after the # of the page's address, where no server sees it.

/** The largest robot.toml that is accepted, in bytes; typical ones have a few thousand. */
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

/** Compresses a robot.toml to the part `robot` of an address. */
export async function pack(toml: string): Promise<string> {
  const bytes = await pipe(new TextEncoder().encode(toml), new CompressionStream('deflate-raw'));
  const letters = btoa(String.fromCharCode(...bytes));
  // base64url, which needs no escapes in an address.
  return letters.replaceAll('+', '-').replaceAll('/', '_').replaceAll('=', '');
}

/**
 * Returns a robot.toml without its comments, which would be most of a link's letters. Returns it unchanged if the
 * text without comments would parse to other values, as with a # in a text of several lines.
 */
async function withoutComments(toml: string): Promise<string> {
  const { parse } = await import('smol-toml');
  const shortText = toml.replaceAll(/^[ \t]*#.*\n/gm, '').replaceAll(/[ \t]+#[^"'\n]*$/gm, '');
  return JSON.stringify(parse(shortText)) === JSON.stringify(parse(toml)) ? shortText : toml;
}

/** Returns a link to this page that opens a robot, without comments, short enough for a chat or a QR code. */
export async function linkTo(toml: string): Promise<string> {
  return `${location.href.split('#')[0]}#robot=${await pack(await withoutComments(toml))}`;
}

/** Reads the robot.toml from the part `robot` of an address. Throws an error for the user. */
export async function unpack(encoded: string): Promise<string> {
  try {
    const letters = atob(encoded.replaceAll('-', '+').replaceAll('_', '/'));
    const bytes = Uint8Array.from(letters, (letter) => letter.charCodeAt(0));
    return new TextDecoder('utf-8', { fatal: true }).decode(await pipe(bytes, new DecompressionStream('deflate-raw')));
  } catch {
    throw new Error('The robot in the address is incomplete; was the whole link copied?');
  }
}
