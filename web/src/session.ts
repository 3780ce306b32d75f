// The session: the robot that the page shows, and the board at the other end of the serial line. Views read the
// session, call its methods and follow its state: a view that reads the state in an `effect` runs again after each
// change.
import { batch } from '@preact/signals-core';

import { loadBoardModule } from './board-module';
import { files } from './files';
import { type SavedChanges, browserStorage } from './browser-storage';
import { BootLoaderLine } from './link/boot-loader-line';
import { Deadman } from './link/deadman';
import { type Answer, Dialogue, DroppedRequest, BANNER_PREFIX } from './link/dialogue';
import { GONE_MESSAGE, type Link } from './link/link';
import { UnoLink } from './link/uno-link';
import { isRefused, parseBanner, parsePoseReport, parseStatus } from './robot';
import type { Banner, Description, Floor, Four, Frame, Predictions, Refusal, Robot, Status } from './robot';
import { type BoardBanner, FULL_PACE, SessionState } from './session-state';
import { type Cause, getMessage } from './problem';
import { SimulatedBoard } from './uno/simulated-board';
import { type CycleDisplacement, WalkedPath } from './walked-path';
import { DONE_LINE, GAITS, WORDS } from './words';

/** Number of frames per reported pose; a radio at 9600 baud cannot transmit more poses. */
const FRAMES_PER_REPORT = { usb: 2, radio: 10, simulated: 1 };
/** Longest time between a reset and this firmware's banner, ms. */
const BANNER_TIMEOUT_MS = 2500;
/** Longest wait for the answer of a board that was not reset, ms. */
const PROBE_TIMEOUT_MS = 500;
/**
 * Number of `status` lines sent to a board that was not reset: the board needs up to five lines to find the baud rate,
 * and a radio may lose some.
 */
const MAX_PROBE_COUNTS = { usb: 5, radio: 12, simulated: 1 };
/** Longest wait for the answer to `status`, ms. */
const STATUS_TIMEOUT_MS = 1000;
/** Longest wait for a board to stop before the port is closed, ms. */
const STOP_TIMEOUT_MS = 1000;
/** Longest time between a reset and the `boot` action, which runs after three seconds, ms. */
const BOOT_TIMEOUT_MS = 4000;
const FRAME_SECONDS = 0.02;
/** Longest simulated time between two updates of `clock`, ms. */
const CLOCK_STEP_MS = 5;

/** The fault of a robot that received nothing for the `deadman` time. */
const LINK_FAULT = 'link';
/** The reason why a board cannot be written by radio. */
export const NO_WRITING_BY_RADIO = 'a radio cannot reset the board and is too slow; connect the board by its USB cable to write to it';

/** Callbacks for a session's events; all other changes are in its state. */
export interface SessionListener {
  /** Called for each frame, with the frame's duration. */
  onFrame(frame: Frame, widths: Four<number> | null, seconds: number): void;
  /** Called for each pulse: the Arduino number of its pin, the cycle of its rising edge, and its width in cycles. */
  onPulse(pin: number, rise: number, width: number): void;
  /** Called with each visible sent line. */
  onSent(line: string): void;
  /** Called with each visible received line. */
  onReceived(line: string): void;
  /** Asks the user to confirm that the board is a UNO: on a Nano, writing would overwrite the boot loader. */
  confirmUno(): boolean;
  /** Called with the current problem, or null once it is solved. */
  onProblem(cause: Cause, message: string | null): void;
}

/** Called with the progress of a write: `done` of the `total` pages of a step are finished. */
export type ReportProgress = (step: 'reading' | 'writing' | 'verifying' | 'retrying', done: number, total: number) => void;

const isBanner = (banner: BoardBanner | undefined): banner is Banner => typeof banner === 'object' && banner !== null;

