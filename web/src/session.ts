// The session: the robot that the page shows, and the board at the other end of the serial line. Views only read the
// session and call its methods.
import { loadBoard } from './board';
import { files } from './files';
import { type SavedChanges, kept } from './kept';
import { BootLine } from './link/boot-line';
import { Deadman } from './link/deadman';
import { type Answer, Dialogue, DroppedQuestion, GREETING } from './link/dialogue';
import type { Link, Simulated } from './link/link';
import { UnoLink } from './link/uno-link';
import {
  type Description,
  type Floor,
  type Four,
  type Frame,
  isRefused,
  type Predictions,
  type Refused,
  type Robot,
} from './robot';
import { type Banner, parseBanner, type Status, parseStatus, reportedPose } from './status';
import { type Cause, messageOf } from './trouble';
import { SimulatedBoard } from './uno/board';
import { type Measured, WalkedPath } from './walked';
import { DONE, GAITS, WORDS } from './words';

/** Number of frames of 20 ms from one reported pose of a board to the next; a radio at 9600 baud carries no more. */
const WATCH_FRAMES = { usb: 2, radio: 10, simulated: 1 };
/** Time from a reset within which this firmware sends its banner, ms. */
const BANNER_TIMEOUT_MS = 2500;
/**
 * Time within which a board that was not reset answers, ms, and how often it is asked: the board finds the port's
 * baud rate after at most five lines, and a radio may lose some.
 */
const ANSWER_TIMEOUT_MS = 500;
const MAX_ATTEMPTS = { usb: 5, radio: 12, simulated: 1 };
/** Time that the answer to `status` may take before `status` is sent again, ms. */
const STATUS_TIMEOUT_MS = 1000;
/** Time a board gets to stop before the port is closed, ms. */
const STOP_TIMEOUT_MS = 1000;
/** Time after a reset within which `boot` has acted (three seconds), ms. */
const BOOT_TIMEOUT_MS = 4000;
/** The firmware's pace after a reset, percent. */
const FULL_PACE = 100;
const FRAME_SECONDS = 0.02;
/** Longest simulated time between two updates of `clock`, ms. */
const CLOCK_STEP_MS = 5;

/** The fault of a robot that has received nothing for the time of `deadman`. */
const LINK_FAULT = 'link';
/** The reason why nothing is written by radio. */
export const BY_CABLE = 'a radio does not reset a board and is too slow for it: connect its USB cable to write to it';

/** A board's banner; `unknown` if this firmware answers but sent no banner, null if it does not answer. */
export type BoardBanner = Banner | 'unknown' | null;

export interface Listener {
  /** Called for another robot, or for the same robot with other values. */
  robot(description: Description): void;
  /** Called for each frame and its duration in seconds. */
  frame(frame: Frame, widths: Four<number> | null, seconds: number): void;
  pulse(pin: number, rise: number, width: number): void;
  sent(line: string): void;
  received(line: string): void;
  /** Called when the robot's activity changes: a gait or a command. */
  doing(gait: string): void;
  /** Called when the board's firmware and robot are known. */
  found(banner: BoardBanner): void;
  /** Called with the robot's pace, percent. */
  speed(percent: number): void;
  /** Called with each answer to `status`. */
  state(status: Status): void;
  /** Called when another board is connected. */
  link(link: Link): void;
  /** Asks the user whether the board is a UNO: on a Nano, writing would overwrite the boot loader. */
  isUno(): boolean;
  /** Called when the robot leaves a line unanswered, and when it answers again. */
  silent(isSilent: boolean): void;
  /** Called when `stop` begins to be sent, and when the robot has answered it. */
  stopping(isStopping: boolean): void;
  /** Called with the current problem, or null once it is solved. */
  trouble(cause: Cause, message: string | null): void;
}

/** Called with the progress of a write: the finished pages of a step, and all of them. */
export type Progress = (step: 'reading' | 'writing' | 'verifying' | 'again', done: number, of: number) => void;

const isBanner = (banner: BoardBanner | undefined): banner is Banner => typeof banner === 'object' && banner !== null;

