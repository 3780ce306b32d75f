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
const QUIET = 400;
/** Step of the lengths that are tried, mm. */
const STEP = 0.5;

/** Lengths by their keys, mm. */
type Lengths = Map<string, number>;

/** Work that ends with the next change: proofs in workers. */
interface Work {
  isOver: boolean;
  stop: () => void;
}

/** A length whose printable values are wanted, within a range. */
interface Wish {
  keys: string[];
  range: [number, number];
  show: (found: [number, number] | null, message: string) => void;
}

export class FitView {
  private readonly message = element('fit-said');
  private readonly use = element<HTMLButtonElement>('fit-use');
  private readonly where = element<HTMLButtonElement>('fit-where');
  /** The last lengths whose parts fit, of robots from the same file. */
  private fitting: Lengths = new Map();
  private wish: Wish | null = null;
  private timer = 0;
  private work: Work = { isOver: true, stop: () => {} };

  constructor(
    private readonly session: () => Session,
    private readonly parts: PartsView,
  ) {
    this.where.addEventListener('click', () => this.parts.set3d(true));
  }

  /** Takes the lengths of the session's robot. */
  showRobot(lengths: Length[]): void {
    const wanted: Lengths = new Map(lengths.map(({ key, value }) => [key, value]));
    this.wish = null;
    this.begin();
    this.parts.showRobot();
    const { file, toml, original } = this.session();
    // Not checked: a robot chosen from the list (whose file name is empty while it loads), an unchanged robot, and
    // changes made outside the room Build.
    if (file === '' || toml === original || document.body.dataset.at !== 'room-build') this.fitting = wanted;
    const changed = [...wanted].filter(([key, value]) => this.fitting.get(key) !== value);
    if (changed.length > 0) this.schedule((work) => this.check(wanted, new Map(changed), work));
  }

  /** Takes the robot.toml of lengths that are being dragged; null if the lengths are refused. */
  follow(toml: string | null): void {
    this.begin();
    if (toml === null) return;
    this.schedule(async (work) => {
      this.parts.show3d(toml);
      await this.prove(toml, work);
    });
  }

  /**
   * Searches for the least and the greatest value of the lengths `keys` with which the parts fit, once the robot is
   * known to fit.
   */
  findRange(keys: string[], range: [number, number], show: Wish['show']): void {
    this.wish = { keys, range, show };
    if (this.isFitting) {
      this.begin();
      this.schedule((work) => this.search(work));
    }
  }

  private get isFitting(): boolean {
    return this.session().description.lengths.every(({ key, value }) => this.fitting.get(key) === value);
  }

  /** Cancels the scheduled or running work, and clears the message. */
  private begin(): void {
    clearTimeout(this.timer);
    this.work.isOver = true;
    this.work.stop();
    this.say('', null);
  }

  private schedule(act: (work: Work) => Promise<void>): void {
    const work: Work = { isOver: false, stop: () => {} };
    this.work = work;
    const run = () => act(work).catch((error: unknown) => this.say(`The parts could not be checked: ${messageOf(error)}.`, null));
    this.timer = setTimeout(() => void run(), QUIET);
  }

  /** Proves that a robot's parts fit, and shows the result; returns true if they do. */
  private async prove(toml: string, work: Work): Promise<boolean> {
    this.say('Checking that the parts fit…', null);
    const result = await this.proveParts(toml, work);
    if (work.isOver) return false;
    if (result instanceof Error) this.say(refusal(result), result.meeting);
    else this.say(`The parts fit${result === null ? '' : `: no two come nearer than ${result.toFixed(2)} mm`}.`, null);
    return !(result instanceof Error);
  }

  /**
   * Returns the least distance between two parts, mm, null if it is unknown, or the error that says why they do not
   * fit.
   */
  private async proveParts(toml: string, work: Work) {
    const { fit, Unfit } = await import('../parts/workshop');
    if (work.isOver) return null;
    const { answer, stop } = fit(toml);
    work.stop = stop;
    return answer.catch((error: unknown) => {
      if (error instanceof Unfit) return error;
      throw error;
    });
  }