export class Session {
  readonly state = new SessionState();
  /** The name of the robot's file; empty while a file is being loaded. */
  file = '';
  /** The robot.toml of the page's robot. */
  toml = '';
  /** The unchanged text of the robot's file. */
  original = '';
  /** The robot and the user's changes to it, as this page last stored them; null before the first robot. */
  changes: SavedChanges | null = null;
  /** The page's predictions for the gaits in `original`; null if they are missing. */
  private predictions: Predictions | null = null;
  /** The robot's section of flash. */
  robotSection: Uint8Array = new Uint8Array();
  /** The last frame; null before the first frame. */
  last: Frame | null = null;
  /** Supply voltage of the simulated board, V. */
  volts = 5;
  /** The names of the inputs whose simulated contacts are closed. */
  readonly closedInputs = new Set<string>();
  /** True if the page may send lines without the user's request; false while a byte would cancel `boot`. */
  mayAsk = false;
  dialogue!: Dialogue;
  private deadman!: Deadman;
  /** Number of unanswered drive commands. */
  private pendingDriveCount = 0;
  /** Number of `stop` commands so far; a waiting drive command is outdated when it changes. */
  stopCount = 0;
  /** The arrival time of the robot's last line, on the page's clock, ms. */
  private lastLineAt = performance.now();
  /** The firmware's image, the same for every robot. */
  private firmware: Uint8Array | null = null;
  private bootLoader: Uint8Array | null = null;
  private readonly walkedPath = new WalkedPath();
  /** The robot's time, s: simulated time, or the total duration of a real board's reported frames. */
  clock = 0;
  /** Resolves the promise of `waitForBanner`. */
  private resolveBanner: () => void = () => {};
  /** True if a board without this firmware has a UNO's boot loader. */
  hasBootLoader = false;
  /** The last requested pace, percent; null once the robot has answered. */
  private requestedPace: number | null = null;
  /** True once the page has requested the board's poses. */
  private isWatching = false;
  /** Number of calls of `loadFile` so far; a file that arrives after a later call is dropped. */
  private loadCount = 0;
  /** The simulated UNO that has failed and no longer advances; null for none. */
  private failedLink: UnoLink | null = null;
  /** The link that `disconnect` is closing, or has closed; null for none. */
  private closingLink: Link | null = null;

  constructor(
    readonly robot: Robot,
    private readonly listener: SessionListener,
  ) {}

  get description(): Description {
    // The description is missing only before the first robot is loaded, when no view reads it.
    return this.state.description.value!;
  }

  get link(): Link {
    return this.state.link.value!;
  }

  /** Calls `show` with the current robot, if any, and with each later robot. */
  followRobot(show: (description: Description) => void): void {
    this.state.description.subscribe((description) => description && show(description));
  }

  get servos(): string {
    return this.state.servos.value;
  }

  get gait(): string {
    return this.state.gait.value;
  }

  /** The requested pace until the robot answers, else the robot's pace; percent. */
  get pace(): number {
    return this.requestedPace ?? this.state.pace.value;
  }

  /** The board's firmware and robot; undefined until known. */
  get banner(): BoardBanner | undefined {
    return this.state.banner.value;
  }

  /**
   * Loads a robot by its file name and restarts the simulated UNO with it; a real board stays connected. If the robot
   * cannot be loaded, keeps the previous robot and throws an error with a message for the user.
   */
  async loadFile(name: string): Promise<void> {
    const loadNumber = ++this.loadCount;
    this.file = '';
    try {
      const [toml, predictions, firmware] = await Promise.all([files.toml(name), files.predictions(name), this.firmware ?? files.firmware()]);
      if (loadNumber !== this.loadCount) return;
      this.firmware = firmware;
      const refusal = this.loadToml(toml, null, [toml, predictions]);
      if (refusal) throw new Error(`${name}.toml: ${refusal.reason}`);
      if (!this.isBoardReal) await this.simulate();
      this.file = name;
      this.storeChanges();
    } catch (error) {
      // A later call has replaced this one.
      if (loadNumber !== this.loadCount) return;
      // An earlier call may have emptied `file` before this one.
      this.file = this.changes?.file ?? '';
      throw error;
    }
  }

