// The room in which a camera measures the robot: the camera's picture or a video file, the controls of the protocol
// with which the page drives the robot, and the results.
import { type Remote, transfer } from 'comlink';

import type { RequestedWalk } from '../../generated/measure';
import { files } from '../files';
import { CallableWorker } from '../callable-worker';
import { MIN_CYCLES, ProtocolInterrupted, Protocol, type Walk } from '../measure/protocol';
import { TagTracker } from '../measure/tag-tracker';
import { FrameSource } from '../measure/frame-source';
import type { VideoWorkerApi } from '../measure/worker';
import type { Predictor } from '../predictor';
import type { Description, Gait } from '../robot';
import type { Session } from '../session';
import { getMessage } from '../problem';
import { WORDS } from '../words';
import { saveFile } from './download';
import { element, make, onFile, replaceOptions, setText } from './elements';
import { setUpResults } from './results';
import { setUpNumberInput, setNumber } from './number-input';
import { ROOM_OPENED } from './rooms';
import { drawTracking } from './draw-tracking';

/** Smallest displacement per cycle with which a gait is ticked by default. */
const MIN_DISPLACEMENT = { forwardMm: 3, turnDeg: 2 };
/** The default value of each number input; null for no default. */
const DEFAULT_NUMBERS: Record<string, number | null> = { speed: 100, cycles: 8, pause: 1, height: null, ruler: 100 };

/**
 * The task of the room: `record` adds the camera's frames to the video until the user presses Done, `drive` does so
 * while the page drives the robot, `play` reads a video file, and `compute` measures the walks in the video.
 */
type Task = 'idle' | 'record' | 'drive' | 'play' | 'compute';

type VideoWorker = CallableWorker<VideoWorkerApi>;

/** The robot in a video: its robot.toml, and its name there. */
interface MeasuredRobot {
  toml: string;
  name: string;
}

/** Starts the worker that finds the tags in frames and measures the walks. */
async function startVideoWorker(): Promise<VideoWorker> {
  const module = await files.measureModule();
  const videoWorker: VideoWorker = new CallableWorker(new Worker(new URL('../measure/worker.ts', import.meta.url), { type: 'module' }));
  await videoWorker.call((video) => video.load(module));
  return videoWorker;
}

/** Returns the walks with the gaits' names in robot.toml instead of their commands. */
const withGaitNames = (walks: Walk[], gaits: Gait[]): RequestedWalk[] =>
  walks.map(({ gait, during }) => ({ gait: gaits.find(({ command }) => command === gait)?.name ?? gait, during }));

export class MeasureView {
  private readonly room = element('room-measure');
  private readonly view = element('measure-view');
  private readonly driverList = element<HTMLSelectElement>('measure-driver');
  private readonly gaitList = element<HTMLSelectElement>('measure-gait');
  private readonly gaitBoxes = element('measure-gaits');
  private readonly startButton = element<HTMLButtonElement>('measure-start');
  private readonly cameraButton = element<HTMLButtonElement>('measure-camera');
  private readonly putBackButton = element<HTMLButtonElement>('measure-go');
  /** The numbers in the inputs, indexed by the inputs' names. */
  private readonly values = { ...DEFAULT_NUMBERS };
  private readonly showResults: ReturnType<typeof setUpResults>;
  private readonly source: FrameSource;
  /** The worker that stores and measures the video; null until it is needed. */
  private videoWorker: Promise<VideoWorker> | null = null;
  private tracker = new TagTracker();
  private task: Task = 'idle';
  /** The protocol with which the page drives the robot; null while it does not drive. */
  protocol: Protocol | null = null;
  /** True while the user puts the robot back by hand; no frames are added to the video meanwhile. */
  private isBeingPutBack = false;
  /** True if a video file was read and can be measured again. */
  private hasVideo = false;
  /** The gaits that the user has ticked (true) or unticked (false). */
  private readonly userTicks = new Map<string, boolean>();

