// Checks that the robot's parts fit after a change of lengths, also during a drag. The proof runs in a web worker. The
// 3D view shows in red two parts that come too close, and the page searches for the nearest lengths whose parts fit.
import type { CollidingPair } from '../parts/make-parts';
import { type Length, Robot } from '../robot';
import type { Session } from '../session';
import { getMessage } from '../problem';
import { element } from './elements';
import type { PartsView } from './parts';

/** Delay between the last change and the check, ms, because dragging a joint makes many changes. */
const CHECK_DELAY_MS = 400;
/** Resolution of the tried lengths, mm. */
const STEP_MM = 0.5;

/** Lengths by their keys, mm. */
type Lengths = Map<string, number>;

/** A request for the printable range of lengths that change together. */
interface RangeRequest {
  keys: string[];
  range: [number, number];
  show: (printable: [number, number] | null, message: string) => void;
}

export class FitView {
  private readonly message = element('fit-message');
  private readonly useButton = element<HTMLButtonElement>('fit-use');
  private readonly showPairButton = element<HTMLButtonElement>('fit-where');
  /** The last lengths whose parts fit, or are taken to fit because they were not checked, of a robot from the same file. */
  private fittingLengths: Lengths = new Map();
  private rangeRequest: RangeRequest | null = null;
  private timer = 0;
  /** Cancels the scheduled or running check when the robot changes again. */
  private checkController = new AbortController();

  constructor(
    private readonly session: Session,
    private readonly parts: PartsView,
  ) {
    this.showPairButton.addEventListener('click', () => this.parts.set3d(true));
    session.robot.follow(({ lengths }) => this.showRobot(lengths));
  }

  /** Shows the session's robot with these lengths, and checks its parts if the lengths have changed. */
  showRobot(lengths: Length[]): void {
    const robotLengths: Lengths = new Map(lengths.map(({ key, value }) => [key, value]));
    this.rangeRequest = null;
    this.cancelCheck();
    this.parts.showRobot();
    const { file, toml, original } = this.session.robot;
    // No check for a robot chosen from the list (its file name is empty while it loads), for an unchanged robot, and
    // for changes outside the room Build.
    if (file === '' || toml === original || document.body.dataset.at !== 'room-build') this.fittingLengths = robotLengths;
    const changedLengths = [...robotLengths].filter(([key, value]) => this.fittingLengths.get(key) !== value);
    if (changedLengths.length > 0) this.schedule((signal) => this.checkRobot(robotLengths, new Map(changedLengths), signal));
  }

  /** Checks the parts during a drag. `toml` is the robot.toml with the dragged lengths; null if they are refused. */
  checkDragged(toml: string | null): void {
    this.cancelCheck();
    if (toml === null) return;
    this.schedule(async (signal) => {
      this.parts.show3d(toml);
      await this.proveAndReport(toml, signal);
    });
  }

  /**
   * Searches `range` for the smallest and the largest value of the lengths `keys` with which the parts fit. The search
   * starts once the robot's current lengths are among those that fit.
   */
  findRange(keys: string[], range: [number, number], show: RangeRequest['show']): void {
    this.rangeRequest = { keys, range, show };
    if (!this.hasFittingLengths) return;
    this.cancelCheck();
    this.schedule((signal) => this.searchRange(signal));
  }

  /** True if the session's robot has the lengths of `fittingLengths`. */
  private get hasFittingLengths(): boolean {
    return this.session.robot.description.lengths.every(({ key, value }) => this.fittingLengths.get(key) === value);
  }

  /** Cancels the scheduled or running check, and clears the message. */
  private cancelCheck(): void {
    clearTimeout(this.timer);
    this.checkController.abort();
    this.setMessage('', null);
  }

  private schedule(run: (signal: AbortSignal) => Promise<void>): void {
    this.checkController = new AbortController();
    const { signal } = this.checkController;
    const runAndReport = () => run(signal).catch((error: unknown) => this.setMessage(`Cannot check the parts: ${getMessage(error)}.`, null));
    this.timer = setTimeout(() => void runAndReport(), CHECK_DELAY_MS);
  }

  /** Proves that a robot's parts fit, and shows the result; returns true if they fit. */
  private async proveAndReport(toml: string, signal: AbortSignal): Promise<boolean> {
    this.setMessage('Checking that the parts fit…', null);
    const result = await proveParts(toml, signal);
    if (signal.aborted) return false;
    if (result instanceof Error) this.setMessage(describeUnfit(result), result.collidingPair);
    else this.setMessage(`The parts fit${result === null ? '' : `: no two come closer to each other than ${result.toFixed(2)} mm`}.`, null);
    return !(result instanceof Error);
  }

