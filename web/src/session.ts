// The robot that the page shows, and what is at the other end of its serial line. Views only
// look at it and ask it to do things.
import { files } from './files';
import { type Kept, kept } from './kept';
import { type Answer, Dialogue, Forgotten, GREETING } from './link/dialogue';
import type { Link, Simulated } from './link/link';
import { PortLink } from './link/port-link';
import { flash, identify, imageOf, type Piece, type Progress, Unfit } from './link/stk500';
import { UnoLink } from './link/uno-link';
import {
  type Description,
  type Floor,
  type Four,
  type Frame,
  isRefused,
  type Refused,
  type Robot,
} from './robot';
import { type Banner, banner, type Status, status, watched } from './status';
import { type Cause, sentence } from './trouble';
import { SimulatedBoard } from './uno/board';
import { WORDS } from './words';

/** How often a board on USB says where it is, in frames of 20 ms. */
const WATCH = 2;
/** A board with this firmware has greeted so long after its reset, ms. */
const GREETS = 2500;
/** One that was not reset by its port answers within this, ms. */
const ANSWERS = 500;
/** A board that is left has stopped within this, ms. */
const STOPS = 1000;
/** `boot` acts three seconds after a reset, ms. */
const BOOTS = 4000;
/** The pace with which the firmware begins, percent. */
const FULL_PACE = 100;
const FRAME_SECONDS = 0.02;
/** The way of the last seconds that is kept to measure a cycle. */
const KEPT_SECONDS = 12;

/** What a board has, as it greets; `unknown` where this firmware answers but has not greeted, null where it does not. */
export type Has = Banner | 'unknown' | null;

export interface Listener {
  /** Another robot, or the same with other lengths. */
  robot(description: Description): void;
  /** A frame that took so many seconds. */
  frame(frame: Frame, widths: Four<number> | null, seconds: number): void;
  pulse(pin: number, rise: number, width: number): void;
  sent(line: string): void;
  came(line: string): void;
  /** What the robot does, as its answers say. */
  doing(gait: string): void;
  /** What the other end has. */
  found(has: Has): void;
  /** The pace that the robot has, percent. */
  speed(percent: number): void;
  /** Another end of the line. */
  link(link: Link): void;
  /** Whether a person says that a board is a UNO, and not a Nano, which would be ruined by what is written from a byte on. */
  isUno(from: number): boolean;
  /** What is wrong; null where that is so no more. */
  trouble(cause: Cause, sentence: string | null): void;
}

/** The last cycle: mm ahead and left, seen from its start, deg, and how far a leg was behind its servo at most, deg. */
export interface Measured {
  forward: number;
  left: number;
  turn: number;
  lag: number;
}

/** Where a Nano's boot section begins: its high fuse is 0xDA. A UNO's begins 1.5 KB later. */
const NANO_BOOT = 0x7800;

const isBanner = (has: Has | undefined): has is Banner => typeof has === 'object' && has !== null;

export class Session {
  description!: Description;
  /** The name of its file; empty until that is there. */
  file = '';
  /** The robot.toml of the page's robot. */
  toml = '';
  /** The robot.toml as its file has it. */
  original = '';
  /** What the robot is to the firmware: its section of flash. */
  section: Uint8Array = new Uint8Array();
  last: Frame | null = null;
  gait = '';
  volts = 5;
  /** What the servos are taken for, among the models of the description. */
  servos = 'sg90';
  /** Whether the page may ask on its own. */
  mayAsk = false;
  link!: Link;
  dialogue!: Dialogue;
  /** How often a board has greeted: one that begins anew has lost what was not saved. */
  beginnings = 0;
  /** The firmware, which is the same for every robot. */
  private code: Uint8Array | null = null;
  private set: Floor | null = null;
  private bootLoader: string | null = null;
  private way: { time: number; frame: Frame }[] = [];
  private time = 0;
  private step = FRAME_SECONDS;
  private onBanner: () => void = () => {};
  /** What is at the other end; undefined until that is known. */
  private there: Has | undefined;
  /** Whether a board without this firmware has the boot loader of an UNO. */
  hasLoader = false;
  /** Whether a board on USB says where it is. */
  private watching = false;
  /** Counts what was chosen: a file that comes late is not taken. */
  private choices = 0;