  /**
   * Loads a changed robot.toml or returns its refusal. The simulated UNO restarts with it and keeps its EEPROM; a real
   * board keeps its own robot. The floor set in the page stays, unless `floor` replaces it.
   */
  async change(toml: string, floor = this.state.floor.value): Promise<Refusal | null> {
    const refusal = this.loadToml(toml, floor);
    if (refusal) return refusal;
    if (!this.isBoardReal) await this.simulate(this.simulatedLink?.board.eeprom);
    this.storeChanges();
    return null;
  }

  /** Restores saved changes unless the robot's file has changed since; returns true if the changes were restored. */
  async restoreSaved({ original, toml, floor, servos, volts }: SavedChanges): Promise<boolean> {
    if (original !== this.original) return false;
    this.setServos(servos);
    this.setSupply(volts);
    return (await this.change(toml, floor)) === null;
  }

  private storeChanges(): void {
    const { file, original, toml, servos, volts } = this;
    const floor = this.state.floor.value;
    if (file === '') return;
    this.changes = { file, original, toml, floor, servos, volts };
    browserStorage.putChanges(this.changes);
  }

  private loadToml(toml: string, floorSetting: Floor | null, originalFile: [string, Predictions | null] = [this.original, this.predictions]): Refusal | null {
    const description = this.robot.load(toml);
    if (isRefused(description)) return description;
    this.toml = toml;
    [this.original, this.predictions] = originalFile;
    this.robotSection = this.robot.section();
    this.robot.setFloor(floorSetting ?? description.floor);
    this.walkedPath.clear();
    this.last = this.robot.followPose(description.servos.map(({ neutral }) => neutral) as Four<number>, 1);
    batch(() => {
      this.state.floor.value = floorSetting;
      this.state.description.value = description;
    });
    return null;
  }

  /** The firmware and the robot as one image of the flash. */
  get image(): Uint8Array {
    const { firmware, robotSection, description } = this;
    if (!firmware) throw new Error('the firmware is not loaded yet');
    const image = new Uint8Array(description.start + robotSection.length).fill(0xff);
    image.set(firmware);
    image.set(robotSection, description.start);
    return image;
  }

  get isFirmwareAnswering(): boolean {
    return this.banner !== undefined && this.banner !== null;
  }

  /** True if the board's robot equals the page's robot. */
  get hasThisRobot(): boolean {
    return isBanner(this.banner) && this.banner.robot?.hash === this.description.hash;
  }

  /** The board's robot according to its banner; null if it is unknown or equals the page's robot. */
  get otherRobot(): { name: string; hash: string } | null {
    return isBanner(this.banner) && !this.hasThisRobot ? this.banner.robot : null;
  }

  /** Time since the robot's last line, s. */
  get secondsSinceLine(): number {
    return (performance.now() - this.lastLineAt) / 1000;
  }

  /** True if the page is connected to a real board. */
  get isBoardReal(): boolean {
    // The link is null before the first robot is loaded.
    return this.link !== null && this.link.kind !== 'simulated';
  }

  /** Powers on a new simulated UNO with the page's robot and, optionally, the previous UNO's EEPROM. */
  async simulate(eeprom?: Uint8Array): Promise<void> {
    this.bootLoader ??= await files.bootLoader();
    await this.attach(() => {
      const pins = this.description.servos.map(({ pin }) => pin);
      const board = new SimulatedBoard(this.image, this.bootLoader, this.description.rail, eeprom);
      for (const [name, pin] of this.description.inputs) board.setContact(pin, this.closedInputs.has(name));
      board.setSupply(this.volts);
      const onFrame = (widths: Four<number>) =>
        this.handleFrame(this.robot.followPulses(widths), widths, FRAME_SECONDS);
      return new UnoLink(board, pins, onFrame, (...pulse) => this.listener.onPulse(...pulse));
    });
  }