  /** `isSetupOpen` returns true while the setup is open: hands may then be in the robot, so nothing may drive it. */
  constructor(
    private readonly session: Session,
    private readonly predictor: Predictor,
    private readonly isSetupOpen: () => boolean,
  ) {
    this.showResults = setUpResults();
    const video = this.view.querySelector('video');
    if (!video) throw new Error('the page has no video for the camera');
    this.source = new FrameSource(video, (frame, seconds) => this.processFrame(frame, seconds));
    element<HTMLInputElement>('measure-cycles').min = String(MIN_CYCLES);
    for (const [name, value] of Object.entries(DEFAULT_NUMBERS)) {
      const input = element<HTMLInputElement>(`measure-${name}`);
      // The robot accepts only whole numbers of percent and of cycles.
      const isWhole = name === 'speed' || name === 'cycles';
      setUpNumberInput(input, (typed) => (this.values[name] = typed !== null && isWhole ? Math.round(typed) : (typed ?? value)));
      if (value !== null) setNumber(input, value);
    }
    this.cameraButton.addEventListener('click', () => void this.runAction(() => this.toggleCamera()));
    onFile(element('measure-file'), (file) => void this.runAction(() => this.readVideo(file)));
    element('measure-sheet').addEventListener('click', () => void this.runAction(() => this.saveSheet()));
    this.startButton.addEventListener('click', () => void this.runAction(() => this.handleStartButton()));
    this.driverList.addEventListener('change', () => this.updateControls());
    document.addEventListener(ROOM_OPENED, () => this.room.hidden && this.switchCameraOff());
    document.addEventListener('visibilitychange', () => document.hidden && this.protocol?.stop('the page was hidden'));
    session.robot.follow((description) => this.showRobot(description));
    predictor.predictions.subscribe(() => this.tickMovingGaits());
    session.state.gait.subscribe((activity) => this.protocol?.setActivity(activity));
    session.state.isSilent.subscribe((isSilent) => isSilent && this.protocol?.stop('the robot is silent'));
    // A restarted robot stands, as between two walks, but has forgotten its pace.
    session.state.bannerCount.subscribe(() => this.protocol?.end('the robot has restarted'));
    session.state.link.subscribe(() => this.followLink());
  }

  /** Ends driving, and lists the gaits of another robot. */
  private showRobot({ gaits }: Description): void {
    this.protocol?.stop('another robot was chosen');
    const movingGaits = gaits.filter(({ moves }) => moves);
    const gaitOptions = movingGaits.map(({ command, name }) => new Option(command, name));
    replaceOptions(this.gaitList, [new Option('recognised by its path', ''), ...gaitOptions]);
    this.gaitBoxes.replaceChildren(
      make('legend', {}, 'Gaits'),
      ...movingGaits.map(({ command }) => {
        const box = make('input', { type: 'checkbox', name: command, onchange: () => this.userTicks.set(command, box.checked) });
        return make('label', { className: 'check' }, box, ` ${command}`);
      }),
    );
    this.tickMovingGaits();
  }

  /** Ticks the gaits whose predicted displacement is large enough; the user's own ticks stay. */
  private tickMovingGaits(): void {
    const hasDisplacement = new Map(this.predictor.gaits.map(({ command, displacement: { forward, turn } }) => [command, Math.abs(forward ?? 0) >= MIN_DISPLACEMENT.forwardMm || Math.abs(turn ?? 0) >= MIN_DISPLACEMENT.turnDeg]));
    for (const box of this.gaitBoxes.querySelectorAll('input')) box.checked = this.userTicks.get(box.name) ?? hasDisplacement.get(box.name) ?? false;
  }

  /** Ends driving after a change of the link, and preselects the page as the driver of a real robot. */
  private followLink(): void {
    this.protocol?.end('the link to the robot has changed');
    this.driverList.value = this.session.board.isReal ? 'page' : 'other';
    this.updateControls();
  }

  /** Updates the texts about the latest frames; called several times per second. */
  updateNumbers(): void {
    if (this.room.hidden || this.view.hidden) return;
    const { framesPerSecond, hiddenTagsMessage, searchMs } = this.tracker;
    setText(element('measure-rate'), `${framesPerSecond.toFixed(0)} frames per second, each searched in ${searchMs.toFixed(0)} ms`);
    setText(element('measure-visible-tags'), hiddenTagsMessage || 'All five tags are visible.');
    element('measure-visible-tags').classList.toggle('refusal', hiddenTagsMessage !== '');
  }

  private getVideoWorker(): Promise<VideoWorker> {
    this.videoWorker ??= startVideoWorker();
    this.videoWorker.catch(() => (this.videoWorker = null));
    return this.videoWorker;
  }

  private async callVideo<Result>(invoke: (video: Remote<VideoWorkerApi>) => Promise<Result>): Promise<Result> {
    return (await this.getVideoWorker()).call(invoke);
  }

  /** Runs an action of the user; shows the reason if it fails. */
  private async runAction(action: () => Promise<void>): Promise<void> {
    try {
      await action();
    } catch (error) {
      this.setMessage(getMessage(error), true);
    } finally {
      this.updateControls();
    }
  }

