// The worker of the room Measure: tags and paths in WebAssembly, so that the page stays smooth. No picture leaves the machine.
import { expose } from 'comlink';

import { type Asked, Camera, initSync, type TagEntry } from '../../generated/measure';

/** The tags of a picture, the picture's size, and the time that it took, ms. */
export interface Sight {
  tags: TagEntry[];
  size: [number, number];
  ms: number;
}

let camera: Camera;
/** The formats of pictures whose brightness is a plane of its own. */
const PLANES = ['I420', 'I420A', 'I422', 'I444', 'NV12'];
let planes = new Uint8Array();
const canvas = new OffscreenCanvas(1, 1);
// Its pixels are read, so it is none of the graphics chip.
const pen = canvas.getContext('2d', { willReadFrequently: true });

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
function coloursOf(picture: VideoFrame | ImageBitmap, width: number, height: number): Uint8Array {
  if (!pen) throw new Error('this browser cannot read the pixels of a picture');
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
  pen.drawImage(picture, 0, 0);
  return new Uint8Array(pen.getImageData(0, 0, width, height).data.buffer);
}

/** The questions so far: the next one waits for them. */
let before: Promise<unknown> = Promise.resolve();

function inTurn<Answer>(act: () => Answer | Promise<Answer>): Promise<Answer> {
  const answer = before.then(act);
  before = answer.catch(() => {});
  return answer;
}

const functions = {
  load(module: WebAssembly.Module): void {
    initSync({ module });
    camera = new Camera();
  },

  /** Finds the tags of a picture that was taken at a time, s; one that is kept belongs to the film. */
  look: (picture: VideoFrame | ImageBitmap, seconds: number, isKept: boolean) =>
    inTurn(async (): Promise<Sight> => {
      const begun = performance.now();
      const [width, height] = 'codedWidth' in picture ? [picture.displayWidth, picture.displayHeight] : [picture.width, picture.height];
      const grey = 'codedWidth' in picture ? await greyOf(picture).catch(() => null) : null;
      const pixels = grey ?? coloursOf(picture, width, height);
      picture.close();
      return { tags: camera.look(width, height, pixels, seconds, isKept), size: [width, height], ms: performance.now() - begun };
    }),

  /** Begins a new film. */
  clear: () =>
    inTurn(() => {
      camera.free();
      camera = new Camera();
    }),

  /** Measures gaits in the film. Throws the reason where the film does not show what is needed. */
  measure: (asked: Asked) => inTurn(() => camera.measure(asked)),

  /** The sheet of tags as PDF, for A4 or for letter paper. */
  sheet: (isLetter: boolean) => Camera.sheet(isLetter) as Uint8Array<ArrayBuffer>,
};

export type FilmFunctions = typeof functions;
expose(functions);
