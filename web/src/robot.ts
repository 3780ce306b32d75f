// Calls of the robot in WebAssembly (wasm/), which computes everything. The types are those that
// wasm/src writes as JSON; no formula is repeated in TypeScript.

/** A point in the chassis frame, mm: right, forward. */
export type Point = [number, number];
export type Four<T> = [T, T, T, T];

export interface Gait {
  name: string;
  command: string;
  period: number;
  moves: boolean;
  /** True if its phase runs backwards. */
  reversed: boolean;
}

export interface Servo {
  name: string;
  leg: string;
  pin: number;
  neutral: number;
  /** Travel, deg from neutral. */
  travel: [number, number];
}

export interface Length {
  key: string;
  label: string;
  /** The key of the mirrored length, or of the length that must be equal. */
  twin: string;
  unit: string;
  value: number;
}

export interface Description {
  hash: string;
  /** The robot's name, as in a banner. */
  name: string;
  /** The firmware version that it fits. */
  version: string;
  /** Address in flash at which its section begins. */
  start: number;
  servos: Four<Servo>;
  gaits: Gait[];
  /** Commands that begin a routine. */
  routines: string[];
  lengths: Length[];
  plate: Plate;
  margins: { name: string; limit: number }[];
  stroke: [number, number];
  supply: [number, number, number];
  /** Percent of their own pace to which the first of them limits gaits. */
  slow_pace: number;
  /** The converter's channel of the servos' rail, and the volts there. */
  rail: [number, number] | null;
  /** The inputs: name, and Arduino number of the pin. */
  inputs: [string, number][];
  floor: Floor;
  models: ServoModel[];
  /** Frames without motion after which the robot counts as standing still. */
  still: number;
  /** The console's words, which are the same for every robot. */
  words: string[];
}

/** The chassis from above, mm. */
export interface Plate {
  /** Half the width and half the length, without the arms. */
  half: Point;
  corner: number;
  /** The arms that the legs are pivoted on, and half their width. */
  arms: [Point, Point][];
  arm: number;
  /** The middles of the servos' cases, their width and length. */
  cases: Four<Point>;
  case: Point;
}

/** The kind of leg drive, by its name in robot.toml. */
export type Kind = 'rigid' | 'strut';

/** The floor, the robot's mass and its leg drive. */
export interface Floor {
  /** Friction of a pad that slides forward. */
  friction: number;
  /** Friction of a pad that slides backward, relative to `friction`. */
  ratio: number;
  /** Mass, g. */
  mass: number;
  kind: Kind;
  /** Preload of the spring in a strut, N, and its rate, N/mm. */
  force: number;
  rate: number;
  /** Play of a leg to either side, deg. */
  play: number;
  /** Stiffness of a foot's leaf, N/mm. */
  leaf: number;
  /** Excess length of the front left foot, mm. */
  twist: number;
}

/** Returns true if a leg can deviate from its servo. */
export const lags = ({ kind, play }: Floor) => kind !== 'rigid' || play > 0;

/** A model of the servos. */
export interface ServoModel {
  name: string;
  /** Stall torque, kg cm, and time for 60 deg, s, both at a supply in V; and their supply in the robot, V. Null for ideal servos. */
  figures: [number, number, number, number] | null;
}

export interface Refused {
  /** The mistake and its place. */
  refused: string;
  /** The mistake without its place and figures; null where the message has no shorter form. */
  meaning: string | null;
  line: number | null;
  key: string;
}

/** Lengths by their keys in robot.toml. */
export type Edits = [key: string, value: number][];

/** A robot.toml with other lengths, its refusal, and what would do instead. */
export interface TriedLengths {
  text: string;
  refusal: Refused | null;
  /** The nearest lengths that are accepted. */
  nearest: { lengths: Edits; text: string } | null;
  /** The lengths wanted, on a robot that gives up the gait which forbids them. */
  without: { gait: string; text: string } | null;
}

export interface Scene {
  angles: Four<number>;
  shafts: Four<Point>;
  tips: Four<Point>;
  points: [Point, Point];
  sliders: { shafts: [Point, Point]; tips: [Point, Point]; tube: Point; travel: number }[];
  /** Pivots and joints, the driven one first; the strut goes from the servo's link to the leg's crank. */
  legs: Four<{ pivots: [Point, Point]; joints: [Point, Point]; foot: Point; strut: [Point, Point]; sprung: boolean }>;
  margins: { name: string; value: number }[];
  smallest: { name: string; value: number };
  refusal: string | null;
  map: [[number, number], [number, number]];
}