  constructor(
    readonly robot: Robot,
    private readonly listener: Listener,
  ) {}

  /**
   * Takes a robot of the files, on a new simulated UNO; a board on USB stays connected. Throws a sentence, and then the
   * robot of before stays.
   */
  async choose(name: string): Promise<void> {
    const choice = ++this.choices;
    const before = this.file;
    this.file = '';
    try {
      const [toml, code] = await Promise.all([files.toml(name), this.code ?? files.code().then(imageOf)]);
      if (choice !== this.choices) return;
      this.code = code;
      const refused = this.take(toml, null);
      if (refused) throw new Error(`${name}.toml: ${refused.refused}`);
      this.original = toml;
      await this.begin(false);
      this.file = name;
      this.keep();
    } catch (error) {
      // What another choice has overtaken is of no interest any more.
      if (choice !== this.choices) return;
      this.file = before;
      throw error;
    }
  }

  /** Takes a changed robot.toml: the simulated UNO begins anew with it, and keeps what it has saved. */
  async change(toml: string): Promise<Refused | null> {
    const refused = this.take(toml);
    if (refused) return refused;
    await this.begin(true);
    this.keep();
    return null;
  }

  /** Takes again what was changed before a reload, if its robot's file is still the same; whether it was. */
  async recall({ original, toml, floor, servos, volts }: Kept): Promise<boolean> {
    if (original !== this.original) return false;
    this.setServos(servos);
    this.setSupply(volts);
    if (this.take(toml, floor)) return false;
    await this.begin(true);
    this.keep();
    return true;
  }

  private keep(): void {
    const { file, original, toml, set: floor, servos, volts } = this;
    if (file !== '') kept.put({ file, original, toml, floor, servos, volts });
  }

  /** Back to the robot of the file. */
  async restore(): Promise<void> {
    await this.change(this.original);
  }

  private take(toml: string, set = this.set): Refused | null {
    const answer = this.robot.read(toml);
    if (isRefused(answer)) return answer;
    [this.toml, this.set] = [toml, set];
    this.description = answer;
    this.section = this.robot.section();
    this.robot.setFloor(this.floor);
    this.way = [];
    this.last = this.robot.pose(answer.servos.map(({ neutral }) => neutral) as Four<number>, 1);
    this.listener.robot(answer);
    return null;
  }

  /** Has the robot at the other end: a simulation begins anew, a board goes on with its own robot. */
  private async begin(keepsSaved: boolean): Promise<void> {
    if (!this.isReal) await this.simulate(keepsSaved && this.link instanceof UnoLink ? this.link.board.eeprom : undefined);
    else {
      this.listener.link(this.link);
      if (this.there !== undefined) this.listener.found(this.there);
    }
  }

  /** Firmware and robot, as flash begins with them. */
  get image(): Uint8Array {
    const { code, section, description } = this;
    if (!code) throw new Error('the firmware has not come yet');
    const image = new Uint8Array(description.start + section.length).fill(0xff);
    image.set(code);
    image.set(section, description.start);
    return image;
  }

  /** Whether this firmware answers at the other end. */
  get answers(): boolean {
    return this.there !== undefined && this.there !== null;
  }

  /** What the other end has; undefined until that is known. */
  get has(): Has | undefined {
    return this.there;
  }

  /** Whether the other end has this very robot. */
  get hasThis(): boolean {
    return isBanner(this.there) && this.there.robot?.hash === this.description.hash;
  }

  get isReal(): boolean {
    return this.link instanceof PortLink;
  }