export class Session {
  description!: Description;
  /** The name of the robot's file; empty while a file is being loaded. */
  file = '';
  /** The robot.toml of the page's robot. */
  toml = '';
  /** The unchanged robot.toml of the robot's file. */
  original = '';
  /** The predictions of the gaits in `original`, which come with the page; null if they are missing. */
  private predictions: Predictions | null = null;
  /** The robot's section of flash. */
  section: Uint8Array = new Uint8Array();
  last: Frame | null = null;
  gait = '';
  /** The robot's pace, percent. */
  private pace = FULL_PACE;
  volts = 5;
  /** The names of the inputs whose contacts are closed in the simulation. */
  readonly closed = new Set<string>();
  /** The servo model, by its name in the description. */
  servos = 'own';
  /** True if the page may send lines of its own. */
  mayAsk = false;
  link!: Link;
  dialogue!: Dialogue;
  private deadman!: Deadman;
  /** Unanswered lines that make the robot walk. */
  private drives = 0;
  /** Number of stops so far. */
  private stops = 0;
  /** The time at which the robot's last line arrived, on the page's clock, ms. */
  private lastLineAt = performance.now();
  /** Number of banners received: a board that restarts has lost its unsaved settings. */
  banners = 0;
  /** The firmware, which is the same for every robot. */
  private code: Uint8Array | null = null;
  private floorSetting: Floor | null = null;
  private bootLoader: Uint8Array | null = null;
  private readonly path = new WalkedPath();
  /**
   * Time for which the robot was followed so far, s: simulated time, or the frames of a real board's reported poses.
   */
  clock = 0;
  private onBanner: () => void = () => {};
  /** The board's firmware and robot; undefined until known. */
  private boardBanner: BoardBanner | undefined;
  /** True if a board without this firmware has the boot loader of a UNO. */
  hasLoader = false;
  /** True while a board on USB sends its poses. */
  private isWatching = false;
  /** Number of calls of `choose` so far: a file that arrives after a later call is dropped. */
  private choices = 0;

  constructor(
    readonly robot: Robot,
    private readonly listener: Listener,
  ) {}

  /**
   * Loads a robot by its file name and restarts the simulated UNO with it; a real board stays connected. Throws an
   * error for the user, and then the previous robot stays.
   */
  async choose(name: string): Promise<void> {
    const choice = ++this.choices;
    const previousFile = this.file;
    this.file = '';
    try {
      const [toml, predictions, code] = await Promise.all([files.toml(name), files.predictions(name), this.code ?? files.code()]);
      if (choice !== this.choices) return;
      this.code = code;
      const refusal = this.loadToml(toml, null, [toml, predictions]);
      if (refusal) throw new Error(`${name}.toml: ${refusal.refused}`);
      await this.begin(false);
      this.file = name;
      this.keep();
    } catch (error) {
      // A later choice has replaced this one.
      if (choice !== this.choices) return;
      this.file = previousFile;
      throw error;
    }
  }

  /** Loads a changed robot.toml: the simulated UNO restarts with it and keeps its saved settings. */
  async change(toml: string): Promise<Refused | null> {
    const refusal = this.loadToml(toml);
    if (refusal) return refusal;
    await this.begin(true);
    this.keep();
    return null;
  }

  /** Restores saved changes if the robot's file is still the same; returns true if they were restored. */
  async recall({ original, toml, floor, servos, volts }: SavedChanges): Promise<boolean> {
    if (original !== this.original) return false;
    this.setServos(servos);
    this.setSupply(volts);
    if (this.loadToml(toml, floor)) return false;
    await this.begin(true);
    this.keep();
    return true;
  }

  private keep(): void {
    const { file, original, toml, floorSetting: floor, servos, volts } = this;
    if (file !== '') kept.put({ file, original, toml, floor, servos, volts });
  }

  /** Restores the unchanged robot of the file. */
  async restore(): Promise<void> {
    await this.change(this.original);
  }

