// The web worker of the room Measure: finds tags and measures gaits in WebAssembly, so that the page stays responsive.
// No frame leaves the machine.
import { expose } from 'comlink';

import { Camera, initSync, type MeasureRequest, type TagEntry } from '../../generated/measure';

/** The tags in a frame, the frame's width and height, px, and the duration of the search, ms. */
export interface Detection {
  tags: TagEntry[];
  frameSize: [number, number];
  searchMs: number;
}

let camera: Camera;
/** The pixel formats that have the brightness as their first plane. */
const LUMA_PLANE_FORMATS = ['I420', 'I420A', 'I422', 'I444', 'NV12'];
/** A buffer for the planes of a frame, reused for frames of the same size. */
let planeBuffer = new Uint8Array();
const canvas = new OffscreenCanvas(1, 1);
// Pixels are often read back, so the canvas is kept in main memory instead of the GPU.
const context = canvas.getContext('2d', { willReadFrequently: true });

/**
 * Copies the brightness plane of a frame, one byte per pixel; returns null if the frame has no such plane, or is
 * scaled, rotated or padded.
 */
async function copyLuma(frame: VideoFrame): Promise<Uint8Array | null> {
  const { format, visibleRect, displayWidth, displayHeight } = frame;
  const { rotation = 0, flip = false } = frame as { rotation?: number; flip?: boolean };
  const isUnscaled = visibleRect?.width === displayWidth && visibleRect.height === displayHeight;
  if (!format || !LUMA_PLANE_FORMATS.includes(format) || !isUnscaled || rotation !== 0 || flip) return null;
  const size = frame.allocationSize();
  if (planeBuffer.length !== size) planeBuffer = new Uint8Array(size);
  const [firstPlane] = await frame.copyTo(planeBuffer);
  return firstPlane?.offset === 0 && firstPlane.stride === displayWidth ? planeBuffer.subarray(0, displayWidth * displayHeight) : null;
}

/** Copies the pixels of a frame as RGBA, four bytes per pixel. */
function copyRgba(frame: VideoFrame | ImageBitmap, width: number, height: number): Uint8Array {
  if (!context) throw new Error('this browser cannot read the pixels of a video');
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
  context.drawImage(frame, 0, 0);
  return new Uint8Array(context.getImageData(0, 0, width, height).data.buffer);
}

/** Settles when all earlier calls have ended. */
let lastCall: Promise<unknown> = Promise.resolve();

/** Runs an action after all earlier actions. */
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

  /** Finds the tags in a frame taken at `seconds`; if `isKept`, adds the frame to the video. */
  findTags: (frame: VideoFrame | ImageBitmap, seconds: number, isKept: boolean) =>
    runInTurn(async (): Promise<Detection> => {
      const startMs = performance.now();
      const [width, height] = 'codedWidth' in frame ? [frame.displayWidth, frame.displayHeight] : [frame.width, frame.height];
      const luma = 'codedWidth' in frame ? await copyLuma(frame).catch(() => null) : null;
      const pixels = luma ?? copyRgba(frame, width, height);
      frame.close();
      return { tags: camera.findTags(width, height, pixels, seconds, isKept), frameSize: [width, height], searchMs: performance.now() - startMs };
    }),

  /** Discards the video and starts a new one. */
  clear: () =>
    runInTurn(() => {
      camera.free();
      camera = new Camera();
    }),

  /** Measures gaits in the video. Throws the reason if they cannot be measured. */
  measure: (request: MeasureRequest) => runInTurn(() => camera.measure(request)),

  /** Draws the sheet of tags as PDF, for US Letter paper if `isLetter`, otherwise for A4. */
  drawSheet: (isLetter: boolean) => Camera.drawSheet(isLetter) as Uint8Array<ArrayBuffer>,
};

export type VideoWorkerApi = typeof api;
expose(api);