  private async check(wanted: Lengths, changed: Lengths, work: Work): Promise<void> {
    const { toml } = this.session();
    if (await this.prove(toml, work)) {
      this.fitting = wanted;
      return this.search(work);
    }
    if (work.isOver) return;
    const refused = this.message.textContent ?? '';
    this.message.textContent = `${refused} Looking for the nearest that can…`;
    const nearest = await this.nearest(changed, work);
    if (work.isOver) return;
    this.message.textContent = refused;
    const { lengths } = this.session().description;
    const names = lengths.filter(({ key }) => changed.has(key)).map(({ key, label }) => `${label} ${nearest.lengths.get(key)}`);
    this.use.textContent = `Use what fits: ${names.join(', ')}`;
    this.use.onclick = () => void this.session().change(nearest.text);
    this.use.hidden = false;
  }

  /** Searches for the requested range, if there is a request. */
  private async search(work: Work): Promise<void> {
    const { wish } = this;
    if (!wish) return;
    const { keys, range, show } = wish;
    show(null, 'Looking for the shortest and the longest that can be printed…');
    const found: number[] = [];
    for (const end of range) {
      const { lengths } = await this.nearest(new Map(keys.map((key) => [key, end])), work, true);
      if (work.isOver) return;
      found.push(lengths.get(keys[0] ?? '') ?? end);
    }
    const [least = 0, most = 0] = found;
    const { unit } = this.session().description.lengths.find(({ key }) => key === keys[0]) ?? { unit: '' };
    show([least, most], `Can be printed from ${least} to ${most} ${unit}.`);
  }

  /**
   * Returns the lengths nearest to the wanted ones whose parts fit: bisects between the last lengths that fit and the
   * wanted ones, to within one step. If `isOpen`, tries the wanted lengths first, since they may fit.
   */
  private async nearest(wanted: Lengths, work: Work, isOpen = false): Promise<{ lengths: Lengths; text: string }> {
    const { toml } = this.session();
    const between = (share: number): Lengths =>
      new Map([...wanted].map(([key, to]) => {
        const from = this.fitting.get(key) ?? to;
        return [key, share === 0 ? from : STEP * Math.round((from + (to - from) * share) / STEP)];
      }));
    const at = (share: number) => {
      const lengths = between(share);
      const { text, refusal } = Robot.lengths(toml, [...lengths], false);
      return { lengths, text, isRobot: refusal === null };
    };
    const fits = async ({ text, isRobot }: ReturnType<typeof at>) => isRobot && !((await this.proveParts(text, work)) instanceof Error);
    let best = at(0);
    if (isOpen) {
      const end = at(1);
      if (await fits(end)) return end;
    }
    let [low, high] = [0, 1];
    const longest = Math.max(...[...wanted].map(([key, to]) => Math.abs(to - (this.fitting.get(key) ?? to))));
    while ((high - low) * longest > STEP && !work.isOver) {
      const middle = (low + high) / 2;
      const tried = at(middle);
      if (await fits(tried)) [low, best] = [middle, tried];
      else high = middle;
    }
    return best;
  }

  private say(text: string, meeting: Meeting | null): void {
    element('fit').hidden = text === '';
    this.message.textContent = text;
    this.use.hidden = true;
    this.where.hidden = meeting === null;
    this.parts.meet(meeting);
  }
}

/** Returns the message that names the two parts that come too close, or else what cannot be made. */
function refusal({ message, meeting }: { message: string; meeting: Meeting | null }): string {
  if (!meeting) return `These lengths cannot be printed: ${message.replace(/\.$/, '')}.`;
  const { first, second, mm } = meeting;
  const near = mm < 0 ? `would overlap by ${(-mm).toFixed(2)} mm` : `would come as near as ${mm.toFixed(2)} mm`;
  return `These lengths cannot be printed: ${first} and ${second} ${near}.`;
}
