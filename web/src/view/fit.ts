// Checks that the robot's parts fit after a change of lengths, also while a length is dragged. The proof runs in a
// web worker. If two parts come too close, they are shown in red in 3D, and the page searches for the nearest lengths
// whose parts fit.
import type { Meeting } from '../parts/workshop';
import { type Length, Robot } from '../robot';
import type { Session } from '../session';
import { messageOf } from '../trouble';
import { element } from './canvas';
import type { PartsView } from './parts';

/** Time without a further change until the parts are made, ms: dragging a joint makes many changes. */
const CHECK_DELAY_MS = 400;
/** Step of the lengths that are tried, mm. */
const STEP_MM = 0.5;

/** Lengths by their keys, mm. */
type Lengths = Map<string, number>;

/** Checks in workers, which end with the next change. */
interface Work {
  isOver: boolean;
  /** The functions that end its workers. */
  stops: Set<() => void>;
}

/** A request for the printable values of lengths that change together, within a range. */
interface RangeRequest {
  keys: string[];
  range: [number, number];
  show: (printable: [number, number] | null, message: string) => void;
}

export class FitView {
  private readonly message = element('fit-said');
  private readonly useButton = element<HTMLButtonElement>('fit-use');
  private readonly whereButton = element<HTMLButtonElement>('fit-where');
  /** The last lengths whose parts fit, of robots from the same file. */
  private fittingLengths: Lengths = new Map();
  private rangeRequest: RangeRequest | null = null;
  private timer = 0;
  private work: Work = { isOver: true, stops: new Set() };

  constructor(
    private readonly session: Session,
    private readonly parts: PartsView,
  ) {
    this.whereButton.addEventListener('click', () => this.parts.set3d(true));
    session.followRobot(({ lengths }) => this.showRobot(lengths));
  }

  /** Takes the lengths of the session's robot. */
  showRobot(lengths: Length[]): void {
    const robotLengths: Lengths = new Map(lengths.map(({ key, value }) => [key, value]));
    this.rangeRequest = null;
    this.cancelWork();
    this.parts.showRobot();
    const { file, toml, original } = this.session;
    // Not checked: a robot chosen from the list (whose file name is empty while it loads), an unchanged robot, and
    // changes made outside the room Build.
    if (file === '' || toml === original || document.body.dataset.at !== 'room-build') this.fittingLengths = robotLengths;
    const changedLengths = [...robotLengths].filter(([key, value]) => this.fittingLengths.get(key) !== value);
    if (changedLengths.length > 0) this.schedule((work) => this.checkRobot(robotLengths, new Map(changedLengths), work));
  }

  /** Takes the robot.toml of lengths that are being dragged; null if the lengths are refused. */
  checkDragged(toml: string | null): void {
    this.cancelWork();
    if (toml === null) return;
    this.schedule(async (work) => {
      this.parts.show3d(toml);
      await this.proveAndReport(toml, work);
    });
  }

  /**
   * Searches for the least and the greatest value of the lengths `keys` with which the parts fit, once the robot is
   * known to fit.
   */
  findRange(keys: string[], range: [number, number], show: RangeRequest['show']): void {
    this.rangeRequest = { keys, range, show };
    if (this.isKnownToFit) {
      this.cancelWork();
      this.schedule((work) => this.searchRange(work));
    }
  }

  private get isKnownToFit(): boolean {
    return this.session.description.lengths.every(({ key, value }) => this.fittingLengths.get(key) === value);
  }

  /** Cancels the scheduled or running work, and clears the message. */
  private cancelWork(): void {
    clearTimeout(this.timer);
    this.work.isOver = true;
    for (const stop of this.work.stops) stop();
    this.say('', null);
  }

  private schedule(act: (work: Work) => Promise<void>): void {
    const work: Work = { isOver: false, stops: new Set() };
    this.work = work;
    const run = () => act(work).catch((error: unknown) => this.say(`The parts could not be checked: ${messageOf(error)}.`, null));
    this.timer = setTimeout(() => void run(), CHECK_DELAY_MS);
  }

  /** Proves that a robot's parts fit, and shows the result; returns true if they do. */
  private async proveAndReport(toml: string, work: Work): Promise<boolean> {
    this.say('Checking that the parts fit…', null);
    const result = await this.proveParts(toml, work);
    if (work.isOver) return false;
    if (result instanceof Error) this.say(refusalOf(result), result.meeting);
    else this.say(`The parts fit${result === null ? '' : `: no two come nearer than ${result.toFixed(2)} mm`}.`, null);
    return !(result instanceof Error);
  }