  /** Begins anew at power-on, on a simulated UNO with this robot, and with what was saved on another one. */
  async simulate(saved?: Uint8Array): Promise<void> {
    this.bootLoader ??= await files.bootLoader();
    const pins = this.description.servos.map(({ pin }) => pin);
    const board = new SimulatedBoard(this.image, this.bootLoader, this.description.rail, saved);
    const events = {
      frame: (widths: Four<number>) => this.widths(widths),
      pulse: (pin: number, rise: number, width: number) => this.listener.pulse(pin, rise, width),
    };
    await this.attach(new UnoLink(board, pins, events));
    this.simulated?.supply(this.volts);
  }

  /** Takes a board on USB and says what it is; whether a person picked one and it is still there. Throws a sentence. */
  async connect(): Promise<boolean> {
    const link = await PortLink.open();
    if (!link) return false;
    link.onGone = (why) => {
      void this.simulate().then(() => this.listener.trouble('port', `The board is gone: ${why} The simulation goes on.`));
    };
    await this.attach(link);
    this.listener.trouble('port', null);
    // Opening the port has reset the board. What comes before its banner goes to the boot loader.
    const greeted = await this.greeting();
    if (this.link !== link) return false;
    if (!greeted && (await this.replies())) this.found('unknown');
    if (this.link !== link) return false;
    if (this.there) await this.watch();
    else await this.identify(link);
    return this.link === link;
  }

  /** Whether a board that was begun anew greets in time. */
  async greeting(): Promise<boolean> {
    const greeted = new Promise<boolean>((yes) => (this.onBanner = () => yes(true)));
    return Promise.race([greeted, this.link.wait(GREETS).then(() => false)]);
  }

  /** Whether this firmware is there: not every port resets its board. */
  private async replies(): Promise<boolean> {
    const answer = await this.dialogue.ask(WORDS.status, true, ANSWERS).catch(() => null);
    const read = answer && status(answer.text);
    if (read) this.doing(read.gait.replaceAll('-', ' '));
    return read !== null;
  }

  /** Says what a board is that does not have this firmware, as its boot loader knows. */
  private async identify(link: Link): Promise<void> {
    this.hasLoader = false;
    let said = 'The board is an Arduino UNO, an ATmega328P by its boot loader, and this firmware is not on it.';
    this.dialogue.end();
    try {
      await identify(link);
      this.hasLoader = true;
    } catch (error) {
      said = `The board does not speak as this firmware does, and asked for its boot loader ${sentence(error)}. Is it the right port, and an UNO?`;
    } finally {
      if (this.link === link) this.listen();
    }
    if (this.link !== link) return;
    this.found(null);
    this.listener.trouble('board', said);
  }

  /** Has a board say where it is. */
  private async watch(): Promise<void> {
    this.watching = true;
    await this.ask(`${WORDS.watch} ${WATCH}`);
  }

  /** Leaves a board, which stops, for the simulation. */
  async disconnect(): Promise<void> {
    const stopped = await this.stop();
    await this.simulate();
    if (!stopped) {
      this.listener.trouble('port', 'The board that was left did not say that it stops. If it walks on, press its reset button.');
    }
  }

  /** Whether a board walks that nobody would see any more if the page were closed. */
  get walksAlone(): boolean {
    const { stop, rest, center, pose } = WORDS;
    // A board may have another robot, with gaits that this one does not know.
    const known = this.description.gaits.find(({ command }) => command === this.gait);
    return this.isReal && (known ? known.moves : !['', stop, rest, center, pose].includes(this.gait));
  }

  /** Stops a board that is about to be left; whether it says so, or was not of this firmware. */
  async stop(): Promise<boolean> {
    if (!this.isReal || !this.there) return true;
    const answer = await this.dialogue.ask(WORDS.stop, false, STOPS).catch(() => null);
    return answer !== null;
  }

