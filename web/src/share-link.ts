// A robot as a link: the compressed robot.toml in the fragment of the page's address, which no server receives.

/** Largest accepted size of a robot.toml, bytes; a typical robot.toml is a few thousand bytes long. */
const MAX_BYTES = 200_000;

/**
 * Compresses or decompresses; throws a RangeError with a message for the user if the input or the output exceeds
 * `MAX_BYTES`.
 */
async function pipeThrough(bytes: Uint8Array<ArrayBuffer>, stream: CompressionStream | DecompressionStream): Promise<Uint8Array<ArrayBuffer>> {
  const output = new Blob([bytes]).stream().pipeThrough(stream);
  const reader = output.getReader();
  const chunks: BlobPart[] = [];
  let length = 0;
  for (let chunk = await reader.read(); !chunk.done; chunk = await reader.read()) {
    length += chunk.value.length;
    if (Math.max(bytes.length, length) > MAX_BYTES) throw new RangeError(`A robot.toml of more than ${MAX_BYTES / 1000} kB does not fit into a link.`);
    chunks.push(chunk.value);
  }
  return new Uint8Array(await new Blob(chunks).arrayBuffer());
}

/** Compresses a robot.toml for the parameter `robot` of an address. */
export async function pack(toml: string): Promise<string> {
  const bytes = await pipeThrough(new TextEncoder().encode(toml), new CompressionStream('deflate-raw'));
  const base64 = btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(''));
  // base64url needs no escapes in an address.
  return base64.replaceAll('+', '-').replaceAll('/', '_').replaceAll('=', '');
}

/**
 * Returns a robot.toml without comments, which would make up most of a link. Returns the text unchanged if the shorter
 * text would parse to other values, for example because of a # in a multi-line string.
 */
async function stripComments(toml: string): Promise<string> {
  const { parse } = await import('smol-toml');
  const shortText = toml.replaceAll(/^[ \t]*#.*\n/gm, '').replaceAll(/[ \t]+#[^"'\n]*$/gm, '');
  return JSON.stringify(parse(shortText)) === JSON.stringify(parse(toml)) ? shortText : toml;
}

/** Makes a link that opens this page with a robot, short enough for a chat or a QR code. */
export async function makeLink(toml: string): Promise<string> {
  return `${location.href.split('#')[0]}#robot=${await pack(await stripComments(toml))}`;
}

/** Decompresses the parameter `robot` of an address to a robot.toml. Throws an error with a message for the user. */
export async function unpack(encoded: string): Promise<string> {
  // Fails in a browser that cannot decompress.
  const stream = new DecompressionStream('deflate-raw');
  try {
    const base64 = atob(encoded.replaceAll('-', '+').replaceAll('_', '/'));
    const bytes = Uint8Array.from(base64, (character) => character.charCodeAt(0));
    return new TextDecoder('utf-8', { fatal: true }).decode(await pipeThrough(bytes, stream));
  } catch (error) {
    if (error instanceof RangeError) throw error;
    throw new Error('The robot in the address is incomplete; was the whole link copied?');
  }
}