  /**
   * Returns the least distance between two parts, mm, null if it is unknown, or the error that says why they do not
   * fit.
   */
  private async proveParts(toml: string, work: Work) {
    const { proveFit, UnfitError } = await import('../parts/workshop');
    if (work.isOver) return null;
    const { answer, stop } = proveFit(toml);
    work.stops.add(stop);
    return answer
      .catch((error: unknown) => {
        if (error instanceof UnfitError) return error;
        throw error;
      })
      .finally(() => work.stops.delete(stop));
  }

  private async checkRobot(robotLengths: Lengths, changedLengths: Lengths, work: Work): Promise<void> {
    const { toml } = this.session;
    if (await this.proveAndReport(toml, work)) {
      this.fittingLengths = robotLengths;
      return this.searchRange(work);
    }
    if (work.isOver) return;
    const refusalText = this.message.textContent ?? '';
    this.message.textContent = `${refusalText} Looking for the nearest that can…`;
    const nearest = await this.findNearest(changedLengths, work);
    if (work.isOver) return;
    this.message.textContent = refusalText;
    const { lengths } = this.session.description;
    const names = lengths.filter(({ key }) => changedLengths.has(key)).map(({ key, label }) => `${label} ${nearest.lengths.get(key)}`);
    this.useButton.textContent = `Use what fits: ${names.join(', ')}`;
    this.useButton.onclick = () => void this.session.change(nearest.text);
    this.useButton.hidden = false;
  }

  /** Searches for the requested range, if there is a request. */
  private async searchRange(work: Work): Promise<void> {
    const { rangeRequest } = this;
    if (!rangeRequest) return;
    const { keys, range, show } = rangeRequest;
    show(null, 'Looking for the shortest and the longest that can be printed…');
    const findLimit = async (wantedValue: number) => {
      const { lengths } = await this.findNearest(new Map(keys.map((key) => [key, wantedValue])), work, true);
      return lengths.get(keys[0] ?? '') ?? wantedValue;
    };
    const [shortest, longest] = await Promise.all([findLimit(range[0]), findLimit(range[1])]);
    if (work.isOver) return;
    const { unit } = this.session.description.lengths.find(({ key }) => key === keys[0]) ?? { unit: '' };
    show([shortest, longest], `Can be printed from ${shortest} to ${longest} ${unit}.`);
  }

  /**
   * Returns the lengths nearest to the wanted ones whose parts fit: bisects between the last lengths that fit and the
   * wanted ones, to within one step. If `triesWantedFirst`, tries the wanted lengths first, since they may fit.
   */
  private async findNearest(wantedLengths: Lengths, work: Work, triesWantedFirst = false): Promise<{ lengths: Lengths; text: string }> {
    const { toml } = this.session;
    const lengthsAt = (share: number): Lengths =>
      new Map([...wantedLengths].map(([key, to]) => {
        const from = this.fittingLengths.get(key) ?? to;
        return [key, share === 0 ? from : STEP_MM * Math.round((from + (to - from) * share) / STEP_MM)];
      }));
    const robotAt = (share: number) => {
      const lengths = lengthsAt(share);
      const { text, refusal } = Robot.lengths(toml, [...lengths], false);
      return { lengths, text, isAccepted: refusal === null };
    };
    const partsFit = async ({ text, isAccepted }: ReturnType<typeof robotAt>) => isAccepted && !((await this.proveParts(text, work)) instanceof Error);
    let best = robotAt(0);
    if (triesWantedFirst) {
      const wantedRobot = robotAt(1);
      if (await partsFit(wantedRobot)) return wantedRobot;
    }
    let [low, high] = [0, 1];
    const longestChange = Math.max(...[...wantedLengths].map(([key, to]) => Math.abs(to - (this.fittingLengths.get(key) ?? to))));
    while ((high - low) * longestChange > STEP_MM && !work.isOver) {
      const middleShare = (low + high) / 2;
      const candidate = robotAt(middleShare);
      if (await partsFit(candidate)) [low, best] = [middleShare, candidate];
      else high = middleShare;
    }
    return best;
  }

  private say(text: string, meeting: Meeting | null): void {
    element('fit').hidden = text === '';
    this.message.textContent = text;
    this.useButton.hidden = true;
    this.whereButton.hidden = meeting === null;
    this.parts.showMeeting(meeting);
  }
}

/** Returns the message that names the two parts that come too close, or else what cannot be made. */
function refusalOf({ message, meeting }: { message: string; meeting: Meeting | null }): string {
  if (!meeting) return `These lengths cannot be printed: ${message.replace(/\.$/, '')}.`;
  const { first, second, mm } = meeting;
  const distanceText = mm < 0 ? `would overlap by ${(-mm).toFixed(2)} mm` : `would come as near as ${mm.toFixed(2)} mm`;
  return `These lengths cannot be printed: ${first} and ${second} ${distanceText}.`;
}