  /**
   * Connects to a board that the user picked, and identifies it; returns true if the board is connected at the end, and
   * false if the user disconnects it or writes to it meanwhile. Throws an error with a message for the user.
   */
  async connect(link: Link | null): Promise<boolean> {
    if (!link) return false;
    link.onGone = (reason) => {
      void this.simulate().then(() => this.listener.onProblem('port', `The board is gone: ${reason} The simulation continues.`));
    };
    link.onRange = (isInRange) => void this.handleRange(link, isInRange);
    await this.attach(() => link);
    const { dialogue } = this;
    this.listener.onProblem('port', null);
    // Opening a USB port resets the board. The boot loader would receive bytes that are sent before the banner.
    const isRadio = link.kind === 'radio';
    const hasSentBanner = !isRadio && (await this.waitForBanner());
    for (let n = 0; !hasSentBanner && !dialogue.isClosed && this.banner === undefined && n < MAX_PROBE_COUNTS[link.kind]; n++) {
      if (await this.answersStatus()) this.state.banner.value = 'unknown';
    }
    // The board is gone, or its boot loader already uses the line.
    if (dialogue.isClosed) return false;
    if (this.banner) await this.watch();
    else if (isRadio) this.reportUnknownBoard(`The module is connected, but no robot answers from the ${link.name}. Check that the module's TXD is on D0, and that the robot is switched on.`);
    else await this.identify(link);
    return this.link === link && !this.dialogue.isClosed;
  }

  /** Reports a board on which this firmware does not answer. */
  private reportUnknownBoard(message: string): void {
    this.state.banner.value = null;
    this.listener.onProblem('board', message);
  }

  /**
   * Reports that a radio has lost its board, or continues once the board is back in range. A walking robot has stopped
   * by itself meanwhile.
   */
  private async handleRange(link: Link, isInRange: boolean): Promise<void> {
    if (this.link !== link) return;
    this.deadman.stopRepeating();
    this.state.isSilent.value = !isInRange;
    const message = `The ${link.name} is out of range. A walking robot stops by itself; the page reconnects as soon as possible.`;
    this.listener.onProblem('port', isInRange ? null : message);
    if (!isInRange) return;
    for (let n = 0; n < MAX_PROBE_COUNTS.radio && this.link === link; n++) {
      if ((await this.status()) === null) continue;
      if (!this.banner) this.state.banner.value = 'unknown';
      this.listener.onProblem('board', null);
      return this.watch();
    }
  }

  /** Waits for the banner of a restarted board; returns true if it arrives in time. */
  async waitForBanner(): Promise<boolean> {
    const { bannerCount } = this.state;
    const previousCount = bannerCount.value;
    const bannerPromise = new Promise<boolean>((resolve) => (this.resolveBanner = () => resolve(true)));
    // A later call may have replaced `resolveBanner`.
    return Promise.race([bannerPromise, this.link.wait(BANNER_TIMEOUT_MS).then(() => bannerCount.value !== previousCount)]);
  }

  /** Resolves to true if this firmware answers `status`; used if the port does not reset the board. */
  private async answersStatus(): Promise<boolean> {
    const answer = await this.dialogue.ask(WORDS.status, true, PROBE_TIMEOUT_MS).catch(() => null);
    return answer?.ok ?? false;
  }

  /** Identifies a board without this firmware by its boot loader. */
  private async identify(link: Link): Promise<void> {
    this.hasBootLoader = false;
    let message: string;
    try {
      const model = await this.withBootLoader(link, async ({ identify }, line) => identify(line));
      message = `The board is an Arduino ${model}, an ATmega328P according to its boot loader, without this firmware.`;
      this.hasBootLoader = true;
    } catch (error) {
      message = `The board does not answer like this firmware: ${getMessage(error)}.`;
    }
    // A write may have begun first, and a started program of this firmware may already have sent its banner.
    if (this.link === link && !this.dialogue.isClosed && this.banner === undefined) this.reportUnknownBoard(message);
  }

  /** Requests reports of the board's poses. */
  private async watch(): Promise<void> {
    this.isWatching = true;
    await this.ask(`${WORDS.watch} ${FRAMES_PER_REPORT[this.link.kind]}`);
  }