  private async toggleCamera(): Promise<void> {
    const { isCamera } = this.source;
    // Also ends the reading of a video.
    this.switchCameraOff();
    if (isCamera) return this.setMessage('');
    this.setMessage('Opening the camera…');
    this.hasVideo = false;
    await this.getVideoWorker();
    // The user may have left the room meanwhile.
    if (this.room.hidden) return this.setMessage('');
    await this.source.openCamera(() => {
      this.switchCameraOff();
      this.setMessage('The camera was disconnected.', true);
      this.updateControls();
    });
    // Meanwhile the user may have opened a video, which has its own messages.
    if (this.task === 'play' || this.hasVideo) return;
    this.tracker = new TagTracker();
    this.setMessage(this.source.isCamera ? 'Place the camera so that all five tags are visible.' : '');
  }

  /** Switches the camera off and ends the task that uses it. */
  private switchCameraOff(): void {
    this.protocol?.stop('the camera was switched off');
    this.source.stop();
    if (this.task !== 'compute') this.task = 'idle';
    this.updateControls();
  }

  /** Finds the tags in a frame that was taken at `seconds`, and draws them over the video. */
  private async processFrame(frame: VideoFrame | ImageBitmap, seconds: number): Promise<void> {
    const isKept = this.task === 'record' || this.task === 'play' || (this.task === 'drive' && !this.isBeingPutBack);
    try {
      this.tracker.addDetection(await this.callVideo((video) => video.findTags(transfer(frame, [frame]), seconds, isKept)));
      this.protocol?.setOffset(this.tracker.offsetToCentre);
      drawTracking(this.view.querySelector('canvas') as HTMLCanvasElement, this.tracker);
    } catch (error) {
      this.setMessage(getMessage(error), true);
    }
  }

  /** Reads a video file and measures the walks in it. */
  private async readVideo(file: File): Promise<void> {
    this.switchCameraOff();
    await this.callVideo((video) => video.clear());
    this.tracker = new TagTracker();
    this.task = 'play';
    this.hasVideo = false;
    this.setMessage(`Reading ${file.name}…`);
    this.updateControls();
    try {
      await this.source.playFile(file);
      if (this.task !== 'play') return;
      this.hasVideo = true;
      await this.measureWalks(this.wholeVideoWalks);
    } finally {
      this.task = 'idle';
    }
  }

  /** The whole video as one walk of the chosen gait; empty if the gaits are to be recognised by their paths. */
  private get wholeVideoWalks(): RequestedWalk[] {
    const gait = this.gaitList.value;
    return gait === '' ? [] : [{ gait, during: null }];
  }

  /** Does what the start button shows: starts or ends recording or driving, or measures the video file again. */
  private async handleStartButton(): Promise<void> {
    if (this.task === 'record') return this.measureWalks(this.wholeVideoWalks);
    if (this.task === 'drive') return void this.session.board.ask(WORDS.stop);
    if (this.hasVideo) return this.measureWalks(this.wholeVideoWalks);
    if (this.driverList.value === 'page') return this.driveGaits(this.getDrivableGaits());
    await this.clearVideo();
    // The camera may have been switched off meanwhile.
    if (!this.source.isCamera) return;
    this.task = 'record';
    this.setMessage('Recording. Let the robot walk at least four cycles, then press Done.');
  }

  private async clearVideo(): Promise<void> {
    await this.callVideo((video) => video.clear());
    this.tracker.path = [];
  }

  /** Returns the ticked gaits. Throws the reason if the page cannot drive. */
  private getDrivableGaits(): Gait[] {
    const session = this.session;
    const tickedCommands = [...this.gaitBoxes.querySelectorAll('input')].filter(({ checked }) => checked).map(({ name }) => name);
    const gaits = session.robot.description.gaits.filter(({ command }) => tickedCommands.includes(command));
    if (this.isSetupOpen()) throw new Error('Hands may be in the robot: leave the set-up first.');
    if (session.program.otherRobot) throw new Error(`The board has another robot, ${session.program.otherRobot.name}: choose that robot, or write this one to the board.`);
    if (!session.program.isFirmwareAnswering) throw new Error(`No robot answers from the ${session.board.link.name}.`);
    if (gaits.length === 0) throw new Error('Tick at least one gait.');
    return gaits;
  }