  private async attach(link: Link): Promise<void> {
    this.dialogue?.end();
    await this.link?.close();
    this.link = link;
    this.there = undefined;
    this.watching = false;
    this.mayAsk = false;
    this.listen();
    this.doing('');
    for (const cause of ['line', 'board'] as const) this.listener.trouble(cause, null);
    this.listener.link(link);
  }

  private listen(): void {
    this.dialogue = new Dialogue(this.link, {
      sent: (line) => this.listener.sent(line),
      came: (line) => this.came(line),
    });
  }

  private came(line: string): void {
    const angles = watched(line);
    if (angles && this.isReal) {
      this.pose(angles);
      return;
    }
    this.listener.came(line);
    const word = /^ok (.+)$/.exec(line)?.[1] ?? '';
    const { stop, rest, center, pose, speed } = WORDS;
    const doing = [...this.description.gaits.map(({ command }) => command), stop, rest, center];
    if (doing.includes(word)) this.doing(word);
    else if (word.startsWith(`${pose} `)) this.doing(pose);
    else if (word.startsWith(`${speed} `)) this.listener.speed(Number(word.slice(speed.length)));
    else if (line.startsWith('# boot: ')) this.doing(line.slice('# boot: '.length).replaceAll('-', ' '));
    else if (line.startsWith(GREETING)) this.greeted(line);
    else if (line.startsWith('# fault')) this.doing(stop);
  }

  private greeted(line: string): void {
    const { dialogue } = this;
    const beginning = ++this.beginnings;
    this.doing('stand');
    this.listener.speed(FULL_PACE);
    this.watching = false;
    this.listener.trouble('board', null);
    this.found(banner(line) ?? 'unknown');
    this.onBanner();
    // A byte would call off what `boot` is set to.
    this.mayAsk = false;
    void this.link.wait(BOOTS).then(() => {
      // It may have begun again meanwhile, or the boot loader may have the line.
      if (this.beginnings !== beginning || dialogue.over) return;
      this.mayAsk = true;
      if (this.isReal && !this.watching) void this.watch();
    });
  }

  private found(has: Has): void {
    this.there = has;
    this.listener.found(has);
  }

  private doing(gait: string): void {
    this.gait = gait;
    this.way = [];
    this.listener.doing(gait);
  }

  /** Asks the robot; what goes wrong is shown. */
  async ask(line: string, quiet = false): Promise<Answer | null> {
    if (!quiet) this.mayAsk = true;
    try {
      const answer = await this.dialogue.ask(line, quiet);
      this.listener.trouble('line', null);
      return answer;
    } catch (error) {
      if (!(error instanceof Forgotten)) this.listener.trouble('line', `${sentence(error)}.`);
      return null;
    }
  }

  async status(): Promise<Status | null> {
    const answer = await this.ask(WORDS.status, true);
    const read = answer && status(answer.text);
    if (read && read.speed !== null) this.listener.speed(read.speed);
    return read;
  }

  /** Presses the reset button of the board. */
  async reset(): Promise<void> {
    this.dialogue.forget();
    this.doing('');
    await this.link.reset();
  }

  /** Writes an image by the boot loader and starts it. Throws a sentence. */
  async flash(image: Uint8Array, progress: Progress): Promise<void> {
    await this.write({ at: 0, bytes: image }, progress, null);
  }

  /**
   * Writes the page's robot behind the firmware that is there, and starts it. Throws a sentence; an `Unfit` where that
   * firmware is another one than the page's, and then nothing was written.
   */
  async flashRobot(progress: Progress): Promise<void> {
    const { there, code, section, description } = this;
    if (!code) throw new Error('the firmware has not come yet');
    if (there === null) throw new Unfit('this firmware is not on the board: write firmware and robot');
    if (isBanner(there) && there.version !== description.version) {
      throw new Unfit(`the board has firmware ${there.version}, and this robot is for ${description.version}: write firmware and robot`);
    }
    // A board that has not greeted has not said which firmware it has: its code itself is looked at.
    await this.write({ at: description.start, bytes: section }, progress, isBanner(there) ? null : { at: 0, bytes: code });
  }

