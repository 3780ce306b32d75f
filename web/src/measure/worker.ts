// The worker of Film: tags and paths in WebAssembly, so that the page stays smooth.
import { messageOf } from '../trouble';
import type { Answer, Question, Sight, Tag } from './question';

interface Exports {
  memory: WebAssembly.Memory;
  measure_input(length: number): number;
  measure_output(): number;
  measure_output_length(): number;
  measure_picture(width: number, height: number, isGrey: boolean, seconds: number, isKept: boolean): void;
  measure_ask(): void;
  measure_sheet(isLetter: boolean): void;
}

let wasm: Promise<Exports>;
/** The answers so far: a question waits for them. */
let before: Promise<unknown> = Promise.resolve();
/** The formats of pictures whose brightness is a plane of its own. */
const PLANES = ['I420', 'I420A', 'I422', 'I444', 'NV12'];
let planes = new Uint8Array();
const canvas = new OffscreenCanvas(1, 1);
// Its pixels are read, so it is none of the graphics chip.
const pen = canvas.getContext('2d', { willReadFrequently: true });

addEventListener('message', ({ data }: MessageEvent<WebAssembly.Module | Question>) => {
  if (data instanceof WebAssembly.Module) wasm = WebAssembly.instantiate(data, {}).then(({ exports }) => exports as unknown as Exports);
  else before = before.then(() => answer(data)).then((well): Answer => ({ well }), (error: unknown): Answer => ({ refused: messageOf(error) })).then((said) => postMessage(said));
});

async function answer(question: Question): Promise<unknown> {
  const exports = await wasm;
  switch (question.ask) {
    case 'picture':
      return look(exports, question);
    case 'sheet':
      exports.measure_sheet(question.isLetter);
      return output(exports).slice();
    case 'clear':
      return ask(exports, 'clear');
    case 'measure':
      return ask(exports, { measure: question.asked });
  }
}

async function look(exports: Exports, { picture, seconds, isKept }: Question & { ask: 'picture' }): Promise<Sight> {
  const begun = performance.now();
  const [width, height] = 'codedWidth' in picture ? [picture.displayWidth, picture.displayHeight] : [picture.width, picture.height];
  const grey = 'codedWidth' in picture ? await greyOf(picture).catch(() => null) : null;
  input(exports, grey ?? coloursOf(picture, width, height));
  picture.close();
  exports.measure_picture(width, height, grey !== null, seconds, isKept);
  return { tags: json<Tag[]>(exports), size: [width, height], ms: performance.now() - begun };
}

/** The brightness of each pixel, which a camera or a film has as a plane of its own; null if this picture has none, or is turned. */
async function greyOf(picture: VideoFrame): Promise<Uint8Array | null> {
  const { format, visibleRect, displayWidth, displayHeight } = picture;
  const { rotation = 0, flip = false } = picture as { rotation?: number; flip?: boolean };
  const isWhole = visibleRect?.width === displayWidth && visibleRect.height === displayHeight;
  if (!format || !PLANES.includes(format) || !isWhole || rotation !== 0 || flip) return null;
  const size = picture.allocationSize();
  if (planes.length !== size) planes = new Uint8Array(size);
  const [first] = await picture.copyTo(planes);
  return first?.offset === 0 && first.stride === displayWidth ? planes.subarray(0, displayWidth * displayHeight) : null;
}

/** The pixels of a picture, four bytes for each. */
function coloursOf(picture: VideoFrame | ImageBitmap, width: number, height: number): Uint8ClampedArray {
  if (!pen) throw new Error('this browser cannot read the pixels of a picture');
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
  pen.drawImage(picture, 0, 0);
  return pen.getImageData(0, 0, width, height).data;
}

function ask(exports: Exports, question: unknown): unknown {
  input(exports, new TextEncoder().encode(JSON.stringify(question)));
  exports.measure_ask();
  return json(exports);
}

function input({ measure_input, memory }: Exports, bytes: ArrayLike<number> & { length: number }): void {
  const at = measure_input(bytes.length);
  new Uint8Array(memory.buffer).set(bytes, at);
}

const output = ({ memory, measure_output, measure_output_length }: Exports) => new Uint8Array(memory.buffer, measure_output(), measure_output_length());

function json<T>(exports: Exports): T {
  const said = JSON.parse(new TextDecoder().decode(output(exports))) as T | { refused: string };
  if (said !== null && typeof said === 'object' && 'refused' in said) throw new Error(said.refused);
  return said as T;
}
