// The panel that records runs, saves pictures and videos, and makes a second robot walk next to the page's robot.
import { Companion } from '../companion';
import { restartWithGait } from '../gaits/apply-gait';
import { MAX_RECORDING_SECONDS, Recording } from '../recording';
import { type Bars, type Description, type Four, type Frame, Robot } from '../robot';
import type { Session } from '../session';
import { FRAME_SECONDS } from '../shown-robot';
import { getMessage } from '../problem';
import { WORDS } from '../words';
import { saveFile } from './download';
import { formatDisplacement } from './drive';
import type { FloorView } from './floor';
import { element, makeSvg, replaceOptions, setText } from './elements';
import { getPalette } from './palette';
import { isShown } from './rooms';

/** MIME types of videos with their file extensions, in order of preference: smallest files first. */
const VIDEO_FORMATS = [
  { type: 'video/webm;codecs=vp9', extension: 'webm' },
  { type: 'video/webm;codecs=vp8', extension: 'webm' },
  { type: 'video/webm', extension: 'webm' },
  { type: 'video/mp4', extension: 'mp4' },
];

/** Two robots that walk side by side; the page's robot is the first. */
interface RobotPair {
  /** The robot.toml of the second robot. */
  toml: string;
  /** The commands that start the robots' gaits. */
  gaits: [string, string];
  /** The robots' names in the comparison. */
  names: [string, string];
  /** The element that shows the comparison. */
  output: HTMLElement;
}

export class RecordView {
  private readonly timeSlider = element<HTMLInputElement>('moment');
  private readonly firstGaitList = element<HTMLSelectElement>('mine');
  private readonly secondGaitList = element<HTMLSelectElement>('other');
  private recording: Recording | null = null;
  private isRecording = false;
  /**
   * The running replay: `startedAt` is its start on the page's clock, ms, and `startTime` its start in the recording,
   * s. Null while the replay is paused or off.
   */
  private playback: { startedAt: number; startTime: number } | null = null;
  private isReplaying = false;
  private video: MediaRecorder | null = null;
  /** The second robot; null for none. */
  private companion: Companion | null = null;
  private pair: RobotPair | null = null;
  /** True until the robot starts its gait; the companion starts at the same time. */
  private isWaiting = false;
  /** Time that the companion is behind the robot, s. */
  private pendingSeconds = 0;
  /** Saves the requested picture after the next drawing of the floor; null if none is requested. */
  private saveRequestedPicture: (() => void) | null = null;

  constructor(
    private readonly session: Session,
    private readonly floor: FloorView,
  ) {
    const onClick = (id: string, action: () => void) => element(id).addEventListener('click', action);
    onClick('record', () => this.setRecording(!this.isRecording));
    onClick('replay', () => this.setReplaying(!this.isReplaying));
    onClick('csv', () => this.recording && saveFile('run.csv', [this.recording.formatCsv()], 'text/csv'));
    onClick('png', () => this.requestPicture(() => void this.savePng()));
    onClick('svg', () => this.requestPicture(() => void this.saveSvg()));
    onClick('video', () => this.toggleVideo());
    onClick('both', () => void this.startBoth(this.makePair()));
    onClick('alone', () => this.removeCompanion());
    this.timeSlider.addEventListener('input', () => {
      this.isReplaying = true;
      this.playback = null;
      this.updateButtons();
    });
    this.updateButtons();
    session.robot.follow((description) => this.showRobot(description));
    session.state.gait.subscribe((gait) => this.followGait(gait));
  }

  /** Shows another robot, and drops the recording of the previous one. */
  private showRobot({ gaits }: Description): void {
    this.setRecording(false);
    this.recording = null;
    this.isReplaying = false;
    this.removeCompanion();
    const makeOptions = () => gaits.map(({ command }) => new Option(command));
    const movingCommands = gaits.filter(({ moves }) => moves).map(({ command }) => command);
    const [firstMoving = '', secondMoving = firstMoving] = movingCommands;
    if (!replaceOptions(this.firstGaitList, makeOptions())) this.firstGaitList.value = secondMoving;
    if (!replaceOptions(this.secondGaitList, makeOptions())) this.secondGaitList.value = firstMoving;
    this.setMessage('');
    this.updateButtons();
  }

  /** Adds a frame, which lasts `seconds`, to the recording, and advances the companion. */
  addFrame(frame: Frame, widths: Four<number> | null, seconds: number): void {
    if (this.isRecording && this.recording && !this.recording.add(frame, widths, this.session.board.gait, seconds)) {
      this.setRecording(false);
      this.setMessage(`The recording is full: ${MAX_RECORDING_SECONDS} s.`);
    }
    if (!this.companion || this.isWaiting) return;
    for (this.pendingSeconds += seconds; this.pendingSeconds > FRAME_SECONDS / 2; this.pendingSeconds -= FRAME_SECONDS) this.companion.step();
    const place = this.companion.frame?.place;
    if (place) this.floor.addToTrack(place, true);
  }

