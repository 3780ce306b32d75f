// The robot in WebAssembly, which computes everything; TypeScript repeats no formula. The types come from wasm/src.
import { type Description, type DrawnGait, type Floor, type GaitPrediction, initSync, type Refusal, type RefusedTrial, Robot } from '../generated/lizard';

export { formatCalibration, parseBanner, parseCalibration, parsePoseReport, parseStatus, Robot } from '../generated/lizard';
export type {
  Banner, Bars, Calibration, Description, Displacement, DrawnGait, Edits, EditedGait, Floor, Four, Frame, GaitPrediction, LegDrive, Place, Point, Refusal, RefusedTrial, RoundPath, Routine, Scene, ServoSettings, SingularityMap, Status, Trial, TriedLengths, Workspace,
  PlateEntry as Plate, ServoModelEntry as ServoModel,
} from '../generated/lizard';

export type Gait = Description['gaits'][number];
export type Length = Description['lengths'][number];
export type End = DrawnGait['end'];
/** A parameter of an edited gait for which a refusal can offer a valid value. */
export type GaitParameter = RefusedTrial['alternatives'][number]['parameter'];
/** The predictions of a robot's gaits, in the robot's order; null for a gait that could not be predicted. */
export type Predictions = (GaitPrediction | null)[];

/** A robot.toml with the floor and the servo model, by the model's name in the description. */
export interface OnFloor {
  toml: string;
  floor: Floor;
  servos: string;
}

/** Initialises the WebAssembly module and creates an instance without a robot. */
export function load(module: WebAssembly.Module): Robot {
  initSync({ module });
  return new Robot();
}

export const isRefused = (result: object): result is Refusal => 'reason' in result;

/** Makes a refusal by the page itself. */
export const refuse = (reason: string): Refusal => ({ reason, consequence: null, line: null, key: '' });

/** Returns true if a leg can lag behind its servo. */
export const canLag = ({ kind, play }: Floor) => kind !== 'rigid' || play > 0;