/** Place of the body on the floor, mm, and heading, deg counter-clockwise. */
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
  /** Lag of each leg behind its servo, deg. */
  lag: Four<number>;
  /** Position error of each servo against its pulse, deg. */
  errors: Four<number>;
}

/** Displacement per cycle, mm and deg; null where two feet pull against two, so that the model does not determine it. */
export interface Displacement {
  forward: number | null;
  left: number | null;
  turn: number | null;
}

/** Prediction for one cycle of a gait; with springs also the lag, and the share of the displacement with rigid legs. */
export interface GaitPrediction extends Displacement {
  /** Largest lag, deg. */
  lag: number | null;
  share: number | null;
  /** Largest share of a servo's torque-speed line at equal steps of the pace up to the gait's own; null with ideal servos. */
  lines: number[] | null;
}

/** The predictions of a robot's gaits in their order; null for what is no gait. */
export type Predictions = (GaitPrediction | null)[];

/** A routine as it is written, right or wrong. */
export interface Routine {
  name: string;
  steps: string[];
}

/** The predicted path of one round of a routine. */
export interface RoundPath {
  places: Place[];
  seconds: number;
  /** True if the round goes on beyond the path. */
  is_cut: boolean;
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

export interface CoreAnswer {
  widths: Four<number>;
  text: string;
}

/** A gait as four bars: numbers in servo order, LF, RF, RH, LH. */
export interface Bars {
  name: string;
  /** True if legs move one after the other and hold in between. */
  held: boolean;
  /** Period, s. */
  period: number;
  /** Duty factor: the stance's share of the cycle. */
  duty: number;
  /** Amplitude, deg. */
  amplitude: number;
  /** Phase at which each stance begins, 0 to 1; of legs that hold only the order counts. */
  start: Four<number>;
  /** Gain of each leg: its share of the amplitude. */
  gain: Four<number>;
}

/** Trial of an edited gait on the page's robot. */
export interface Trial extends GaitPrediction {
  /** The table for robot.toml. */
  table: string;
  margin: string;
  least: number;
  limit: number;
  servo: string;
  /** Fastest servo, deg/s. */
  speed: number;
  /** Period, s. */
  period: number;
}

/** Goal and limits of a search for a faster gait. */
export interface SearchTask {
  /** The gait to beat. */
  bars: Bars;
  /** Fastest servo allowed, deg/s; null for that of the gait to beat. */
  rate: number | null;
  /** Rounds and seed, as for `lizard tune`. */
  rounds: number;
  seed: number;
}

/** A gait that the search found, compared with the gait to beat. */
export interface Found {
  bars: Bars;
  /** Comparison on random robots and floors that the search did not use. */
  comparison: { unit: string; rate: number; robots: number; faster: number };
  /** True if it is better. */
  better: boolean;
  /** Gain as a share, at the fifth percentile of the robots. */
  gain: number;
}

/** A gait whose head or tail follows a drawn line. */
export interface DrawnGait {
  name: string;
  end: End;
  /** Period, s. */
  period: number;
  /** Scale of the drawn line, about the neutral point. */
  size: number;
  /** Harmonics of the line that are kept, 1 to 16. */
  terms: number;
  /** Points in the end's own frame, mm: from the middle of its base, outward positive in y. */
  points: [number, number][];
}

export type End = 'head' | 'tail';

/** An edited gait. */
export type EditedGait = Bars | DrawnGait;

/** Points that the head or tail may reach while the other end stands, in the frame of `DrawnGait`, mm. */
export interface ReachArea {
  from: [number, number];
  step: number;
  columns: number;
  allowed: boolean[];
  neutral: [number, number];
  shafts: [[number, number], [number, number]];
}

/** Refusal of a gait, with the nearest values each of which alone would be accepted. */
export interface NoTrial extends Refused {
  instead: { what: Alternative; value: number }[];
}

export type Alternative = 'amplitude' | 'size' | 'period';

/** The exports of wasm/src/abi.rs. */
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

  /** Loads the robot of a robot.toml. If it is refused, the previous robot stays. */
  read(toml: string): Description | Refused {
    return this.ask('read', toml);
  }

  /** Tries other lengths in a robot.toml; `searches` also looks for what would do. */
  lengths(toml: string, edits: Edits, searches: boolean): TriedLengths {
    return this.ask('lengths', [toml, edits, searches]);
  }

  /** The least and the greatest value with which the robot walks if all these lengths have it; null for an unknown key. */
  lengthRange(toml: string, keys: string[]): [number, number] | null {
    return this.ask('length_range', [toml, keys]);
  }