  /** Starts or stops the companion together with the robot; `gait` is the robot's new activity. */
  private followGait(gait: string): void {
    const { companion, pair, isWaiting } = this;
    if (!companion || !pair) return;
    if (isWaiting && gait === pair.gaits[0]) {
      companion.send(pair.gaits[1]);
      this.isWaiting = false;
    } else if (!isWaiting && gait === WORDS.stop) companion.send(WORDS.stop);
  }

  /** Chooses the frame to draw: the current frame, or the replay's frame. */
  chooseFrame(current: Frame | null): Frame | null {
    const { recording } = this;
    if (!this.isReplaying || !recording) return current;
    if (this.playback) {
      const time = this.playback.startTime + (performance.now() - this.playback.startedAt) / 1000;
      this.timeSlider.value = String(time);
      if (time >= recording.duration) this.playback = null;
    }
    return recording.frameAt(this.timeSlider.valueAsNumber)?.frame ?? current;
  }

  /** The companion's current frame; null if there is none. */
  get companionFrame(): Frame | null {
    return this.companion?.frame ?? null;
  }

  /** Saves the requested picture, if any; called after each drawing of the floor. */
  finishDrawing(): void {
    this.saveRequestedPicture?.();
    this.saveRequestedPicture = null;
    this.floor.drawsAlways = this.video !== null;
  }

  /** Updates the texts with numbers; called several times per second. */
  updateNumbers(): void {
    const { recording, companion, pair } = this;
    if (recording && isShown(element<HTMLDetailsElement>('keep'))) {
      if (this.isRecording) this.timeSlider.max = String(recording.duration);
      const time = this.isRecording && !this.isReplaying ? recording.duration : this.timeSlider.valueAsNumber;
      const totalText = this.isRecording ? '' : ` of ${recording.duration.toFixed(1)}`;
      element('moment-out').textContent = `${time.toFixed(1)}${totalText} s`;
    }
    const panel = pair?.output.closest('details');
    if (!pair || !panel || !companion?.frame || this.isWaiting || !isShown(panel)) return;
    const { last } = this.session.robot;
    const start = { x: 0, y: 0, heading: 0 };
    const displacementOf = (frame: Frame | null) => (frame ? formatDisplacement(Robot.displacementBetween(start, frame.place)) : '');
    this.setMessage(`${pair.names[0]}: ${displacementOf(last)}. ${pair.names[1]}: ${displacementOf(companion.frame)}.`, pair.output);
  }

  private setRecording(isOn: boolean): void {
    if (isOn === this.isRecording) return;
    this.isRecording = isOn;
    if (isOn) {
      this.recording = new Recording();
      this.isReplaying = false;
      this.playback = null;
    } else if (this.recording) {
      this.timeSlider.max = String(this.recording.duration);
      this.timeSlider.value = '0';
      this.setMessage(`${this.recording.duration.toFixed(1)} s recorded.`);
    }
    this.updateButtons();
  }

  /** Starts the replay at the slider's time, or ends it. */
  private setReplaying(isOn: boolean): void {
    this.isReplaying = isOn;
    const { recording } = this;
    const startTime = recording && this.timeSlider.valueAsNumber < recording.duration - FRAME_SECONDS ? this.timeSlider.valueAsNumber : 0;
    this.playback = isOn ? { startedAt: performance.now(), startTime } : null;
    this.updateButtons();
  }

  /** Requests a call of `save` after the next drawing of the floor, which is drawn even behind the robot in 3D. */
  private requestPicture(save: () => void): void {
    this.saveRequestedPicture = save;
    this.floor.drawsAlways = true;
  }

  /** The first format that the browser can record; undefined for none. */
  private get videoFormat() {
    return typeof MediaRecorder === 'undefined' ? undefined : VIDEO_FORMATS.find(({ type }) => MediaRecorder.isTypeSupported(type));
  }

  private toggleVideo(): void {
    const { videoFormat } = this;
    if (this.video) this.video.stop();
    else if (videoFormat) {
      const { type, extension } = videoFormat;
      const pieces: Blob[] = [];
      const video = new MediaRecorder(element<HTMLCanvasElement>('floor').captureStream(), { mimeType: type });
      video.addEventListener('dataavailable', ({ data }) => pieces.push(data));
      video.addEventListener('stop', () => {
        this.video = null;
        this.updateButtons();
        for (const track of video.stream.getTracks()) track.stop();
        saveFile(`run.${extension}`, pieces, type);
      });
      video.addEventListener('error', () => this.setMessage('The browser failed to record the video.'));
      video.start(1000);
      this.video = video;
    }
    this.updateButtons();
  }