  private loadToml(toml: string, floorSetting = this.floorSetting, originalFile: [string, Predictions | null] = [this.original, this.predictions]): Refused | null {
    const answer = this.robot.read(toml);
    if (isRefused(answer)) return answer;
    [this.toml, this.floorSetting] = [toml, floorSetting];
    [this.original, this.predictions] = originalFile;
    this.description = answer;
    this.section = this.robot.section();
    this.robot.setFloor(this.floor);
    this.path.clear();
    this.last = this.robot.pose(answer.servos.map(({ neutral }) => neutral) as Four<number>, 1);
    this.listener.robot(answer);
    return null;
  }

  /** Restarts a simulated board with the page's robot; a real board keeps its own robot. */
  private async begin(keepsSaved: boolean): Promise<void> {
    if (!this.isReal) await this.simulate(keepsSaved && this.link instanceof UnoLink ? this.link.board.eeprom : undefined);
    else {
      this.listener.link(this.link);
      if (this.boardBanner !== undefined) this.listener.found(this.boardBanner);
    }
  }

  /** Firmware and robot as one image of flash. */
  get image(): Uint8Array {
    const { code, section, description } = this;
    if (!code) throw new Error('the firmware has not come yet');
    const image = new Uint8Array(description.start + section.length).fill(0xff);
    image.set(code);
    image.set(section, description.start);
    return image;
  }

  /** True if this firmware answers. */
  get answers(): boolean {
    return this.boardBanner !== undefined && this.boardBanner !== null;
  }

  /** The board's firmware and robot; undefined until known. */
  get banner(): BoardBanner | undefined {
    return this.boardBanner;
  }

  /** True if the board has exactly this robot. */
  get hasThisRobot(): boolean {
    return isBanner(this.boardBanner) && this.boardBanner.robot?.hash === this.description.hash;
  }

  /** The board's robot by its banner, if it is not the page's robot; else null. */
  get otherRobot(): { name: string; hash: string } | null {
    return isBanner(this.boardBanner) && !this.hasThisRobot ? this.boardBanner.robot : null;
  }

  /** Time since the robot's last line, s. */
  get secondsSinceLine(): number {
    return (performance.now() - this.lastLineAt) / 1000;
  }

  get isReal(): boolean {
    // Without a robot there is no link yet.
    return this.link !== undefined && this.link.kind !== 'simulated';
  }

  /** Starts a new simulated UNO with this robot at power-on; `saved` is the EEPROM of the previous one. */
  async simulate(saved?: Uint8Array): Promise<void> {
    this.bootLoader ??= await files.bootLoader();
    const pins = this.description.servos.map(({ pin }) => pin);
    const board = new SimulatedBoard(this.image, this.bootLoader, this.description.rail, saved);
    for (const [name, pin] of this.description.inputs) board.setContact(pin, this.closed.has(name));
    const events = {
      frame: (widths: Four<number>) => this.handleWidths(widths),
      pulse: (pin: number, rise: number, width: number) => this.listener.pulse(pin, rise, width),
    };
    await this.attach(new UnoLink(board, pins, events));
    this.simulated?.setSupply(this.volts);
  }

  /**
   * Connects a board that the user has picked and identifies it; returns true if it is still connected. Throws an
   * error for the user.
   */
  async connect(link: Link | null): Promise<boolean> {
    if (!link) return false;
    link.onGone = (reason) => {
      void this.simulate().then(() => this.listener.trouble('port', `The board is gone: ${reason} The simulation goes on.`));
    };
    link.onReach = (isInReach) => void this.handleReach(link, isInReach);
    await this.attach(link);
    this.listener.trouble('port', null);
    // Opening a port on USB has reset the board. Bytes sent before its banner would go to the boot loader.
    const isRadio = link.kind === 'radio';
    const hasGreeted = !isRadio && (await this.greeting());
    for (let n = 0; !hasGreeted && this.boardBanner === undefined && n < MAX_ATTEMPTS[link.kind]; n++) {
      if (this.link === link && (await this.isAnswering())) this.setBoardBanner('unknown');
    }
    if (this.link !== link) return false;
    if (this.boardBanner) await this.watch();
    else if (isRadio) this.silentModule(link);
    else await this.identify(link);
    return this.link === link;
  }