  private async write(piece: Piece, progress: Progress, under: Piece | null): Promise<void> {
    const { link } = this;
    if (piece.at + piece.bytes.length > NANO_BOOT && link.mayBeNano && !this.listener.isUno(NANO_BOOT)) {
      throw new Unfit(`a Nano has ${NANO_BOOT} bytes of flash before its boot section, and this takes ${piece.at + piece.bytes.length}; gaits can be left out until it fits`);
    }
    this.dialogue.end();
    this.there = undefined;
    this.watching = false;
    this.mayAsk = false;
    try {
      await flash(link, piece, progress, under);
    } finally {
      if (this.link === link) {
        this.listen();
        this.doing('');
      }
    }
  }

  /** What is wrong with a board that was just written, perhaps the robot of a hash; null if nothing is. */
  async begins(hash: string | null): Promise<string | null> {
    const { link } = this;
    const greeted = await this.greeting();
    if (this.link !== link) return null;
    if (!greeted) {
      this.found(null);
      this.listener.trouble('board', `What was written to the ${link.name} is not this firmware: it does not greet.`);
      return 'it does not greet as this firmware does';
    }
    const has = isBanner(this.there) ? this.there.robot?.hash : null;
    return hash !== null && has !== hash ? 'but it does not say that it has this robot: write firmware and robot' : null;
  }

  private get simulated(): Simulated | null {
    return this.link && 'advance' in this.link ? (this.link as Simulated) : null;
  }

  /** Lets the simulation run. */
  advance(ms: number): void {
    try {
      this.simulated?.advance(ms);
    } catch (error) {
      this.listener.trouble('simulation', `The simulated UNO has stopped: ${sentence(error)}`);
      throw error;
    }
  }

  private widths(widths: Four<number>): void {
    const frame = this.robot.pulses(widths);
    if (frame) this.moved(frame, widths, FRAME_SECONDS);
  }

  private pose(angles: Four<number>): void {
    const frame = this.robot.pose(angles, WATCH);
    if (frame) this.moved(frame, null, FRAME_SECONDS * WATCH);
  }

  private moved(frame: Frame, widths: Four<number> | null, seconds: number): void {
    this.time += seconds;
    this.step = seconds;
    this.last = frame;
    this.way.push({ time: this.time, frame });
    while (this.way[0].time < this.time - KEPT_SECONDS) this.way.shift();
    this.listener.frame(frame, widths, seconds);
  }

  /** The last whole cycle of the gait, if it has walked so long. */
  measured(): Measured | null {
    const gait = this.description.gaits.find(({ command }) => command === this.gait);
    const now = this.way[this.way.length - 1];
    if (!gait?.moves || !now) return null;
    // The nearest that is known: a board on USB does not tell every frame.
    const begun = now.time - gait.period;
    const from = this.way.findLastIndex(({ time }) => time <= begun + this.step / 2);
    if (from < 0) return null;
    const lags = this.way.slice(from + 1).flatMap(({ frame }) => frame.lag.map(Math.abs));
    const way = this.robot.between(this.way[from].frame.place, now.frame.place);
    return { ...way, lag: Math.max(0, ...lags) };
  }

  /** Takes the robot back to its start. */
  home(): void {
    this.robot.restart();
    this.way = [];
  }

  /** Floor, weight and springs: what the page has set, or else what the file says. */
  get floor(): Floor {
    return this.set ?? this.description.floor;
  }

  /** Sets them; null takes those of the file. */
  setFloor(floor: Floor | null): void {
    this.set = floor;
    this.robot.setFloor(this.floor);
    this.keep();
  }

  setServos(name: string): void {
    this.servos = name;
    this.robot.setServos(name);
    this.keep();
  }

  setSupply(volts: number): void {
    this.volts = volts;
    this.simulated?.supply(volts);
    this.keep();
  }
}
