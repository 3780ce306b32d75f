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
}

export interface Results {
  report: Report;
  /** As a table. */
  text: string;
  /** The path as CSV. */
  path: string;
}

/** A gait that the robot walked in the film. */
export interface Asked {
  toml: string;
  gait: string;
  /** Percent. */
  speed: number;
  /** Height of the deck's tag, mm; null for that of the board. */
  height: number | null;
  /** Length of the line of 100 mm, mm. */
  ruler: number;
  /** Begin and end of the walk on the film's clock, s; null for the whole film. */
  during: [number, number] | null;
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
