// The robot that the page shows, and what is at the other end of its serial line. Views only
// look at it and ask it to do things.
import { files } from './files';
import { CoreLink } from './link/core-link';
import { Dialogue, Forgotten } from './link/dialogue';
import type { Link, Simulated } from './link/link';
import { PortLink } from './link/port-link';
import { flash, imageOf, type Progress } from './link/stk500';
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
import { type Status, status, watched } from './status';
import { SimulatedBoard, FREQUENCY } from './uno/board';

/** How often a board on USB says where it is, in frames of 20 ms. */
const WATCH = 2;
/** A board that has not greeted within this, ms, is asked nevertheless. */
const PATIENCE = 8000;
/** `boot` acts three seconds after a reset, ms. */
const BOOTS = 4000;
const FRAME_SECONDS = 0.02;
/** The way of the last seconds that is kept to measure a cycle. */
const KEPT_SECONDS = 12;

export interface Listener {
  /** Another robot, or the same with other lengths. */
  robot(description: Description): void;
  frame(frame: Frame, widths: Four<number> | null): void;
  pulse(pin: number, rise: number, width: number): void;
  sent(line: string): void;
  came(line: string): void;
  /** What the robot does, as its answers say. */
  doing(gait: string): void;
  /** The hash of the tables that the image has, as its banner says. */
  tables(hash: string): void;
  /** Another end of the line. */
  link(link: Link): void;
  trouble(sentence: string | null): void;
}

/** The last cycle: mm ahead and left, seen from its start, deg, and how far a leg was behind its servo at most, deg. */
export interface Measured {
  forward: number;
  left: number;
  turn: number;
  lag: number;
}

export class Session {
  description!: Description;
  /** The name of its file; empty until that is there. */
  file = '';
  /** The robot.toml of the page's robot. */
  toml = '';
  /** The robot.toml as its file has it. */
  original = '';
  /** The HEX file of this very robot, if there is one. */
  image: string | null = null;
  last: Frame | null = null;
  gait = '';
  volts = 5;
  /** What the servos are taken for, among the models of the description. */
  servos = 'sg90';
  /** Whether the page may ask on its own. */
  mayAsk = false;
  link!: Link;
  dialogue!: Dialogue;
  private originalImage: string | null = null;
  private set: Floor | null = null;
  private bootLoader: string | null = null;
  private way: { time: number; frame: Frame }[] = [];
  private time = 0;
  private step = FRAME_SECONDS;
  private onBanner: () => void = () => {};

  constructor(
    readonly robot: Robot,
    private readonly listener: Listener,
  ) {}

  /** Takes a robot of the files, on a simulated UNO if it has an image. */
  async choose(name: string, hasImage: boolean): Promise<void> {
    this.file = '';
    this.set = null;
    this.toml = await files.toml(name);
    this.original = this.toml;
    this.image = hasImage ? await files.image(name) : null;
    this.originalImage = this.image;
    const refused = this.take();
    if (refused) throw new Error(refused.refused);
    await this.simulate();
    this.file = name;
  }

  /** Takes a changed robot.toml; the core runs it, unless it is that of the file. */
  async change(toml: string): Promise<Refused | null> {
    const before = this.toml;
    this.toml = toml;
    const refused = this.take();
    if (refused) {
      this.toml = before;
      return refused;
    }
    this.image = toml === this.original ? this.originalImage : null;
    if (!this.isReal) await this.simulate();
    return null;
  }

  /** Back to the robot of the file. */
  async restore(): Promise<void> {
    this.toml = this.original;
    this.image = this.originalImage;
    this.take();
    if (!this.isReal) await this.simulate();
  }

  private take(): Refused | null {
    const answer = this.robot.read(this.toml);
    if (isRefused(answer)) return answer;
    this.description = answer;
    this.robot.setFloor(this.floor);
    this.way = [];
    this.last = this.robot.pose(answer.servos.map(({ neutral }) => neutral) as Four<number>, 1);
    this.listener.robot(answer);
    return null;
  }

  get isReal(): boolean {
    return this.link instanceof PortLink;
  }