  private silentModule(link: Link): void {
    this.setBoardBanner(null);
    this.listener.trouble('board', `The module is connected, but no robot answers from the ${link.name}: is its TXD on D0, and is the robot switched on?`);
  }

  /**
   * Reports that a radio has lost its board, or continues once it is in reach again. A robot that walked has stopped
   * by itself meanwhile.
   */
  private async handleReach(link: Link, isInReach: boolean): Promise<void> {
    if (this.link !== link) return;
    this.deadman.letGo();
    this.listener.silent(!isInReach);
    const message = `The ${link.name} is out of reach. A robot that was driven stops by itself; the page connects again as soon as it can.`;
    this.listener.trouble('port', isInReach ? null : message);
    if (!isInReach) return;
    for (let n = 0; n < MAX_ATTEMPTS.radio && this.link === link; n++) {
      if ((await this.status()) === null) continue;
      if (!this.boardBanner) this.setBoardBanner('unknown');
      this.listener.trouble('board', null);
      return this.watch();
    }
  }

  /** Waits for the banner of a restarted board; returns true if it came in time. */
  async greeting(): Promise<boolean> {
    const bannerArrival = new Promise<boolean>((resolve) => (this.onBanner = () => resolve(true)));
    return Promise.race([bannerArrival, this.link.wait(BANNER_TIMEOUT_MS).then(() => false)]);
  }

  /** Returns true if this firmware answers `status`: not every port resets its board, so there may be no banner. */
  private async isAnswering(): Promise<boolean> {
    const answer = await this.dialogue.ask(WORDS.status, true, ANSWER_TIMEOUT_MS).catch(() => null);
    return answer?.ok ?? false;
  }

  /** Identifies a board without this firmware by its boot loader. */
  private async identify(link: Link): Promise<void> {
    this.hasLoader = false;
    let message: string;
    try {
      const model = await this.withBootLoader(link, async ({ identify }, line) => identify(line));
      message = `The board is an Arduino ${model}, an ATmega328P by its boot loader, and this firmware is not on it.`;
      this.hasLoader = true;
    } catch (error) {
      message = `The board does not speak as this firmware does: ${messageOf(error)}.`;
    }
    if (this.link !== link) return;
    this.setBoardBanner(null);
    this.listener.trouble('board', message);
  }

  /** Makes a board send its poses. */
  private async watch(): Promise<void> {
    this.isWatching = true;
    await this.ask(`${WORDS.watch} ${WATCH_FRAMES[this.link.kind]}`);
  }

  /** Stops a board, disconnects it and returns to the simulation. */
  async disconnect(): Promise<void> {
    const hasStopped = await this.stop();
    await this.simulate();
    if (!hasStopped) {
      this.listener.trouble('port', 'The board that was left did not say that it stops. If it walks on, press its reset button.');
    }
  }

  /** True if a real board is walking. */
  get walksAlone(): boolean {
    return this.isReal && this.walks(this.gait);
  }

  /** True while a routine is under way; a board may have routines that this robot does not have. */
  private get isRoutine(): boolean {
    return this.walks(this.gait) && !this.description.gaits.some(({ command }) => command === this.gait);
  }

  /** True if a line makes the robot walk. */
  private walks(line: string): boolean {
    const [word] = line.split(' ');
    // A board with another robot may have gaits that this robot lacks. A count may follow the gait's name.
    const knownGait = this.description.gaits.find(({ command }) => command === line.replace(/ \d+$/, ''));
    return knownGait ? knownGait.moves : !['', '?', GAITS.stand, ...Object.values<string>(WORDS)].includes(word);
  }

  /** Restores the robot's own `deadman` if the robot neither walks nor is about to walk. */
  private restoreDeadmanIfIdle(): void {
    if (this.drives === 0 && !this.walksAlone) this.deadman.end();
  }

