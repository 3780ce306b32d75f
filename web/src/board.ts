// The board at the other end of the serial line, simulated or real: its link, its dialogue, and its robot's activity.
import { batch } from '@preact/signals-core';

import { formatActivity, isRoutine, parseActivity, startsWalking } from './activity';
import { BootLoaderLine } from './link/boot-loader-line';
import { Deadman } from './link/deadman';
import { type Answer, Dialogue, DroppedRequest, BANNER_PREFIX } from './link/dialogue';
import type { Link } from './link/link';
import { type Cause, getMessage } from './problem';
import { type Four, parseBanner, parsePoseReport, parseStatus, type Status } from './robot';
import { type BoardBanner, FULL_PACE, type SessionState } from './session-state';
import type { ShownRobot } from './shown-robot';
import { STAND, WORDS } from './words';

/** Number of frames per reported pose; a radio at 9600 baud cannot transmit more poses. */
const FRAMES_PER_REPORT = { usb: 2, radio: 10, simulated: 1 };
/** Longest time between a reset and this firmware's banner, ms. */
const BANNER_TIMEOUT_MS = 2500;
/** Longest wait for the answer to `status`, ms. */
const STATUS_TIMEOUT_MS = 1000;
/** Number of `status` lines sent to a robot that is back in range: the radio may lose some. */
const MAX_STATUS_COUNT = 12;
/** Longest waits for a board to stop, and for its own `deadman`, before the port is closed, ms. */
const STOP_TIMEOUT_MS = 1000;
/** Longest time between a reset and the `boot` action, which runs after three seconds, ms. */
const BOOT_TIMEOUT_MS = 4000;

/** The fault of a robot that received nothing for the `deadman` time. */
const LINK_FAULT = 'link';

/** Callbacks for a board's events; all other changes are in the session's state. */
export interface BoardListener {
  /** Called when a real board reports its pose, with its angles and the number of frames since the previous report. */
  onPose(angles: Four<number>, frameCount: number): void;
  /** Called with each visible sent line. */
  onSent(line: string): void;
  /** Called with each visible received line. */
  onReceived(line: string): void;
  /** Called with the current problem, or null once it is solved. */
  onProblem(cause: Cause, message: string | null): void;
}

export class Board {
  dialogue!: Dialogue;
  /** True if the page may send lines without the user's request; false while a byte would cancel `boot`. */
  mayAsk = false;
  /** Number of `stop` commands so far; a waiting drive command is outdated when it changes. */
  stopCount = 0;
  private deadman!: Deadman;
  /** Number of unanswered drive commands. */
  private pendingDriveCount = 0;
  /** True if the page has started the robot's walk; a walk that another sender has started does not need the page. */
  private isDriven = false;
  /** The arrival time of the robot's last line, on the page's clock, ms. */
  private lastLineAt = performance.now();
  /** Resolves the promise of `waitForBanner`. */
  private resolveBanner: () => void = () => {};
  /** The last requested pace, percent; null once the robot has answered. */
  private requestedPace: number | null = null;
  /** True once the page has requested the board's poses. */
  private isWatching = false;
  /** The number of frames in the robot's last status. */
  private frameCount = 0;
  /** The link that the page is leaving, or has left; null for none. */
  private leftLink: Link | null = null;

  constructor(
    private readonly state: SessionState,
    private readonly robot: ShownRobot,
    private readonly listener: BoardListener,
  ) {}

  get link(): Link {
    // The link is missing only before the first robot is loaded, when no view reads it.
    return this.state.link.value!;
  }

  /** True if the page is connected to a real board. */
  get isReal(): boolean {
    // The link is null before the first robot is loaded.
    return this.link !== null && this.link.kind !== 'simulated';
  }

  /** True while the page stops the board to leave it. */
  get isLeaving(): boolean {
    return this.leftLink === this.link;
  }

  /** The board's firmware and robot; undefined until known. */
  get banner(): BoardBanner | undefined {
    return this.state.banner.value;
  }

  get gait(): string {
    return this.state.gait.value;
  }

  /** The requested pace until the robot answers, else the robot's pace; percent. */
  get pace(): number {
    return this.requestedPace ?? this.state.pace.value;
  }

  /** Time since the robot's last line, s. */
  get secondsSinceLine(): number {
    return (performance.now() - this.lastLineAt) / 1000;
  }

  /** True if a real board is walking. */
  get isWalking(): boolean {
    return this.isReal && startsWalking(this.gait, this.robot.description);
  }

  /** True if a real board is walking, or will soon walk. */
  private get mayWalk(): boolean {
    return this.pendingDriveCount > 0 || this.isWalking;
  }

