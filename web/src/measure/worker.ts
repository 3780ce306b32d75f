// The web worker of the room Measure, which finds tags and measures gaits in WebAssembly, so that the page stays
// responsive. No picture leaves the machine.
import { expose } from 'comlink';

import { Camera, initSync, type MeasureRequest, type TagEntry } from '../../generated/measure';

/** The tags found in a picture, the picture's width and height, px, and the time that the search took, ms. */
export interface Detection {
  tags: TagEntry[];
  size: [number, number];
  searchMs: number;
}

let camera: Camera;
/** The pixel formats that have the brightness as their first plane. */
const LUMA_PLANE_FORMATS = ['I420', 'I420A', 'I422', 'I444', 'NV12'];
/** A buffer for the planes of a picture, reused for pictures of the same size. */
let planes = new Uint8Array();
const canvas = new OffscreenCanvas(1, 1);
// The pixels are read back often, so the canvas is kept in main memory and not on the GPU.
const context = canvas.getContext('2d', { willReadFrequently: true });

/**
 * Returns the brightness plane of a picture, a byte for each pixel; null if it has no such plane, or is scaled,
 * rotated or padded.
 */
async function lumaOf(picture: VideoFrame): Promise<Uint8Array | null> {
  const { format, visibleRect, displayWidth, displayHeight } = picture;
  const { rotation = 0, flip = false } = picture as { rotation?: number; flip?: boolean };
  const isUnscaled = visibleRect?.width === displayWidth && visibleRect.height === displayHeight;
  if (!format || !LUMA_PLANE_FORMATS.includes(format) || !isUnscaled || rotation !== 0 || flip) return null;
  const size = picture.allocationSize();
  if (planes.length !== size) planes = new Uint8Array(size);
  const [firstPlane] = await picture.copyTo(planes);
  return firstPlane?.offset === 0 && firstPlane.stride === displayWidth ? planes.subarray(0, displayWidth * displayHeight) : null;
}

/** Returns the pixels of a picture as RGBA, four bytes each. */
function rgbaOf(picture: VideoFrame | ImageBitmap, width: number, height: number): Uint8Array {
  if (!context) throw new Error('this browser cannot read the pixels of a picture');
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
  context.drawImage(picture, 0, 0);
  return new Uint8Array(context.getImageData(0, 0, width, height).data.buffer);
}

/** Settles when all earlier calls are done. */
let lastCall: Promise<unknown> = Promise.resolve();

/** Runs an action after all earlier ones. */
function runInTurn<Result>(action: () => Result | Promise<Result>): Promise<Result> {
  const result = lastCall.then(action);
  lastCall = result.catch(() => {});
  return result;
}

const api = {
  /** Loads the WebAssembly module; must be called first. */
  load(module: WebAssembly.Module): void {
    initSync({ module });
    camera = new Camera();
  },

  /** Finds the tags of a picture taken at `seconds`; if `isKept`, the picture is added to the film. */
  findTags: (picture: VideoFrame | ImageBitmap, seconds: number, isKept: boolean) =>
    runInTurn(async (): Promise<Detection> => {
      const startMs = performance.now();
      const [width, height] = 'codedWidth' in picture ? [picture.displayWidth, picture.displayHeight] : [picture.width, picture.height];
      const luma = 'codedWidth' in picture ? await lumaOf(picture).catch(() => null) : null;
      const pixels = luma ?? rgbaOf(picture, width, height);
      picture.close();
      return { tags: camera.findTags(width, height, pixels, seconds, isKept), size: [width, height], searchMs: performance.now() - startMs };
    }),

  /** Discards the film and starts a new one. */
  clear: () =>
    runInTurn(() => {
      camera.free();
      camera = new Camera();
    }),

  /** Measures gaits in the film. Throws the reason if they cannot be measured. */
  measure: (request: MeasureRequest) => runInTurn(() => camera.measure(request)),

  /** Returns the sheet of tags as PDF, for US Letter paper if `isLetter`, else for A4. */
  sheet: (isLetter: boolean) => Camera.sheet(isLetter) as Uint8Array<ArrayBuffer>,
};

export type FilmWorkerApi = typeof api;
expose(api);