  /** Stops a robot that may be out of sight; if `stop` does not arrive, `deadman` stops it. */
  letGo(): void {
    if (!this.walksAlone) return;
    this.deadman.letGo();
    void this.ask(WORDS.stop);
  }

  /**
   * Stops a board that is about to be disconnected; returns true if the board answers, or if no real robot is known
   * to be there.
   */
  async stop(): Promise<boolean> {
    if (!this.isReal || !this.boardBanner) return true;
    const { link, dialogue } = this;
    const answer = dialogue.ask(WORDS.stop).catch(() => null);
    return Promise.race([answer, link.wait(STOP_TIMEOUT_MS)]).then(Boolean);
  }

  private async attach(link: Link): Promise<void> {
    this.dialogue?.end();
    await this.link?.close();
    this.link = link;
    this.boardBanner = undefined;
    this.isWatching = false;
    this.mayAsk = false;
    this.listen();
    this.setGait('');
    for (const cause of ['line', 'board', 'fault'] as const) this.listener.trouble(cause, null);
    this.listener.link(link);
  }

  private listen(): void {
    this.dialogue = new Dialogue(this.link, {
      sent: (line) => this.listener.sent(line),
      received: (line) => this.handleLine(line),
      arrived: (line) => {
        this.lastLineAt = performance.now();
        const status = parseStatus(line);
        if (status) this.handleStatus(status);
      },
      silent: (isSilent) => this.listener.silent(isSilent),
      stopping: (isStopping) => this.listener.stopping(isStopping),
    });
    this.deadman = new Deadman(this.dialogue);
  }

  private handleLine(line: string): void {
    const angles = reportedPose(line);
    if (angles && this.isReal) {
      this.handlePose(angles);
      return;
    }
    this.listener.received(line);
    const word = /^ok (.+)$/.exec(line)?.[1] ?? '';
    const { stop, rest, center, pose, speed } = WORDS;
    const activities = [...this.description.gaits.map(({ command }) => command), ...this.description.routines, stop, rest, center];
    // A count may follow the gait's name.
    const command = activities.includes(word) ? word : word.replace(/ \d+$/, '');
    if (activities.includes(command)) this.setGait(command);
    else if (word.startsWith(`${pose} `)) this.setGait(pose);
    else if (word.startsWith(`${speed} `)) this.setPace(Number(word.slice(speed.length)));
    else if (line.startsWith('# boot: ')) this.setGait(line.slice('# boot: '.length).replaceAll('-', ' '));
    else if (line.startsWith(GREETING)) this.handleBanner(line);
    else if (line.startsWith('# fault') || line === DONE) this.setGait(stop);
  }

  private handleBanner(line: string): void {
    const { dialogue } = this;
    const bannerNumber = ++this.banners;
    this.setGait('stand');
    this.setPace(FULL_PACE);
    this.isWatching = false;
    this.deadman.forget();
    this.listener.trouble('board', null);
    this.setBoardBanner(parseBanner(line) ?? 'unknown');
    this.onBanner();
    // A byte would cancel `boot`.
    this.mayAsk = false;
    void this.link.wait(BOOT_TIMEOUT_MS).then(() => {
      // The board may have restarted meanwhile, or the boot loader may use the line.
      if (this.banners !== bannerNumber || dialogue.isClosed) return;
      this.mayAsk = true;
      if (this.isReal && !this.isWatching) void this.watch();
    });
  }

  private setBoardBanner(banner: BoardBanner): void {
    this.boardBanner = banner;
    this.listener.found(banner);
  }

  private setPace(percent: number): void {
    // A cycle whose pace changes is not measured.
    if (percent !== this.pace) this.path.clear();
    this.pace = percent;
    this.listener.speed(percent);
  }

  private setGait(gait: string): void {
    this.gait = gait;
    this.restoreDeadmanIfIdle();
    this.path.clear();
    this.listener.doing(gait);
  }

