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

/** A robot.toml on a floor, with a servo model. */
export interface RobotOnFloor {
  toml: string;
  floor: Floor;
  /** The servo model: a name from the description, or such a name with a supply in V, as in `own at 4.2`. */
  servos: string;
}

/** Initialises the WebAssembly module, and creates a `Robot` that has no robot.toml yet. */
export function loadModule(module: WebAssembly.Module): Robot {
  initSync({ module });
  return new Robot();
}

export const isRefused = (result: object): result is Refusal => 'reason' in result;

/** Makes a refusal that comes from the page, not from the WebAssembly module. */
export const refuse = (reason: string): Refusal => ({ reason, consequence: null, line: null, key: '' });

/** Returns true if a leg can lag behind its servo. */
export const canLag = ({ kind, play }: Floor) => kind !== 'rigid' || play > 0;