  /** Stops a board, disconnects it and returns to the simulation, unless an earlier call is doing this. */
  async disconnect(): Promise<void> {
    if (this.closingLink === this.link) return;
    this.closingLink = this.link;
    const hasStopped = await this.stop();
    await this.simulate();
    if (!hasStopped) {
      this.listener.onProblem('port', 'The disconnected board did not confirm its stop. If it is still walking, press its reset button.');
    }
  }

  /** True if a real board is walking. */
  get isBoardWalking(): boolean {
    return this.isBoardReal && this.startsWalking(this.gait);
  }

  /** True while a routine runs, also a real board's routine that the page's robot does not have. */
  private get isRoutineRunning(): boolean {
    return this.startsWalking(this.gait) && !this.description.gaits.some(({ command }) => command === this.gait);
  }

  /** Returns true if the robot walks after this line; an activity counts as the line that starts it. */
  private startsWalking(line: string): boolean {
    const [word] = line.split(' ');
    // A board with another robot may have gaits that the page's robot does not have. A count may follow the gait's
    // name.
    const knownGait = this.description.gaits.find(({ command }) => command === line.replace(/ \d+$/, ''));
    return knownGait ? knownGait.moves : !['', '?', GAITS.stand, ...Object.values<string>(WORDS)].includes(word);
  }

  /** Restores the robot's own `deadman` setting if the robot neither walks nor will soon walk. */
  private restoreDeadmanIfIdle(): void {
    if (this.pendingDriveCount === 0 && !this.isBoardWalking) this.deadman.restore();
  }

  /**
   * Stops a board that walks, or will soon walk, while the user may not see it; if `stop` does not arrive, `deadman`
   * stops the board.
   */
  stopIfWalking(): void {
    if (!this.isBoardWalking && this.pendingDriveCount === 0) return;
    this.deadman.stopRepeating();
    void this.ask(WORDS.stop);
  }

  /**
   * Stops a board before its disconnection; returns true if the board answers, or if no real board with this firmware
   * is connected.
   */
  async stop(): Promise<boolean> {
    if (!this.isBoardReal || !this.banner) return true;
    const { link, dialogue } = this;
    const answer = dialogue.ask(WORDS.stop).catch(() => null);
    return Promise.race([answer, link.wait(STOP_TIMEOUT_MS)]).then(Boolean);
  }

  /** Closes the current link, and then attaches the link that `makeLink` returns. */
  private async attach(makeLink: () => Link): Promise<void> {
    this.dialogue?.close();
    await this.link?.close();
    // The robot may have changed while the link was closing.
    const link = makeLink();
    batch(() => {
      this.state.link.value = link;
      this.state.banner.value = undefined;
      // An earlier radio's silence does not concern the new link.
      this.state.isSilent.value = false;
      this.state.refusal.value = '';
      this.state.status.value = null;
      this.isWatching = false;
      this.mayAsk = false;
      this.startDialogue();
      this.setGait('');
    });
    for (const cause of ['line', 'board', 'fault', 'simulation'] as const) this.listener.onProblem(cause, null);
  }

  private startDialogue(): void {
    this.dialogue = new Dialogue(this.link, {
      onSent: (line) => this.listener.onSent(line),
      onShownLine: (line) => this.handleLine(line),
      onAnyLine: (line) => {
        this.lastLineAt = performance.now();
        const status = parseStatus(line);
        if (status) this.handleStatus(status);
      },
      onSilent: (isSilent) => (this.state.isSilent.value = isSilent),
      onStopping: (isStopping) => (this.state.isStopping.value = isStopping),
    });
    this.deadman = new Deadman(this.dialogue);
  }