  private async savePng(): Promise<void> {
    const canvas = element<HTMLCanvasElement>('floor');
    const blob = await new Promise<Blob | null>((resolve) => canvas.toBlob(resolve));
    if (blob) saveFile('floor.png', [blob], 'image/png');
    else this.setMessage('The browser failed to write the picture.');
  }

  private async saveSvg(): Promise<void> {
    try {
      const { Context } = await import('svgcanvas');
      const { clientWidth, clientHeight } = element('floor');
      const context = new Context(clientWidth, clientHeight);
      const label = this.floor.drawPicture(context as unknown as CanvasRenderingContext2D);
      // The package would measure text with an inline style, which the page's Content Security Policy forbids.
      context.getSvg().append(makeSvg('text', { x: label.x, y: label.y, fill: getPalette().ink, 'font-size': 12, 'font-family': 'sans-serif' }, label.text));
      saveFile('floor.svg', [context.getSerializedSvg()], 'image/svg+xml');
    } catch (error) {
      this.setMessage(`Cannot make the picture: ${getMessage(error)}`);
    }
  }

  private makePair(): RobotPair {
    const gaits: [string, string] = [this.firstGaitList.value, this.secondGaitList.value];
    return { toml: this.session.robot.toml, gaits, names: [gaits[0], `Beside it, ${gaits[1]}`], output: element('keep-message') };
  }

  /** Makes the page's robot walk the found gait of a search, and the second robot the gait to beat. */
  async compare(referenceGait: Bars, foundGait: Bars, output: HTMLElement): Promise<void> {
    const session = this.session;
    const toml = session.robot.wasm.putGait(session.robot.toml, referenceGait);
    this.setMessage('The robot restarts with this gait…', output);
    const refusal = await restartWithGait(session, foundGait);
    if (refusal) return this.setMessage(refusal.reason, output);
    const gait = foundGait.name.replaceAll('-', ' ');
    await this.startBoth({ toml, gaits: [gait, gait], names: ['Found', 'Before'], output });
  }

  /** Starts both robots in the same frame, each from its own start. */
  private async startBoth(pair: RobotPair): Promise<void> {
    const { session } = this;
    const { description } = session.robot;
    this.removeCompanion();
    this.setMessage('Switching on the second robot…', pair.output);
    try {
      const pendingStop = session.board.drive(WORDS.stop);
      const { stopCount } = session.board;
      await pendingStop;
      // The robot was changed or stopped again meanwhile.
      if (session.robot.description !== description || session.board.stopCount !== stopCount) return this.setMessage('', pair.output);
      const companion = new Companion(pair.toml, session.robot);
      session.robot.returnToStart();
      this.floor.clearTracks();
      companion.send(`${WORDS.speed} ${session.board.pace}`);
      companion.step();
      Object.assign(this, { companion, pair, isWaiting: true, pendingSeconds: 0 });
      this.updateButtons();
      this.floor.fitView();
      await session.board.drive(pair.gaits[0]);
    } catch (error) {
      this.setMessage(`Cannot start the second robot: ${getMessage(error)}`, pair.output);
    }
  }

  private removeCompanion(): void {
    if (this.pair) this.setMessage('', this.pair.output);
    this.companion?.dispose();
    Object.assign(this, { companion: null, pair: null, isWaiting: false });
    this.updateButtons();
  }

  private updateButtons(): void {
    const { recording, isRecording, isReplaying, video } = this;
    const hasRecording = recording !== null && recording.frames.length > 0 && !isRecording;
    const setButton = (id: string, text: string, isPressed: boolean, isEnabled = true) => {
      const button = element<HTMLButtonElement>(id);
      setText(button, text);
      button.setAttribute('aria-pressed', String(isPressed));
      button.disabled = !isEnabled;
    };
    setButton('record', isRecording ? 'Stop recording' : 'Record', isRecording);
    setButton('replay', isReplaying ? 'Back to the robot' : 'Replay', isReplaying, hasRecording);
    setButton('video', video ? 'Stop the video' : 'Video', video !== null, this.videoFormat !== undefined);
    element<HTMLButtonElement>('csv').disabled = !hasRecording;
    this.timeSlider.disabled = !hasRecording;
    element<HTMLButtonElement>('alone').disabled = this.companion === null;
  }

  private readonly setMessage = (text: string, box = element('keep-message')): void => setText(box, text);
}