  /** Sends a line and returns its answer. Shows an error, unless the line is quiet, and returns null. */
  async ask(line: string, isQuiet = false, timeoutMs?: number): Promise<Answer | null> {
    if (!isQuiet) this.mayAsk = true;
    const { deadman } = this;
    const command = line.trim().toLowerCase();
    if (command === WORDS.stop) this.stops += 1;
    const isDrive = this.isReal && this.walks(command);
    if (isDrive) this.drives += 1;
    try {
      if (isDrive) {
        const { stops } = this;
        const isSure = await deadman.begin();
        // The robot was stopped meanwhile.
        if (stops !== this.stops) return null;
        if (!isSure) throw new Error(`"${line}" was not sent, since the robot has not confirmed that it stops when it hears nothing`);
      }
      // `cal` must print and `save` must store the robot's own setting, not the page's.
      const needsOwnDeadman = deadman.isSet && [WORDS.cal, WORDS.save].some((word) => word === command);
      if (needsOwnDeadman) deadman.end();
      const pendingAnswer = this.dialogue.ask(line, isQuiet, timeoutMs);
      if (needsOwnDeadman && this.walksAlone) void deadman.begin();
      const answer = await pendingAnswer;
      if (!isQuiet) this.listener.trouble('line', null);
      deadman.follow(command, answer.ok);
      return answer;
    } catch (error) {
      // A quiet line is sent again; until then the page shows that the robot is silent.
      if (!isQuiet && !(error instanceof DroppedQuestion)) this.listener.trouble('line', `${messageOf(error)}.`);
      return null;
    } finally {
      if (isDrive) {
        this.drives -= 1;
        this.restoreDeadmanIfIdle();
      }
    }
  }

  async status(): Promise<Status | null> {
    const answer = await this.ask(WORDS.status, true, STATUS_TIMEOUT_MS);
    return answer && parseStatus(answer.text);
  }

  /** Takes the robot's state as soon as its line is read: taken later, it could overwrite a newer one. */
  private handleStatus(status: Status): void {
    if (status.speed !== null) this.setPace(status.speed);
    this.listener.trouble('fault', status.fault === LINK_FAULT && this.isReal ? 'The robot has stopped by itself: no line had reached it for too long.' : null);
    const gait = status.gait.replaceAll('-', ' ');
    // `center` is a pose for the robot, and a routine that rests is still under way.
    const isKnown = (gait === WORDS.pose && this.gait === WORDS.center) || (gait === WORDS.rest && this.isRoutine && status.fault === 'none');
    // The page has missed the start of this activity, for example because its link was cut.
    if (gait !== this.gait && !isKnown) this.setGait(gait);
    this.listener.state(status);
  }

  /** Presses the reset button of the board. */
  async reset(): Promise<void> {
    this.dialogue.forget();
    this.deadman.forget();
    this.setGait('');
    await this.link.reset();
  }

  /**
   * Writes firmware and robot, or the robot alone after the firmware that the board has, and starts it. Throws an error
   * for the user, which says what the board has then.
   */
  async flash(bytes: Uint8Array, isRobotAlone: boolean, progress: Progress): Promise<void> {
    const { link } = this;
    if (link.kind === 'radio') throw new Error(BY_CABLE);
    const endAddress = bytes.length + (isRobotAlone ? this.description.start : 0);
    await this.withBootLoader(link, async ({ Board, needsUno, upload }, line) => {
      const board = !link.mayBeNano || !needsUno(endAddress) ? Board.Unknown : this.listener.isUno() ? Board.Uno : Board.Nano;
      this.boardBanner = undefined;
      this.isWatching = false;
      this.mayAsk = false;
      await upload(line, bytes, isRobotAlone, board, progress);
    });
  }

  /** Gives the line to the boot loader until `act` has ended. Throws an error for the user. */
  private async withBootLoader<T>(link: Link, act: (board: Awaited<ReturnType<typeof loadBoard>>, line: BootLine) => Promise<T>): Promise<T> {
    const board = await loadBoard();
    if (this.link !== link) throw new Error(`the ${link.name} is not connected any more`);
    this.dialogue.end();
    const line = new BootLine(link);
    try {
      return await act(board, line);
    } finally {
      await line.end();
      if (this.link === link) {
        this.listen();
        this.setGait('');
      }
    }
  }

