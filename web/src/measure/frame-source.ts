// A source of frames, a camera or a video file, that gives each frame its time on the video's clock.
import { getMessage } from '../problem';

/** Largest number of pending frames of a video file. */
const MAX_PENDING_FRAMES = 4;
const CAMERA_CONSTRAINTS = { video: { facingMode: 'environment', width: { ideal: 1280 }, height: { ideal: 720 }, frameRate: { ideal: 30 } }, audio: false };
const NO_CAMERA_MESSAGE = 'This machine has no camera. Record a video with another camera and open it here.';
/** The messages for the user if the camera cannot be opened, by the names of the errors. */
const CAMERA_MESSAGES: Record<string, string | undefined> = {
  NotAllowedError: 'The browser was not allowed to use the camera. Allow the camera for this page in the browser\'s settings, or record a video and open it here.',
  NotFoundError: NO_CAMERA_MESSAGE,
  OverconstrainedError: NO_CAMERA_MESSAGE,
  NotReadableError: 'Another program uses the camera. Close that program and try again.',
};

/** Processes a frame that was taken at `seconds`; resolves when the frame is processed. */
type ProcessFrame = (frame: VideoFrame | ImageBitmap, seconds: number) => Promise<void>;

export class FrameSource {
  private stream: MediaStream | null = null;
  /**
   * Number of calls of `stop`, which is also called before each new camera or video. A frame from before the last call
   * is dropped.
   */
  private generation = 0;
  private pendingFrameCount = 0;
  /** The page's clock minus the video's, s: the smallest difference so far, because a frame's delay increases it. */
  private clockOffset = Infinity;

  constructor(
    private readonly video: HTMLVideoElement,
    private readonly processFrame: ProcessFrame,
  ) {}

  get isCamera(): boolean {
    return this.stream !== null;
  }

  /** The current time on the video's clock, s. */
  get now(): number {
    return performance.now() / 1000 - this.clockOffset;
  }

  /** Opens the rear camera; `onEnd` is called if the camera is lost. Throws an error with a message for the user. */
  async openCamera(onEnd: () => void): Promise<void> {
    this.stop();
    const { generation: startGeneration } = this;
    const { mediaDevices } = navigator as { mediaDevices?: MediaDevices };
    if (!mediaDevices) throw new Error('This page may not use a camera: open it with an address that begins with https, or open a video file.');
    const stream = await mediaDevices.getUserMedia(CAMERA_CONSTRAINTS).catch((error: unknown) => {
      const { name = '' } = error as { name?: string };
      throw new Error(CAMERA_MESSAGES[name] ?? `The camera cannot be opened: ${getMessage(error)}`);
    });
    if (this.generation !== startGeneration) {
      for (const track of stream.getTracks()) track.stop();
      return;
    }
    this.stream = stream;
    stream.getVideoTracks()[0]?.addEventListener('ended', onEnd);
    this.video.srcObject = stream;
    this.processFrames(1);
    await this.play();
  }

  /** Plays a video file; resolves at its end. Throws an error with a message for the user. */
  async playFile(file: File): Promise<void> {
    this.stop();
    const { video, generation: startGeneration } = this;
    const address = URL.createObjectURL(file);
    try {
      const videoEnd = new Promise<void>((resolve, reject) => {
        video.onended = () => resolve();
        video.onerror = () => reject(new Error(`${file.name} is not a video that this browser can play: MP4 or WebM with H.264 or VP9 is required.`));
        video.onemptied = () => this.generation !== startGeneration && resolve();
      });
      video.src = address;
      this.processFrames(MAX_PENDING_FRAMES);
      await Promise.race([this.play().then(() => videoEnd), videoEnd]);
      while (this.pendingFrameCount > 0 && this.generation === startGeneration) await new Promise((resolve) => setTimeout(resolve, 20));
    } finally {
      URL.revokeObjectURL(address);
    }
  }

  /** Plays the video; also resolves if `stop` is called before it plays. */
  private async play(): Promise<void> {
    const { generation: startGeneration } = this;
    await this.video.play().catch((error: unknown) => {
      if (this.generation === startGeneration) throw error;
    });
  }

  /** Switches the camera off, or closes the video. */
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
   * Passes each frame to `processFrame` while fewer than `maxPending` frames are pending. Otherwise a video file
   * pauses, and a camera's frame is dropped.
   */
  private processFrames(maxPending: number): void {
    const { video, generation: startGeneration } = this;
    this.pendingFrameCount = 0;
    const onFrame = (_: number, { mediaTime }: VideoFrameCallbackMetadata) => {
      if (this.generation !== startGeneration) return;
      this.clockOffset = Math.min(this.clockOffset, performance.now() / 1000 - mediaTime);
      video.requestVideoFrameCallback(onFrame);
      if (this.isCamera && this.pendingFrameCount >= maxPending) return;
      this.pendingFrameCount += 1;
      if (!this.isCamera && this.pendingFrameCount >= maxPending) video.pause();
      void captureFrame(video)
        .then((frame) => this.processFrame(frame, mediaTime))
        .finally(() => {
          if (this.generation !== startGeneration) return;
          this.pendingFrameCount -= 1;
          if (!this.isCamera && video.paused && !video.ended) void this.play();
        });
    };
    video.requestVideoFrameCallback(onFrame);
  }
}

/** Captures the current frame of a video; browsers with VideoFrame do not copy it. */
const captureFrame = async (video: HTMLVideoElement) => ('VideoFrame' in window ? new VideoFrame(video) : createImageBitmap(video));
