// The parts after a change of lengths: a worker proves that they fit, and where they do not, looks for the nearest lengths that do.
import { isRefused, type Length } from '../robot';
import type { Session } from '../session';
import { messageOf } from '../trouble';
import { element } from './canvas';

/** Time after a change until its parts are made, ms: a joint that is dragged makes many. */
const QUIET = 400;
/** Step of the lengths that are tried, mm. */
const STEP = 0.5;

/** Lengths by their keys, mm. */
type Lengths = Map<string, number>;

export class FitView {
  private readonly said = element('fit-said');
  private readonly use = element<HTMLButtonElement>('fit-use');
  /** The last lengths that fit, of robots from the same file. */
  private fitting: Lengths = new Map();
  private timer = 0;
  private stop: () => void = () => {};

  constructor(private readonly session: () => Session) {}

  /** Takes the lengths of the session's robot. */
  showRobot(lengths: Length[]): void {
    const wanted: Lengths = new Map(lengths.map(({ key, value }) => [key, value]));
    clearTimeout(this.timer);
    this.stop();
    this.say('');
    const { file, toml, original } = this.session();
    // A file of the list, which has no name while it is read, and what was changed elsewhere are not checked.
    if (file === '' || toml === original || document.body.dataset.at !== 'room-build') this.fitting = wanted;
    const changed = [...wanted].filter(([key, value]) => this.fitting.get(key) !== value);
    if (changed.length === 0) return;
    const check = () => this.check(wanted, new Map(changed)).catch((error: unknown) => this.say(`The parts could not be checked: ${messageOf(error)}.`));
    this.timer = setTimeout(() => void check(), QUIET);
  }

  private async check(wanted: Lengths, changed: Lengths): Promise<void> {
    const { toml } = this.session();
    let isOver = false;
    this.stop = () => (isOver = true);
    this.say('Checking that the parts fit…');
    const { fit, NoParts } = await import('../parts/workshop');
    /** Returns the least distance of two parts, mm, or why they do not fit. */
    const proved = async (text: string): Promise<number | null | string> => {
      if (isOver) return null;
      const { fits, stop } = fit(text);
      this.stop = () => {
        isOver = true;
        stop();
      };
      return fits.catch((error: unknown) => {
        if (error instanceof NoParts) return error.message;
        throw error;
      });
    };
    const result = await proved(toml);
    if (isOver) return;
    if (typeof result !== 'string') {
      this.fitting = wanted;
      return this.say(`The parts fit${result === null ? '' : `: no two come nearer than ${result.toFixed(2)} mm`}.`);
    }
    const refused = `These lengths cannot be printed: ${result.replace(/\.$/, '')}.`;
    this.say(`${refused} Looking for the nearest that can…`);
    const nearest = await this.nearest(toml, changed, async (text) => typeof (await proved(text)) !== 'string');
    if (isOver) return;
    this.say(refused);
    const { lengths } = this.session().description;
    const names = lengths.filter(({ key }) => changed.has(key)).map(({ key, label }) => `${label} ${nearest.lengths.get(key)}`);
    this.use.textContent = `Use what fits: ${names.join(', ')}`;
    this.use.onclick = () => void this.session().change(nearest.text);
    this.use.hidden = false;
  }

  /** Halves the way from the last lengths that fit to those wanted, until it is as fine as a step. */
  private async nearest(toml: string, changed: Lengths, fits: (text: string) => Promise<boolean>): Promise<{ lengths: Lengths; text: string }> {
    const { robot } = this.session();
    const between = (share: number): Lengths =>
      new Map([...changed].map(([key, to]) => {
        const from = this.fitting.get(key) ?? to;
        return [key, share === 0 ? from : STEP * Math.round((from + (to - from) * share) / STEP)];
      }));
    const textOf = (lengths: Lengths): string | null => {
      let text = toml;
      for (const [key, value] of lengths) {
        const edited = robot.edit(text, key, value);
        if (isRefused(edited)) return null;
        text = edited.text;
      }
      return text;
    };
    let [low, high] = [0, 1];
    let best = between(0);
    const longest = Math.max(...[...changed].map(([key, to]) => Math.abs(to - (this.fitting.get(key) ?? to))));
    while ((high - low) * longest > STEP) {
      const middle = (low + high) / 2;
      const lengths = between(middle);
      const text = textOf(lengths);
      if (text !== null && (await fits(text))) [low, best] = [middle, lengths];
      else high = middle;
    }
    return { lengths: best, text: textOf(best) ?? toml };
  }

  private say(text: string): void {
    element('fit').hidden = text === '';
    this.said.textContent = text;
    this.use.hidden = true;
  }
}