  /** Drives the gaits, and measures the walks even after an interruption. */
  private async driveGaits(gaits: Gait[]): Promise<void> {
    const session = this.session;
    // The user may choose another robot before the walks are measured.
    const robot = this.shownRobot;
    const { cycles, pause } = this.values;
    const speed = this.values.speed ?? 100;
    const protocol = new Protocol({
      ask: async (line) => (await session.board.ask(line))?.ok === true,
      now: () => this.source.now,
      wait: (seconds) => session.board.link.wait(1000 * seconds),
      predictions: () => this.predictor.gaits.map(({ command, displacement: { forward, turn } }) => ({ command, forward: forward ?? 0, turn: turn ?? Infinity })),
      putBack: () => this.waitUntilPutBack(protocol),
      showProgress: (text) => this.setMessage(text),
    });
    this.protocol = protocol;
    protocol.setOffset(this.tracker.offsetToCentre);
    this.task = 'drive';
    this.updateControls();
    try {
      await this.clearVideo();
      await protocol.run({ gaits, cycles: cycles ?? 8, speed, pause: pause ?? 1 });
      await this.measureWalks(withGaitNames(protocol.walks, gaits), speed, [], robot);
    } catch (error) {
      if (!(error instanceof ProtocolInterrupted) || protocol.walks.length === 0) throw error;
      await this.measureWalks(withGaitNames(protocol.walks, gaits), speed, [`Ended before all gaits were walked: ${error.message}`], robot);
    } finally {
      this.protocol = null;
      this.task = 'idle';
    }
  }

  /** Asks the user to put the robot back, and waits for the button or the end of the protocol. */
  private async waitUntilPutBack(protocol: Protocol): Promise<void> {
    this.isBeingPutBack = true;
    this.putBackButton.hidden = false;
    this.setMessage('The robot is near the edge of the measurable area, or its tag is hidden: put it back in the centre of the strips, and press the button.', true);
    await new Promise<void>((resolve) => {
      this.putBackButton.onclick = () => resolve();
      protocol.onEnd = resolve;
    });
    this.putBackButton.hidden = true;
    this.isBeingPutBack = false;
  }

  /** The robot that the page shows. */
  private get shownRobot(): MeasuredRobot {
    const { toml, description } = this.session.robot;
    return { toml, name: description.name };
  }

  /** Measures walks in the video. Shows the results, the given problems, and why other walks have no result. */
  private async measureWalks(walks: RequestedWalk[], speed = this.values.speed ?? 100, problems: string[] = [], { toml, name } = this.shownRobot): Promise<void> {
    this.task = 'compute';
    this.setMessage('Measuring…');
    this.updateControls();
    const { height = null, ruler } = this.values;
    try {
      const results = await this.callVideo((video) => video.measure({ toml, speed, deck_height: height, ruler_length: ruler ?? 100, walks }));
      this.showResults(name, results.gaits);
      problems.push(...results.problems);
    } catch (error) {
      this.showResults(name, []);
      problems.push(getMessage(error));
    }
    this.task = 'idle';
    this.setMessage(problems.map((problem) => `${problem}.`).join(' '), true);
  }

  private async saveSheet(): Promise<void> {
    const isLetter = element<HTMLSelectElement>('measure-paper').value === 'letter';
    saveFile('sheet.pdf', [await this.callVideo((video) => video.drawSheet(isLetter))], 'application/pdf');
    this.setMessage('sheet.pdf: print it at 100 % ("actual size"), then measure the line of 100 mm on it.');
  }

  /** Shows and enables the controls that are usable during the current task. */
  private updateControls(): void {
    const { task, source, hasVideo } = this;
    const isPageDriving = this.driverList.value === 'page' && !hasVideo;
    this.view.hidden = !source.isCamera && task !== 'play';
    element('measure-rate').hidden = element('measure-visible-tags').hidden = this.view.hidden;
    this.cameraButton.setAttribute('aria-pressed', String(source.isCamera));
    element('measure-one').hidden = isPageDriving;
    this.gaitBoxes.hidden = !isPageDriving;
    for (const label of this.room.querySelectorAll<HTMLElement>('[data-driver]')) label.hidden = !isPageDriving;
    this.startButton.textContent = task === 'record' ? 'Done' : task === 'drive' ? 'Stop' : hasVideo ? 'Measure again' : isPageDriving ? 'Drive and measure' : 'Record';
    this.startButton.disabled = task === 'play' || task === 'compute' || (!source.isCamera && !hasVideo);
    this.driverList.disabled = task !== 'idle';
  }

  private setMessage(text: string, isProblem = false): void {
    setText(element('measure-message'), text);
    element('measure-message').classList.toggle('refusal', isProblem && text !== '');
  }
}