  /** Begins anew at power-on: the image on a simulated UNO, or else the core. */
  async simulate(): Promise<void> {
    const pins = this.description.servos.map(({ pin }) => pin);
    if (this.image !== null) {
      this.bootLoader ??= await files.bootLoader();
      const board = new SimulatedBoard(this.image, this.bootLoader, this.description.rail);
      const events = {
        frame: (widths: Four<number>) => this.widths(widths),
        pulse: (pin: number, rise: number, width: number) => this.listener.pulse(pin, rise, width),
      };
      await this.attach(new UnoLink(board, pins, events));
    } else {
      const core = new CoreLink(this.robot, (widths, cycle) => {
        // The core has no pins: its pulses are shown where an UNO has them, a slot of 4 ms each.
        widths.forEach((width, n) => {
          if (width > 0) this.listener.pulse(pins[n], cycle + n * 0.004 * FREQUENCY, width);
        });
        this.widths(widths);
      });
      await this.attach(core);
    }
    this.simulated?.supply(this.volts);
  }

  /** Takes a board on USB. */
  async connect(): Promise<void> {
    const link = await PortLink.open();
    link.onGone = (why) => {
      void this.simulate().then(() => this.listener.trouble(`The board is gone: ${why} The simulation goes on.`));
    };
    await this.attach(link);
    // Opening the port has reset the board. What comes before its banner goes to the boot loader.
    await Promise.race([new Promise<void>((greeted) => (this.onBanner = greeted)), link.wait(PATIENCE)]);
    await this.ask(`watch ${WATCH}`);
  }

  private async attach(link: Link): Promise<void> {
    this.dialogue?.end();
    await this.link?.close();
    this.link = link;
    this.listen();
    this.doing('');
    this.listener.link(link);
  }

  private listen(): void {
    this.dialogue = new Dialogue(this.link, {
      sent: (line) => this.listener.sent(line),
      came: (line) => this.came(line),
    });
  }

  private came(line: string): void {
    const pose = watched(line);
    if (pose && this.isReal) {
      this.pose(pose);
      return;
    }
    this.listener.came(line);
    const word = /^ok (.+)$/.exec(line)?.[1] ?? '';
    const doing = [...this.description.gaits.map(({ command }) => command), 'stop', 'rest', 'center'];
    if (doing.includes(word)) this.doing(word);
    else if (word.startsWith('pose ')) this.doing('pose');
    else if (line.startsWith('# boot: ')) this.doing(line.slice('# boot: '.length).replaceAll('-', ' '));
    else if (line.startsWith('# lizard ')) this.greeted(line);
    else if (line.startsWith('# fault')) this.doing('stop');
  }

  private greeted(banner: string): void {
    this.doing('stand');
    this.onBanner();
    const tables = / tables ([0-9a-f]{8})/.exec(banner)?.[1];
    if (tables !== undefined) this.listener.tables(tables);
    // A byte would call off what `boot` is set to.
    this.mayAsk = false;
    void this.link.wait(BOOTS).then(() => (this.mayAsk = true));
  }

  private doing(gait: string): void {
    this.gait = gait;
    this.way = [];
    this.listener.doing(gait);
  }

  /** Asks the robot; what goes wrong is shown. */
  async ask(line: string, quiet = false): Promise<{ ok: boolean; text: string; notes: string[] } | null> {
    if (!quiet) this.mayAsk = true;
    try {
      const answer = await this.dialogue.ask(line, quiet);
      this.listener.trouble(null);
      return answer;
    } catch (error) {
      if (error instanceof Forgotten) return null;
      this.listener.trouble(error instanceof Error ? `${error.message}.` : String(error));
      return null;
    }
  }

  async status(): Promise<Status | null> {
    const answer = await this.ask('status', true);
    return answer && status(answer.text);
  }

  /** Presses the reset button of the board. */
  async reset(): Promise<void> {
    this.dialogue.forget();
    this.doing('');
    await this.link.reset();
  }

  /** Writes an image by the boot loader and starts it. Throws a sentence. */
  async flash(hex: string, progress: Progress): Promise<void> {
    const image = imageOf(hex);
    this.dialogue.end();
    try {
      await flash(this.link, image, progress);
    } finally {
      this.listen();
      this.doing('');
    }
  }

  private get simulated(): Simulated | null {
    return this.link && 'advance' in this.link ? (this.link as Simulated) : null;
  }

  /** Lets the simulation run. */
  advance(ms: number): void {
    try {
      this.simulated?.advance(ms);
    } catch (error) {
      this.listener.trouble(`The simulated UNO has stopped: ${error instanceof Error ? error.message : String(error)}`);
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
    this.listener.frame(frame, widths);
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
  }

  setServos(name: string): void {
    this.servos = name;
    this.robot.setServos(name);
  }

  setSupply(volts: number): void {
    this.volts = volts;
    this.simulated?.supply(volts);
  }
}