  /** Returns the robot.toml with this floor, mass, feet and drive, and its refusal, if any. */
  editFloor(toml: string, floor: Floor): { text: string; refusal: Refused | null } | Refused {
    return this.ask('edit_floor', [toml, floor]);
  }

  /**
   * Makes the robot's section of flash, with the certified cells of its guard; empty without a robot. Takes some
   * hundredths of a second.
   */
  section(): Uint8Array {
    return Uint8Array.from(this.ask<number[] | null>('section') ?? []);
  }

  /** Moves the robot by a frame with these pulse widths, CPU cycles; 0 for none. */
  pulses(widths: Four<number>): Frame | null {
    return this.ask('pulses', widths);
  }

  /** Moves the robot to a pose, deg, reached some frames after the previous one. */
  pose(angles: Four<number>, frames: number): Frame | null {
    return this.ask('pose', [angles, frames]);
  }

  /** Returns the robot to the start of its path. */
  restart(): void {
    this.ask('restart');
  }

  /** The displacement between two places in the frame of the first, mm and deg. */
  between(from: Place, to: Place): { forward: number; left: number; turn: number } {
    return this.ask('way', [from, to]);
  }

  setFloor(floor: Floor): void {
    this.ask('set_floor', floor);
  }

  /** Selects the servo model by its name in the description, perhaps on another supply in V, as `own at 4.2`. */
  setServos(name: string): void {
    this.ask('set_servos', name);
  }

  /** Predicts a gait. Takes tenths of a second, so the page asks its Predictor. */
  predict(gait: number): GaitPrediction | null {
    return this.ask('predict', gait);
  }

  /** The map of the head (0) or the tail (1). */
  map(end: number): SingularityMap | null {
    return this.ask('map', end);
  }

  /** The gait in reverse. */
  turnedRound(bars: Bars): Bars {
    return this.ask('reversed', bars);
  }

  /** A gait as bars; null for a gait along a path and for one without motion. */
  bars(gait: number): Bars | null {
    return this.ask('bars', gait);
  }

  /** Tries a gait on the robot that was read; takes tenths of a second. Null for a line without length. */
  trial(made: EditedGait): Trial | NoTrial | null {
    return this.ask('trial', made);
  }

  /** Prepares the search of a faster gait for the robot that was read: the number of gaits to try, and the servos' deg/s. */
  makeFaster(task: SearchTask): { all: number; rate: number } | Refused {
    return this.ask('faster', task);
  }

  /** Tries one more gait; `best` is the score of the best so far. */
  fasterStep(): { done: number; best: number | null } {
    return this.ask('faster_step');
  }

  /** The best so far, compared on a number of random robots; null while no gait kept the limits. */
  fasterFound(robots: number): Found | null {
    return this.ask('faster_found', robots);
  }

  /** Returns the robot.toml with this gait in place of the one of that name. */
  putGait(toml: string, made: EditedGait): string {
    return this.ask('put_gait', [toml, made]);
  }

  /** The routines of a robot.toml, also of one with a mistake. */
  routines(toml: string): Routine[] {
    return this.ask('routines', toml);
  }

  /** Returns the robot.toml with a routine of these steps, and its refusal, if any. */
  putSteps(toml: string, { name, steps }: Routine): { text: string; refusal: Refused | null } {
    return this.ask('put_steps', [toml, name, steps]);
  }

  /** Goes through one round of a routine; takes tenths of a second. Null without the routine. */
  round(routine: string): RoundPath | null {
    return this.ask('round', routine);
  }

  /** The path that the point really follows; null if the drawn line has no length. */
  path(drawn: DrawnGait): [number, number][] | null {
    return this.ask('path', drawn);
  }

  /** The points that an end may reach. */
  room(end: End): ReachArea | null {
    return this.ask('reach_area', end === 'head' ? 0 : 1);
  }

  /** Starts the firmware's core with this robot. */
  runCore(): void {
    this.ask('run_core');
  }

  /** Runs the core for a frame of 20 ms. */
  coreFrame(line: string, volts: number): CoreAnswer | null {
    return this.ask('core_frame', [line, volts]);
  }

  /** Sends a `Question` of wasm/src/abi.rs and returns its answer. */
  private ask<T>(question: string, needs: unknown = null): T {
    const { wasm, encoder, decoder } = this;
    const bytes = encoder.encode(JSON.stringify({ [question]: needs }));
    const at = wasm.lizard_input(bytes.length);
    new Uint8Array(wasm.memory.buffer).set(bytes, at);
    const length = wasm.lizard_ask();
    return JSON.parse(decoder.decode(new Uint8Array(wasm.memory.buffer, wasm.lizard_output(), length))) as T;
  }
}
