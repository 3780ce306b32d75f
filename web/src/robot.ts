// The robot in WebAssembly (wasm/): everything that is computed of it. Types are those that
// wasm/src writes as JSON; no formula is in this language.

/** mm, chassis frame: to the right, forward. */
export type Spot = [number, number];
export type Four<T> = [T, T, T, T];

export interface Gait {
  name: string;
  command: string;
  period: number;
  moves: boolean;
}

export interface Servo {
  name: string;
  leg: string;
  pin: number;
  neutral: number;
  /** deg from neutral. */
  travel: [number, number];
}

export interface Length {
  key: string;
  label: string;
  /** The key of its mirror image, or of the length that must equal it. */
  twin: string;
  unit: string;
  value: number;
}

export interface Description {
  hash: string;
  /** Its name, as a banner says it. */
  name: string;
  /** The version of the firmware that it is for. */
  version: string;
  /** Where in flash its section begins. */
  start: number;
  servos: Four<Servo>;
  gaits: Gait[];
  lengths: Length[];
  plate: Plate;
  margins: { name: string; limit: number }[];
  stroke: [number, number];
  supply: [number, number, number];
  /** The converter's channel of the servos' rail, and the volts there. */
  rail: [number, number] | null;
  floor: Floor;
  models: ServoModel[];
  /** Frames without motion after which it stands still. */
  still: number;
  /** The words of the console that mean the same to every robot. */
  words: string[];
}

/** The chassis from above, mm. */
export interface Plate {
  /** Half its width and half its length, without the arms. */
  half: Spot;
  corner: number;
  /** The arms that the legs are pivoted on, and half their width. */
  arms: [Spot, Spot][];
  arm: number;
  /** The middles of the servos' cases, their width and length. */
  cases: Four<Spot>;
  case: Spot;
}

/** What drives the legs, as robot.toml calls it. */
export type Kind = 'rigid' | 'strut';

/** What the robot stands on, what it weighs, and what drives its legs. */
export interface Floor {
  /** Of a pad that slides forward. */
  friction: number;
  /** Of a pad that slides backward over that. */
  ratio: number;
  /** g */
  mass: number;
  kind: Kind;
  /** What the spring in a strut pulls, N, and how much more for each mm, N/mm. */
  force: number;
  rate: number;
  /** A leg's play to either side, deg. */
  play: number;
  /** What lifts a foot by a mm, N. */
  leaf: number;
  /** By how much the front left foot is too long, mm. */
  twist: number;
}

/** Whether legs can be elsewhere than their servos. */
export const lags = ({ kind, play }: Floor) => kind !== 'rigid' || play > 0;

/** What servos may be taken for. */
export interface ServoModel {
  name: string;
  /** deg/s; null where it has no bound. */
  rate: number | null;
  /** us */
  dead_band: number;
}

export interface Refused {
  refused: string;
  line: number | null;
  key: string;
}

export interface Scene {
  angles: Four<number>;
  shafts: Four<Spot>;
  tips: Four<Spot>;
  points: [Spot, Spot];
  sliders: { shafts: [Spot, Spot]; tips: [Spot, Spot]; tube: Spot; travel: number }[];
  /** The driven pivot first; the strut from the servo's link to the leg's crank. */
  legs: Four<{ pivots: [Spot, Spot]; joints: [Spot, Spot]; foot: Spot; strut: [Spot, Spot]; sprung: boolean }>;
  margins: { name: string; value: number }[];
  smallest: { name: string; value: number };
  refusal: string | null;
  map: [[number, number], [number, number]];
}

/** Where the body is on the floor: mm, and deg counter-clockwise. */
export interface Place {
  x: number;
  y: number;
  heading: number;
}

export interface Frame {
  scene: Scene | null;
  fault: string | null;
  place: Place;
  slides: Four<number>;
  /** How far each leg is behind its servo, deg. */
  lag: Four<number>;
  /** How far each servo is from what its pulse asks for, deg. */
  errors: Four<number>;
}

