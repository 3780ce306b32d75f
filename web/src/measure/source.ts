// A source of pictures, a camera or a film file, that gives each picture its time on the film's clock.
import { messageOf } from '../problem';

/** Largest number of pictures of a film file that wait to be processed. */
const MAX_WAITING_PICTURES = 4;
const CAMERA_CONSTRAINTS = { video: { facingMode: 'environment', width: { ideal: 1280 }, height: { ideal: 720 }, frameRate: { ideal: 30 } }, audio: false };

/** Processes a picture that was taken at `seconds`; resolves when that is done. */
type ProcessPicture = (picture: VideoFrame | ImageBitmap, seconds: number) => Promise<void>;

export class PictureSource {
  private stream: MediaStream | null = null;
  /**
   * Number of calls of `stop`, which is also called before each new camera or film: a picture from before the last
   * call is dropped.
   */
  private generation = 0;
  private waitingPictures = 0;
  /** The page's clock minus the film's, s: the least difference so far, since the delay of a picture increases it. */
  private clockOffset = Infinity;

  constructor(
    private readonly video: HTMLVideoElement,
    private readonly processPicture: ProcessPicture,
  ) {}

  get isCamera(): boolean {
    return this.stream !== null;
  }

  /** The current time on the film's clock, s. */
  get now(): number {
    return performance.now() / 1000 - this.clockOffset;
  }

  /** Opens the rear camera; `onEnd` is called if the camera is lost. Throws an error with a message for the user. */
  async openCamera(onEnd: () => void): Promise<void> {
    this.stop();
    const { generation: startGeneration } = this;
    const { mediaDevices } = navigator as { mediaDevices?: MediaDevices };
    if (!mediaDevices) throw new Error('This page may not use a camera: open it by an address that begins with https. A film file works here, too.');
    const stream = await mediaDevices.getUserMedia(CAMERA_CONSTRAINTS).catch((error: unknown) => {
      throw new Error(cameraErrorMessage(error));
    });
    if (this.generation !== startGeneration) {
      for (const track of stream.getTracks()) track.stop();
      return;
    }
    this.stream = stream;
    stream.getVideoTracks()[0]?.addEventListener('ended', onEnd);
    this.video.srcObject = stream;
    this.processPictures(1);
    await this.video.play();
  }

  /** Plays a film file; resolves at its end. Throws an error with a message for the user. */
  async playFile(file: File): Promise<void> {
    this.stop();
    const { video, generation: startGeneration } = this;
    const address = URL.createObjectURL(file);
    try {
      const filmEnd = new Promise<void>((resolve, reject) => {
        video.onended = () => resolve();
        video.onerror = () => reject(new Error(`${file.name} is no film that this browser can play; MP4 or WebM with H.264 or VP9 will do.`));
        video.onemptied = () => this.generation !== startGeneration && resolve();
      });
      video.src = address;
      this.processPictures(MAX_WAITING_PICTURES);
      await Promise.race([video.play().then(() => filmEnd), filmEnd]);
      while (this.waitingPictures > 0 && this.generation === startGeneration) await new Promise((resolve) => setTimeout(resolve, 20));
    } finally {
      URL.revokeObjectURL(address);
    }
  }

  /** Switches the camera off, or closes the film. */
  stop(): void {
    this.generation += 1;
    this.clockOffset = Infinity;
    for (const track of this.stream?.getTracks() ?? []) track.stop();
    this.stream = null;
    this.video.srcObject = null;
    this.video.removeAttribute('src');
    this.video.load();
  }

  /**
   * Gives each picture to `processPicture` while fewer than `maxWaiting` are waiting. Otherwise a film file pauses, and
   * a camera's picture is dropped.
   */
  private processPictures(maxWaiting: number): void {
    const { video, generation: startGeneration } = this;
    this.waitingPictures = 0;
    const onPicture = (_: number, { mediaTime }: VideoFrameCallbackMetadata) => {
      if (this.generation !== startGeneration) return;
      this.clockOffset = Math.min(this.clockOffset, performance.now() / 1000 - mediaTime);
      video.requestVideoFrameCallback(onPicture);
      if (this.isCamera && this.waitingPictures >= maxWaiting) return;
      this.waitingPictures += 1;
      if (!this.isCamera && this.waitingPictures >= maxWaiting) video.pause();
      void pictureOf(video)
        .then((picture) => this.processPicture(picture, mediaTime))
        .finally(() => {
          if (this.generation !== startGeneration) return;
          this.waitingPictures -= 1;
          if (!this.isCamera && video.paused && !video.ended) void video.play();
        });
    };
    video.requestVideoFrameCallback(onPicture);
  }
}

/** Returns the picture that a video shows; it is not copied if the browser has VideoFrame. */
const pictureOf = async (video: HTMLVideoElement) => ('VideoFrame' in window ? new VideoFrame(video) : createImageBitmap(video));

/** Returns the message for the user if the camera cannot be opened. */
function cameraErrorMessage(error: unknown): string {
  const { name } = error as { name?: string };
  switch (name) {
    case 'NotAllowedError':
      return 'The browser was not allowed to use the camera. Allow it for this page in the browser\'s settings, or take a film and open it here.';
    case 'NotFoundError':
    case 'OverconstrainedError':
      return 'This machine has no camera. Take a film with another one and open it here.';
    case 'NotReadableError':
      return 'Another program uses the camera. Close it and try again.';
    default:
      return `The camera cannot be opened: ${messageOf(error)}`;
  }
}