  private handleLine(line: string): void {
    const angles = parsePoseReport(line);
    if (angles && this.isBoardReal) return this.handlePose(angles);
    this.listener.onReceived(line);
    const word = /^ok (.+)$/.exec(line)?.[1] ?? '';
    const { stop, rest, center, pose, speed } = WORDS;
    const activities = [...this.description.gaits.map(({ command }) => command), ...this.description.routines, stop, rest, center];
    // A count may follow the gait's name.
    const command = activities.includes(word) ? word : word.replace(/ \d+$/, '');
    if (activities.includes(command)) this.setGait(command);
    else if (word.startsWith(`${pose} `)) this.setGait(pose);
    else if (word.startsWith(`${speed} `)) this.setPace(Number(word.slice(speed.length)));
    else if (line.startsWith('# boot: ')) this.setGait(line.slice('# boot: '.length).replaceAll('-', ' '));
    else if (line.startsWith(BANNER_PREFIX)) this.handleBanner(line);
    else if (line.startsWith('# fault') || line === DONE_LINE) this.setGait(stop);
  }

  private handleBanner(line: string): void {
    const { dialogue } = this;
    const bannerNumber = ++this.state.bannerCount.value;
    // First, because `setGait` would send the robot's own `deadman`.
    this.deadman.reset();
    this.setGait('stand');
    this.setPace(FULL_PACE);
    this.isWatching = false;
    this.listener.onProblem('board', null);
    this.state.banner.value = parseBanner(line) ?? 'unknown';
    this.resolveBanner();
    // A byte would cancel the `boot` action.
    this.mayAsk = false;
    void this.link.wait(BOOT_TIMEOUT_MS).then(() => {
      // The board may have restarted meanwhile, or the boot loader may be using the line.
      if (this.state.bannerCount.value !== bannerNumber || dialogue.isClosed) return;
      this.mayAsk = true;
      if (this.isBoardReal && !this.isWatching) void this.watch();
    });
  }

  private setPace(percent: number): void {
    // A cycle in which the pace changes cannot be measured.
    if (percent !== this.state.pace.value) this.walkedPath.clear();
    this.state.pace.value = percent;
  }

  private setGait(gait: string): void {
    this.state.gait.value = gait;
    this.restoreDeadmanIfIdle();
    this.walkedPath.clear();
  }

  /** Sends a line and returns its answer, or null after an error; the error is shown unless the line is quiet. */
  async ask(line: string, isQuiet = false, timeoutMs?: number): Promise<Answer | null> {
    // The link is null before the first robot is loaded.
    if (this.link === null) return null;
    if (!isQuiet) this.mayAsk = true;
    const { deadman } = this;
    const command = line.trim().toLowerCase();
    if (command === WORDS.stop) this.stopCount += 1;
    const isDrive = this.isBoardReal && this.startsWalking(command);
    if (isDrive) this.pendingDriveCount += 1;
    try {
      if (isDrive) {
        if (document.hidden) throw new Error(`"${line}" was not sent, because the page is hidden`);
        const { stopCount } = this;
        const isConfirmed = await deadman.engage();
        // A `stop` was sent meanwhile.
        if (stopCount !== this.stopCount) return null;
        if (!isConfirmed) throw new Error(`"${line}" was not sent, because the robot did not confirm its deadman setting`);
      }
      // `cal` must print and `save` must store the robot's own setting, not the page's setting.
      const needsOwnDeadman = deadman.isEngaged && [WORDS.cal, WORDS.save].some((word) => word === command);
      if (needsOwnDeadman) deadman.restore();
      const pendingAnswer = this.dialogue.ask(line, isQuiet, timeoutMs);
      if (needsOwnDeadman && this.isBoardWalking) void deadman.engage();
      const answer = await pendingAnswer;
      if (!isQuiet) this.listener.onProblem('line', null);
      deadman.observeUserLine(command, answer.ok);
      return answer;
    } catch (error) {
      // A quiet line is sent again later; until then, the page shows that the robot is silent.
      if (!isQuiet && !(error instanceof DroppedRequest)) this.listener.onProblem('line', `${getMessage(error)}.`);
      return null;
    } finally {
      if (isDrive) {
        this.pendingDriveCount -= 1;
        this.restoreDeadmanIfIdle();
      }
    }
  }

