// The robot in WebAssembly, which computes everything; no formula is repeated in TypeScript. The types come from
// wasm/src.
import { type Description, type DrawnGait, type Floor, type GaitPrediction, initSync, type Refused, type RefusedTrial, Robot } from '../generated/lizard';

export { calibrationText, parseBanner, parseCalibration, parsePoseReport, parseStatus, Robot } from '../generated/lizard';
export type {
  Banner, Bars, Calibration, Description, DrawnGait, Edits, EditedGait, Floor, Four, Frame, GaitPrediction, Place, Refused, RefusedTrial, RoundPath, Routine, Scene, ServoSettings, SingularityMap, Status, Trial, Workspace,
} from '../generated/lizard';
export type {
  Legs as Kind, Lengths as TriedLengths, ModelEntry as ServoModel, Movement as Displacement, PlateEntry as Plate, Spot as Point,
} from '../generated/lizard';

export type Gait = Description['gaits'][number];
export type Length = Description['lengths'][number];
export type End = DrawnGait['end'];
/** A value of an edited gait for which a refusal can offer a valid one. */
export type Alternative = RefusedTrial['alternatives'][number]['what'];
/** The predictions of a robot's gaits, in the robot's order; null for a gait that could not be predicted. */
export type Predictions = (GaitPrediction | null)[];

/** A robot.toml with the floor and the servo model, which is given by its name in the description. */
export interface OnFloor {
  toml: string;
  floor: Floor;
  servos: string;
}

/** Initializes the WebAssembly module and creates an instance that has no robot yet. */
export function load(module: WebAssembly.Module): Robot {
  initSync({ module });
  return new Robot();
}

export function isRefused(answer: object): answer is Refused {
  return 'refused' in answer;
}

/** True if a leg can lag behind its servo. */
export const canLag = ({ kind, play }: Floor) => kind !== 'rigid' || play > 0;