/** What a cycle of a gait makes, mm and deg; null where that is undecided. */
export interface Way {
  forward: number | null;
  left: number | null;
  turn: number | null;
}

/** What a cycle of a gait comes to; the lag and the share of rigid legs' way where legs are on springs. */
export interface Outlook extends Way {
  /** deg */
  lag: number | null;
  share: number | null;
}

export interface SingularityMap {
  end: string;
  from: number;
  to: number;
  size: number;
  margins: (number | null)[];
  safe: boolean[];
  curves: { kind: string; points: [number, number][] }[];
}

export interface Said {
  widths: Four<number>;
  text: string;
}

/** A gait as four bars: numbers in servo order, LF, RF, RH, LH. */
export interface Bars {
  name: string;
  /** Whether legs move one after the other and hold in between. */
  held: boolean;
  /** s */
  period: number;
  /** The stance's share of the cycle. */
  duty: number;
  /** deg */
  amplitude: number;
  /** Where in the cycle each stance begins, 0 to 1; of legs that hold only the order counts. */
  start: Four<number>;
  /** Each leg's share of the amplitude. */
  gain: Four<number>;
}

/** What becomes of a gait on the page's robot. */
export interface Trial extends Outlook {
  /** For robot.toml. */
  table: string;
  margin: string;
  least: number;
  limit: number;
  servo: string;
  /** deg/s */
  speed: number;
  /** s */
  period: number;
}

/** What is wanted of a search for a faster gait. */
export interface Wish {
  /** The gait that is to be surpassed. */
  bars: Bars;
  /** How fast a servo may turn, deg/s; null for as fast as in that gait. */
  rate: number | null;
  /** As `lizard tune --rounds` and `--seed` have them. */
  rounds: number;
  seed: number;
}

/** A gait that was found, beside the one that was to be surpassed. */
export interface Found {
  bars: Bars;
  /** On random robots and floors that the search has not seen. */
  comparison: { unit: string; rate: number; robots: number; faster: number };
  /** Whether it surpasses the other one. */
  better: boolean;
  /** By what share, where 5 % of the robots are slower. */
  gain: number;
}

/** A gait whose head or tail goes round a line that was drawn. */
export interface Drawn {
  name: string;
  end: End;
  /** s */
  period: number;
  /** Over what was drawn, about the neutral point. */
  size: number;
  /** How many harmonics are kept of the line, 1 to 16. */
  terms: number;
  /** mm in the end's own frame: from the middle of its base, outward positive in y. */
  points: [number, number][];
}

export type End = 'head' | 'tail';

/** A gait that is being made. */
export type Made = Bars | Drawn;

/** Where the point of an end may be while the other stands: mm, as the points of `Drawn`. */
export interface Room {
  from: [number, number];
  step: number;
  columns: number;
  allowed: boolean[];
  neutral: [number, number];
  shafts: [[number, number], [number, number]];
}

/** Why a gait will not do, and the nearest values of which each alone would. */
export interface NoTrial extends Refused {
  instead: { what: Instead; value: number }[];
}

export type Instead = 'amplitude' | 'size' | 'period';

/** What wasm/src/abi.rs exports. */
interface Exports {
  memory: WebAssembly.Memory;
  lizard_input(length: number): number;
  lizard_ask(): number;
  lizard_output(): number;
}

export function isRefused(answer: object): answer is Refused {
  return 'refused' in answer;
}

export class Robot {
  private readonly wasm: Exports;
  private readonly encoder = new TextEncoder();
  private readonly decoder = new TextDecoder();

  private constructor(wasm: Exports) {
    this.wasm = wasm;
  }

  static async load(module: WebAssembly.Module): Promise<Robot> {
    const { exports } = await WebAssembly.instantiate(module, {});
    return new Robot(exports as unknown as Exports);
  }

  /** Takes the robot of a robot.toml. If that is refused, the one of before stays. */
  read(toml: string): Description | Refused {
    return this.ask('read', toml);
  }

  /** A robot.toml with another number at a key, and whether it will do. */
  edit(toml: string, key: string, value: number): { text: string; refusal: Refused | null } | Refused {
    return this.ask('edit', [toml, key, value]);
  }