  /** Sends a drive command. Its refusal is shown next to the gaits' buttons until a command is accepted. */
  async drive(line: string): Promise<void> {
    const requestedPace = line.startsWith(`${WORDS.speed} `) ? Number(line.slice(WORDS.speed.length)) : null;
    this.requestedPace = requestedPace ?? this.requestedPace;
    const answer = await this.ask(line);
    // A later line may request another pace.
    if (this.requestedPace === requestedPace) this.requestedPace = null;
    if (answer) this.state.refusal.value = answer.ok ? '' : `${line}: ${answer.text.replace(/^err \d+ /, '')}`;
  }

  /** Requests the robot's status; returns null if it does not answer. */
  async status(): Promise<Status | null> {
    const answer = await this.ask(WORDS.status, true, STATUS_TIMEOUT_MS);
    return answer && parseStatus(answer.text);
  }

  /** Handles a status as soon as its line is received, because it could later overwrite a newer state. */
  private handleStatus(status: Status): void {
    if (status.pace !== null) this.setPace(status.pace);
    // A fault lasts until the robot moves again, but is reported only once.
    if (status.fault !== this.state.status.value?.fault) {
      this.listener.onProblem('fault', status.fault === LINK_FAULT && this.isBoardReal ? 'The robot has stopped by itself, because it received no line for too long.' : null);
    }
    const gait = status.gait.replaceAll('-', ' ');
    // The robot reports `center` as a pose, and the rest of a routine as `rest`.
    const isSameActivity = (gait === WORDS.pose && this.gait === WORDS.center) || (gait === WORDS.rest && this.isRoutineRunning && status.fault === null);
    // The page missed the start of this activity, for example because the link was interrupted.
    if (gait !== this.gait && !isSameActivity) this.setGait(gait);
    this.state.status.value = status;
  }

  /** Presses the reset button of the board. */
  async reset(): Promise<void> {
    this.dialogue.dropRequests();
    this.deadman.reset();
    this.setGait('');
    await this.link.reset();
  }

  /**
   * Writes firmware and robot, or only the robot after the board's firmware, and starts the board. Throws an error
   * whose message tells the user the board's content.
   */
  async flash(bytes: Uint8Array, isRobotAlone: boolean, reportProgress: ReportProgress): Promise<void> {
    const { link } = this;
    if (link.kind === 'radio') throw new Error(NO_WRITING_BY_RADIO);
    const endAddress = bytes.length + (isRobotAlone ? this.description.start : 0);
    await this.withBootLoader(link, async ({ Board, needsUno, upload }, line) => {
      const board = !link.mayBeNano || !needsUno(endAddress) ? Board.Unknown : this.listener.confirmUno() ? Board.Uno : Board.Nano;
      this.state.banner.value = undefined;
      this.isWatching = false;
      this.mayAsk = false;
      await upload(line, bytes, isRobotAlone, board, reportProgress);
    });
  }

  /** Runs `action` with the boot loader, which uses the line meanwhile. Throws an error with a message for the user. */
  private async withBootLoader<T>(link: Link, action: (board: Awaited<ReturnType<typeof loadBoardModule>>, line: BootLoaderLine) => Promise<T>): Promise<T> {
    const board = await loadBoardModule();
    if (this.link !== link) throw new Error(GONE_MESSAGE);
    if (this.dialogue.isClosed) throw new Error('the page is already talking to the boot loader; try again in a few seconds');
    this.dialogue.close();
    const line = new BootLoaderLine(link);
    try {
      return await action(board, line);
    } finally {
      await line.restoreBaud();
      if (this.link === link) {
        this.startDialogue();
        this.setGait('');
        // The program may already have sent its banner.
        link.onBytes(line.takeUnreadBytes());
      }
    }
  }

