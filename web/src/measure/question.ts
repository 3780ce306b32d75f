// The questions to the worker that looks at pictures, and its answers. The types of results are those that
// wasm-measure/src and crates/measure/src write as JSON.

/** A point of a picture, px. */
export type Pixel = [number, number];

export interface Tag {
  /** Its id on the sheet: 0 to 3 on the floor, 4 on the deck. */
  id: number;
  /** Its corners: top left, top right, bottom right, bottom left, as it is printed. */
  corners: [Pixel, Pixel, Pixel, Pixel];
}

/** A part of a cycle's movement: mm or deg. */
export interface Part {
  mean: number;
  /** Standard deviation of single cycles. */
  sd: number;
  /** Standard error of the mean. */
  error: number;
  predicted: number | null;
  /** The mean less the prediction, in standard errors. */
  differs: number | null;
  agrees: boolean | null;
}

/** A gait as `lizard measure --json` prints it. */
export interface Report {
  gait: string;
  /** Percent. */
  speed: number;
  cycles: number;
  forward: Part;
  left: Part;
  turn: Part;
  /** The way of a cycle by MuJoCo with ideal servos: mm ahead and to the left, deg; it is known for some robots. */
  mujoco?: [number, number, number];
  range?: Range;
}

/** The predicted way ahead or turn of a cycle if one assumption at a time is otherwise: mm or deg. */
export interface Range {
  /** Its name and unit. */
  part: string;
  least: number;
  most: number;
  /** The assumptions that make it so; null for those of robot.toml. */
  least_by: string | null;
  most_by: string | null;
}

/** Gaits in a film; walks of the same gait count together. */
export interface Results {
  gaits: Report[];
  /** The reasons why walks cannot be measured. */
  troubles: string[];
}

/** A gait that the robot walked in the film. */
export interface AskedWalk {
  /** Its name in robot.toml. */
  gait: string;
  /** Begin and end of the walk on the film's clock, s; null for the whole film. */
  during: [number, number] | null;
}

export interface Asked {
  toml: string;
  /** Percent. */
  speed: number;
  /** Height of the deck's tag, mm; null for that of the board. */
  height: number | null;
  /** Length of the line of 100 mm, mm. */
  ruler: number;
  /** The walks; if there are none, those between rests, each of the gait that it is clearly like. */
  walks: AskedWalk[];
}

export type Question =
  | { ask: 'picture'; picture: VideoFrame | ImageBitmap; seconds: number; isKept: boolean }
  | { ask: 'clear' }
  | { ask: 'measure'; asked: Asked }
  | { ask: 'sheet'; isLetter: boolean };

/** The tags of a picture, the picture's size, and the time that it took, ms. */
export interface Sight {
  tags: Tag[];
  size: [number, number];
  ms: number;
}

/** An answer to a question, or the reason why there is none. */
export type Answer = { well: unknown } | { refused: string };