  /**
   * Waits for the banner of a board that was just written; `hash` is the expected robot's, or null. Returns what is
   * wrong, or null.
   */
  async waitForBanner(hash: string | null): Promise<string | null> {
    const { link } = this;
    const hasGreeted = await this.greeting();
    if (this.link !== link) return null;
    if (!hasGreeted) {
      this.setBoardBanner(null);
      this.listener.trouble('board', `What was written to the ${link.name} is not this firmware: it sends no banner.`);
      return 'it sends no banner of this firmware';
    }
    const boardHash = isBanner(this.boardBanner) ? this.boardBanner.robot?.hash : null;
    return hash !== null && boardHash !== hash ? 'but it does not say that it has this robot: write firmware and robot' : null;
  }

  private get simulated(): Simulated | null {
    return this.link && 'advance' in this.link ? (this.link as Simulated) : null;
  }

  /** Runs the simulation. */
  advance(ms: number): void {
    try {
      const { simulated } = this;
      // In short steps, so that each line of the robot gets its own time, even if a slow machine has much to catch up.
      for (let remainingMs = simulated ? ms : 0; remainingMs > 0; remainingMs -= CLOCK_STEP_MS) {
        const stepMs = Math.min(remainingMs, CLOCK_STEP_MS);
        this.clock += stepMs / 1000;
        simulated?.advance(stepMs);
      }
    } catch (error) {
      this.listener.trouble('simulation', `The simulated UNO has stopped: ${messageOf(error)}`);
      throw error;
    }
  }

  private handleWidths(widths: Four<number>): void {
    const frame = this.robot.pulses(widths);
    if (frame) this.handleFrame(frame, widths, FRAME_SECONDS);
  }

  private handlePose(angles: Four<number>): void {
    const frames = WATCH_FRAMES[this.link.kind];
    const frame = this.robot.pose(angles, frames);
    this.clock += FRAME_SECONDS * frames;
    if (frame) this.handleFrame(frame, null, FRAME_SECONDS * frames);
  }

  private handleFrame(frame: Frame, widths: Four<number> | null, seconds: number): void {
    this.last = frame;
    this.path.add(frame, seconds);
    this.listener.frame(frame, widths, seconds);
  }

  /**
   * Returns the displacement in the last complete cycle of the gait; null without a moving gait or a complete cycle.
   */
  measured(): Measured | null {
    const gait = this.description.gaits.find(({ command }) => command === this.gait);
    return gait?.moves ? this.path.measured((gait.period * FULL_PACE) / this.pace) : null;
  }

  /**
   * The predictions that came with the page; null unless the robot, its floor and its servos are those of the file.
   */
  get predicted(): Predictions | null {
    return this.toml === this.original && this.floorSetting === null && this.servos === 'own' ? this.predictions : null;
  }

  /** Puts the robot back to its start on the floor. */
  home(): void {
    this.robot.restart();
    this.path.clear();
  }

  /** Floor, mass, feet and leg drive: as set in the page, else as in robot.toml. */
  get floor(): Floor {
    return this.floorSetting ?? this.description.floor;
  }

  /** Sets floor, mass, feet and leg drive; null restores the values of robot.toml. */
  setFloor(floor: Floor | null): void {
    this.floorSetting = floor;
    this.robot.setFloor(this.floor);
    this.keep();
  }

  setServos(name: string): void {
    this.servos = name;
    this.robot.setServos(name);
    this.keep();
  }

  /** Closes or opens the contact of an input in the simulation. */
  setContact(name: string, isClosed: boolean): void {
    if (isClosed) this.closed.add(name);
    else this.closed.delete(name);
    const input = this.description.inputs.find(([inputName]) => inputName === name);
    if (input) this.simulated?.setContact(input[1], isClosed);
  }

  setSupply(volts: number): void {
    this.volts = volts;
    this.simulated?.setSupply(volts);
    this.keep();
  }
}