  /**
   * Waits for the banner of a board that was just written, and compares the robot's hash with `hash` unless `hash` is
   * null. Returns the problem as the end of a sentence; null if there is none.
   */
  async checkWrittenBoard(hash: string | null): Promise<string | null> {
    const { link, dialogue } = this;
    // The banner may have arrived right after the boot loader's last answer.
    const hasSentBanner = this.banner !== undefined || (await this.waitForBanner());
    // The board is gone, or another write has begun.
    if (this.link !== link || dialogue.isClosed) return null;
    if (!hasSentBanner) {
      this.reportUnknownBoard(`The ${link.name} sends no banner: the written program is not this firmware.`);
      return 'the board sends no banner of this firmware';
    }
    const boardHash = isBanner(this.banner) ? this.banner.robot?.hash : null;
    return hash !== null && boardHash !== hash ? 'the board does not report this robot: write firmware and robot' : null;
  }

  /** The link to the simulated board; null while a real board is connected. */
  private get simulatedLink(): UnoLink | null {
    return this.link instanceof UnoLink ? this.link : null;
  }

  /** Advances the simulation until it fails, which is reported; does nothing with a real board. */
  advance(ms: number): void {
    const { simulatedLink } = this;
    if (!simulatedLink || simulatedLink === this.failedLink) return;
    try {
      // The steps are short, so that each line of the robot gets its own time, even on a slow machine that catches up.
      for (let remainingMs = ms; remainingMs > 0; remainingMs -= CLOCK_STEP_MS) {
        const stepMs = Math.min(remainingMs, CLOCK_STEP_MS);
        this.clock += stepMs / 1000;
        simulatedLink.advance(stepMs);
      }
    } catch (error) {
      this.failedLink = simulatedLink;
      console.error(error);
      this.listener.onProblem('simulation', `The simulated UNO has stopped: ${getMessage(error)}`);
    }
  }

  private handlePose(angles: Four<number>): void {
    const frameCount = FRAMES_PER_REPORT[this.link.kind];
    const frame = this.robot.followPose(angles, frameCount);
    this.clock += FRAME_SECONDS * frameCount;
    this.handleFrame(frame, null, FRAME_SECONDS * frameCount);
  }

  private handleFrame(frame: Frame | null, widths: Four<number> | null, seconds: number): void {
    if (!frame) return;
    this.last = frame;
    this.walkedPath.add(frame, seconds);
    this.listener.onFrame(frame, widths, seconds);
  }

  /** Returns the displacement in the last complete cycle; null if the gait does not move or no cycle is complete. */
  measured(): CycleDisplacement | null {
    const gait = this.description.gaits.find(({ command }) => command === this.gait);
    return gait?.moves ? this.walkedPath.computeDisplacement((gait.period * FULL_PACE) / this.state.pace.value) : null;
  }

  /** The page's stored predictions; null if the robot, its floor or its servos differ from the file. */
  get filePredictions(): Predictions | null {
    return this.toml === this.original && this.state.floor.value === null && this.servos === 'own' ? this.predictions : null;
  }

  /** Moves the robot back to its starting place on the floor. */
  returnToStart(): void {
    this.robot.returnToStart();
    this.walkedPath.clear();
  }

  /** Floor, mass, feet and leg drive set in the page, else from robot.toml. */
  get floor(): Floor {
    return this.state.floor.value ?? this.description.floor;
  }

  /** Sets floor, mass, feet and leg drive; null restores the values of robot.toml. */
  setFloor(floor: Floor | null): void {
    this.state.floor.value = floor;
    this.robot.setFloor(this.floor);
    this.storeChanges();
  }

  /** Sets the servo model by its name in the description. */
  setServos(name: string): void {
    this.state.servos.value = name;
    this.robot.setServoModel(name);
    this.storeChanges();
  }

  /** Closes or opens the contact at an input in the simulation. */
  setContact(name: string, isClosed: boolean): void {
    if (isClosed) this.closedInputs.add(name);
    else this.closedInputs.delete(name);
    const input = this.description.inputs.find(([inputName]) => inputName === name);
    if (input) this.simulatedLink?.board.setContact(input[1], isClosed);
  }

  setSupply(volts: number): void {
    this.volts = volts;
    this.simulatedLink?.board.setSupply(volts);
    this.storeChanges();
  }
}