  /** A robot.toml with this floor, weight, feet and drive, and whether it will do. */
  editFloor(toml: string, floor: Floor): { text: string; refusal: Refused | null } | Refused {
    return this.ask('edit_floor', [toml, floor]);
  }

  /**
   * What the robot that was read is to the firmware: its section of flash, with the certified cells of its guard; empty
   * without a robot. Takes some hundredths of a second.
   */
  section(): Uint8Array {
    return Uint8Array.from(this.ask<number[] | null>('section') ?? []);
  }

  /** The next frame's pulse widths, CPU cycles; 0 for none. */
  pulses(widths: Four<number>): Frame | null {
    return this.ask('pulses', widths);
  }

  /** The next pose, deg, so many frames after the one before. */
  pose(angles: Four<number>, frames: number): Frame | null {
    return this.ask('pose', [angles, frames]);
  }

  /** Back to the start of the way. */
  restart(): void {
    this.ask('restart');
  }

  /** The way from one place to another, seen from the first: mm and deg. */
  between(from: Place, to: Place): { forward: number; left: number; turn: number } {
    return this.ask('way', [from, to]);
  }

  setFloor(floor: Floor): void {
    this.ask('set_floor', floor);
  }

  /** What its servos are taken for, by its name among the models of the description. */
  setServos(name: string): void {
    this.ask('set_servos', name);
  }

  /** Takes tenths of a second; the page asks its Predictor. */
  predict(gait: number): Outlook | null {
    return this.ask('predict', gait);
  }

  /** Of the head (0) or the tail (1). */
  map(end: number): SingularityMap | null {
    return this.ask('map', end);
  }

  /** The gait whose time runs backwards. */
  turnedRound(bars: Bars): Bars {
    return this.ask('reversed', bars);
  }

  /** A gait as bars; null for one along a path and one that stands. */
  bars(gait: number): Bars | null {
    return this.ask('bars', gait);
  }

  /** Tries a gait on the robot that was read; takes tenths of a second. Null for a line without length. */
  trial(made: Made): Trial | NoTrial | null {
    return this.ask('trial', made);
  }

  /** Prepares the search of a faster gait for the robot that was read: the number of gaits to try, and the servos' deg/s. */
  makeFaster(wish: Wish): { all: number; rate: number } | Refused {
    return this.ask('faster', wish);
  }

  /** Tries one more gait; `best` is the score of the best so far. */
  fasterStep(): { done: number; best: number | null } {
    return this.ask('faster_step');
  }

  /** The best so far, compared on so many random robots; null as long as no gait was one that the limits allow. */
  fasterFound(robots: number): Found | null {
    return this.ask('faster_found', robots);
  }

  /** A robot.toml with this gait, in place of the one of its name. */
  putGait(toml: string, made: Made): string {
    return this.ask('put_gait', [toml, made]);
  }

  /** The line that the point really goes along; null of a line without length. */
  path(drawn: Drawn): [number, number][] | null {
    return this.ask('path', drawn);
  }

  /** Where the point of an end may be. */
  room(end: End): Room | null {
    return this.ask('room', end === 'head' ? 0 : 1);
  }

  /** Begins to run the firmware's core with this robot's numbers. */
  runCore(): void {
    this.ask('run_core');
  }

  /** A frame of the core, 20 ms. */
  coreFrame(line: string, volts: number): Said | null {
    return this.ask('core_frame', [line, volts]);
  }

  /** Asks a `Question` of wasm/src/abi.rs. */
  private ask<T>(question: string, needs: unknown = null): T {
    const { wasm, encoder, decoder } = this;
    const bytes = encoder.encode(JSON.stringify({ [question]: needs }));
    const at = wasm.lizard_input(bytes.length);
    new Uint8Array(wasm.memory.buffer).set(bytes, at);
    const length = wasm.lizard_ask();
    return JSON.parse(decoder.decode(new Uint8Array(wasm.memory.buffer, wasm.lizard_output(), length))) as T;
  }
}