  private async checkRobot(robotLengths: Lengths, changedLengths: Lengths, signal: AbortSignal): Promise<void> {
    if (await this.proveAndReport(this.session.robot.toml, signal)) {
      this.fittingLengths = robotLengths;
      return this.searchRange(signal);
    }
    if (signal.aborted) return;
    const unfitMessage = this.message.textContent ?? '';
    this.message.textContent = `${unfitMessage} Searching for the nearest printable lengths…`;
    const nearest = await this.findNearest(changedLengths, signal);
    if (signal.aborted) return;
    this.message.textContent = unfitMessage;
    const { lengths } = this.session.robot.description;
    const names = lengths.filter(({ key }) => changedLengths.has(key)).map(({ key, label }) => `${label} ${nearest.lengths.get(key)}`);
    this.useButton.textContent = `Use the nearest lengths that fit: ${names.join(', ')}`;
    this.useButton.onclick = () => void this.session.robot.change(nearest.toml);
    this.useButton.hidden = false;
  }

  /** Searches for the requested range of printable values, if there is a request. */
  private async searchRange(signal: AbortSignal): Promise<void> {
    const { rangeRequest } = this;
    if (!rangeRequest) return;
    const { keys, range, show } = rangeRequest;
    show(null, 'Searching for the printable range…');
    const findLimit = async (target: number) => {
      const { lengths } = await this.findNearest(new Map(keys.map((key) => [key, target])), signal, true);
      return lengths.get(keys[0] ?? '') ?? target;
    };
    const [shortest, longest] = await Promise.all([findLimit(range[0]), findLimit(range[1])]);
    if (signal.aborted) return;
    const { unit } = this.session.robot.description.lengths.find(({ key }) => key === keys[0]) ?? { unit: '' };
    show([shortest, longest], `Printable from ${shortest} to ${longest} ${unit}.`);
  }

  /**
   * Bisects between the last lengths that fit and the target lengths, down to `STEP_MM`; returns the lengths nearest to
   * the target whose parts fit. If `triesTargetFirst`, tries the target lengths first, because they may fit.
   */
  private async findNearest(targetLengths: Lengths, signal: AbortSignal, triesTargetFirst = false): Promise<{ lengths: Lengths; toml: string }> {
    const sessionToml = this.session.robot.toml;
    const makeRobot = (fraction: number) => {
      const lengths: Lengths = new Map([...targetLengths].map(([key, to]) => {
        const from = this.fittingLengths.get(key) ?? to;
        return [key, fraction === 0 ? from : STEP_MM * Math.round((from + (to - from) * fraction) / STEP_MM)];
      }));
      const { text: toml, refusal } = Robot.tryLengths(sessionToml, [...lengths], false);
      return { lengths, toml, isAccepted: refusal === null };
    };
    const checkFit = async ({ toml, isAccepted }: ReturnType<typeof makeRobot>) => isAccepted && !((await proveParts(toml, signal)) instanceof Error);
    let best = makeRobot(0);
    if (triesTargetFirst) {
      const targetRobot = makeRobot(1);
      if (await checkFit(targetRobot)) return targetRobot;
    }
    let [low, high] = [0, 1];
    const largestChange = Math.max(...[...targetLengths].map(([key, to]) => Math.abs(to - (this.fittingLengths.get(key) ?? to))));
    while ((high - low) * largestChange > STEP_MM && !signal.aborted) {
      const middle = (low + high) / 2;
      const candidate = makeRobot(middle);
      if (await checkFit(candidate)) [low, best] = [middle, candidate];
      else high = middle;
    }
    return best;
  }

  private setMessage(text: string, collidingPair: CollidingPair | null): void {
    element('fit').hidden = text === '';
    this.message.textContent = text;
    this.useButton.hidden = true;
    this.showPairButton.hidden = collidingPair === null;
    this.parts.showCollidingPair(collidingPair);
  }
}

/**
 * Returns the smallest distance between two parts, mm; null if the distance is unknown or `signal` was aborted; or an
 * error if the parts do not fit.
 */
async function proveParts(toml: string, signal: AbortSignal) {
  const { proveFit, UnfitError } = await import('../parts/make-parts');
  if (signal.aborted) return null;
  return proveFit(toml, signal).catch((error: unknown) => {
    if (error instanceof UnfitError) return error;
    throw error;
  });
}

/** Returns a message with the two parts that come too close, or else the reason why the parts cannot be made. */
function describeUnfit({ message, collidingPair }: { message: string; collidingPair: CollidingPair | null }): string {
  if (!collidingPair) return `These lengths cannot be printed: ${message.replace(/\.$/, '')}.`;
  const { first, second, mm } = collidingPair;
  const distanceText = mm < 0 ? `would overlap by ${(-mm).toFixed(2)} mm` : `would be only ${mm.toFixed(2)} mm apart`;
  return `These lengths cannot be printed: ${first} and ${second} ${distanceText}.`;
}