  /** Closes the current link, and then attaches the link that `makeLink` returns. */
  async attach(makeLink: () => Link): Promise<void> {
    this.dialogue?.close();
    await this.link?.close();
    // The robot may have changed while the link was closing.
    const link = makeLink();
    link.onRange = (isInRange) => void this.handleRange(link, isInRange);
    batch(() => {
      this.state.link.value = link;
      // An earlier radio's silence does not concern the new link.
      this.state.isSilent.value = false;
      this.state.refusal.value = '';
      this.state.status.value = null;
      this.forgetProgram();
      this.startDialogue();
      this.setGait('');
    });
    for (const cause of ['line', 'board', 'fault', 'simulation'] as const) this.listener.onProblem(cause, null);
  }

  /** Forgets the program that the board runs, because another program may start. */
  forgetProgram(): void {
    this.state.banner.value = undefined;
    this.isWatching = false;
    this.frameCount = 0;
    this.mayAsk = false;
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

  /** Runs `action` with the boot loader, which uses the line meanwhile. Throws an error with a message for the user. */
  async lendLine<T>(action: (line: BootLoaderLine) => Promise<T>): Promise<T> {
    const { link } = this;
    if (this.dialogue.isClosed) throw new Error('the page is already talking to the boot loader; try again in a few seconds');
    this.dialogue.close();
    const line = new BootLoaderLine(link);
    try {
      return await action(line);
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
   * Reports that a radio has lost its board, or continues once the board is back in range. A walking robot has stopped
   * by itself meanwhile.
   */
  private async handleRange(link: Link, isInRange: boolean): Promise<void> {
    if (this.link !== link) return;
    this.deadman.stopRepeating();
    this.state.isSilent.value = !isInRange || this.dialogue.isSilent;
    const message = `The ${link.name} is out of range. A walking robot stops by itself; the page reconnects as soon as possible.`;
    this.listener.onProblem('port', isInRange ? null : message);
    if (!isInRange) return;
    for (let n = 0; n < MAX_STATUS_COUNT && this.link === link; n++) {
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

  /** Requests reports of the board's poses. */
  async watch(): Promise<void> {
    const { link } = this;
    this.isWatching = true;
    const answer = await this.ask(`${WORDS.watch} ${FRAMES_PER_REPORT[link.kind]}`);
    // The next status requests them again.
    if (!answer && this.link === link) this.isWatching = false;
  }

  private handleLine(line: string): void {
    const angles = parsePoseReport(line);
    if (angles && this.isReal) return this.listener.onPose(angles, FRAMES_PER_REPORT[this.link.kind]);
    this.listener.onReceived(line);
    const pacePrefix = `ok ${WORDS.speed} `;
    const activity = parseActivity(line, this.robot.description);
    if (activity !== null) this.setGait(activity);
    else if (line.startsWith(pacePrefix)) this.setPace(Number(line.slice(pacePrefix.length)));
    else if (line.startsWith(BANNER_PREFIX)) this.handleBanner(line);
  }

  private handleBanner(line: string): void {
    const { dialogue } = this;
    // First, because `setGait` would send the robot's own `deadman`.
    this.deadman.reset();
    this.handleRestart();
    const bannerNumber = this.state.bannerCount.value;
    this.setGait(STAND);
    this.setPace(FULL_PACE);
    this.listener.onProblem('board', null);
    this.state.banner.value = parseBanner(line) ?? 'unknown';
    this.resolveBanner();
    // A byte would cancel the `boot` action.
    this.mayAsk = false;
    void this.link.wait(BOOT_TIMEOUT_MS).then(() => {
      // The board may have restarted meanwhile, or the boot loader may be using the line.
      if (this.state.bannerCount.value !== bannerNumber || dialogue.isClosed) return;
      this.mayAsk = true;
      if (this.isReal && !this.isWatching) void this.watch();
    });
  }

  /** Records a restart, which has undone the robot's settings. */
  private handleRestart(): void {
    this.state.bannerCount.value += 1;
    this.isWatching = false;
    this.frameCount = 0;
  }

  /** Handles a status as soon as its line is received, because it could later overwrite a newer state. */
  private handleStatus(status: Status): void {
    // The link has lost the banner of a restart: the firmware sends it at a baud rate that not every radio module uses.
    // The number is 0 if the link has damaged it.
    if (status.frames > 0 && status.frames < this.frameCount) {
      this.deadman.handleUnseenRestart();
      this.handleRestart();
    }
    if (status.frames > 0) this.frameCount = status.frames;
    if (this.isReal && this.banner && this.mayAsk && !this.isWatching) void this.watch();
    if (status.pace !== null) this.setPace(status.pace);
    // A fault lasts until the robot moves again, but is reported only once.
    if (status.fault !== this.state.status.value?.fault) {
      this.listener.onProblem('fault', status.fault === LINK_FAULT && this.isReal ? 'The robot has stopped by itself, because it received no line for too long.' : null);
    }
    const gait = formatActivity(status.gait);
    // The robot reports `center` as a pose, and the rest of a routine as `rest`.
    const isCenter = gait === WORDS.pose && this.gait === WORDS.center;
    const isRestInRoutine = gait === WORDS.rest && isRoutine(this.gait, this.robot.description) && status.fault === null;
    // The page missed the start of this activity, for example because the link was interrupted.
    if (gait !== this.gait && !isCenter && !isRestInRoutine) this.setGait(gait);
    this.state.status.value = status;
    // After a drive command without an answer, only the status tells whether the robot walks. The page's `deadman` ends
    // during a walk if the robot does not confirm it.
    if (this.isWalking && this.isDriven && !document.hidden) void this.deadman.engage();
    else this.restoreDeadmanIfIdle();
  }

  private setPace(percent: number): void {
    // A cycle in which the pace changes cannot be measured.
    if (percent !== this.state.pace.value) this.robot.startCycle();
    this.state.pace.value = percent;
  }

  private setGait(gait: string): void {
    this.state.gait.value = gait;
    if (!this.isWalking) this.isDriven = false;
    this.restoreDeadmanIfIdle();
    this.robot.startCycle();
  }

  /** Restores the robot's own `deadman` setting if the robot neither walks nor will soon walk. */
  private restoreDeadmanIfIdle(): void {
    if (!this.mayWalk) void this.deadman.restore();
  }

  /** Sends a line and returns its answer, or null after an error; the error is shown unless the line is quiet. */
  async ask(line: string, isQuiet = false, timeoutMs?: number): Promise<Answer | null> {
    // The link is null before the first robot is loaded. A board that the page leaves must not move again.
    if (this.link === null || this.isLeaving) return null;
    if (!isQuiet) this.mayAsk = true;
    const { deadman } = this;
    const command = line.trim().toLowerCase();
    if (command === WORDS.stop) this.stopCount += 1;
    const isDrive = this.isReal && startsWalking(command, this.robot.description);
    if (isDrive) this.pendingDriveCount += 1;
    let mayHaveStarted = false;
    try {
      if (isDrive) {
        if (document.hidden) throw new Error(`"${line}" was not sent, because the page is hidden`);
        const { stopCount } = this;
        const isConfirmed = await deadman.engage();
        // A `stop` was sent meanwhile.
        if (stopCount !== this.stopCount) return null;
        if (!isConfirmed) throw new Error(`"${line}" was not sent, because the robot did not confirm its deadman setting`);
      }
      mayHaveStarted = isDrive;
      const needsRobotSetting = this.isReal && Deadman.needsRobotSetting(command);
      const wasEngaged = deadman.isEngaged;
      const send = () => this.dialogue.ask(line, isQuiet, timeoutMs);
      const pendingAnswer = needsRobotSetting ? deadman.sendWithRobotSetting(command, send) : send();
      if (needsRobotSetting && wasEngaged && this.mayWalk) void deadman.engage();
      const answer = await pendingAnswer;
      if (!isQuiet) this.listener.onProblem('line', null);
      // The page does not know all gaits of a board with another robot.
      mayHaveStarted &&= answer.ok;
      if (mayHaveStarted && parseActivity(answer.text, this.robot.description) === null) this.setGait(command.replace(/ \d+$/, ''));
      deadman.observeUserLine(command, answer.ok);
      return answer;
    } catch (error) {
      deadman.observeUserLine(command, null);
      const isDropped = error instanceof DroppedRequest;
      // Only the answer may be lost; the robot's next status tells whether it walks.
      mayHaveStarted &&= !isDropped;
      // A quiet line is sent again later; until then, the page shows that the robot is silent.
      if (!isQuiet && !isDropped) this.listener.onProblem('line', `${getMessage(error)}.`);
      return null;
    } finally {
      if (isDrive) {
        this.pendingDriveCount -= 1;
        if (mayHaveStarted) this.isDriven = true;
        else this.restoreDeadmanIfIdle();
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

  /** Presses the reset button of the board. */
  async reset(): Promise<void> {
    this.dialogue.dropRequests();
    this.deadman.reset();
    this.setGait('');
    await this.link.reset();
  }

  /**
   * Stops a board that walks, or will soon walk, while the user may not see it; if `stop` does not arrive, `deadman`
   * stops the board.
   */
  stopIfWalking(): void {
    if (!this.mayWalk && !this.deadman?.isEngaged) return;
    this.deadman.stopRepeating();
    void this.ask(WORDS.stop);
  }

  /**
   * Stops a board before its disconnection; returns true if the board answers, or if no real board with this firmware
   * is connected.
   */
  async stop(): Promise<boolean> {
    if (!this.isReal || !this.banner) return true;
    const { link, dialogue } = this;
    this.stopCount += 1;
    const answer = dialogue.ask(WORDS.stop).catch(() => null);
    return Promise.race([answer, link.wait(STOP_TIMEOUT_MS)]).then(Boolean);
  }

  /** Stops a board, restores its own `deadman` and sends no other line to it; returns the result of `stop`. */
  async leave(): Promise<boolean> {
    const { deadman, link } = this;
    this.leftLink = link;
    const hasStopped = await this.stop();
    if (hasStopped) await Promise.race([deadman.restore(), link.wait(STOP_TIMEOUT_MS)]);
    return hasStopped;
  }
}
