// The button "Make it faster": searches for a gait that walks faster than the edited one, and offers it.
import { files } from '../files';
import { type Answer, type Best, FasterSearch } from '../gaits/faster';
import type { Bars, Trial } from '../robot';
import type { Session } from '../session';
import { element } from './canvas';
import { tableRow } from './make';
import { numberInput } from './number';
import { figures } from './trial';

/** Access to the edited gait. */
export interface Edited {
  gait(): Bars | null;
  setGait(gait: Bars): void;
  /** Lets the found gait walk beside the previous one, and writes their displacements into `output`. */
  compare(previousGait: Bars, foundGait: Bars, output: HTMLElement): Promise<void>;
}

const WORDS = { start: 'Make it faster', stop: 'Stop the search', take: 'Use this gait', back: 'Back to the previous gait' };
/** The rows of the comparison. */
const ROWS = { speed: 'speed', way: 'distance per cycle', turn: 'turn per cycle', least: 'least margin', fastest: 'fastest servo', cycle: 'cycle' } as const;

export class FasterView {
  private readonly start = element<HTMLButtonElement>('faster-start');
  private readonly takeIt = element<HTMLButtonElement>('faster-take');
  private readonly bar = element<HTMLProgressElement>('faster-progress');
  private readonly message = element('faster-said');
  private readonly result = element('faster-result');
  private readonly numbers = { rate: null as number | null, rounds: 5, seed: 1 };
  private search: FasterSearch | null = null;
  /** The gait that the search has to beat, and its trial. */
  private reference: Bars | null = null;
  private before: Trial | null = null;
  private best: Best | null = null;
  /** The gait that the found one replaced. */
  private replaced: Bars | null = null;
  private toml = '';
  private total = 0;
  /** The WebAssembly module with the search, loaded on demand. */
  private module: Promise<WebAssembly.Module> | null = null;

  constructor(
    private readonly session: () => Session,
    private readonly edited: Edited,
  ) {
    const { numbers } = this;
    numberInput(element('faster-rate'), { min: 10, max: 1000, step: 1 }, (value) => (numbers.rate = value));
    numberInput(element('faster-rounds'), { min: 1, max: 200, step: 1 }, (value) => (numbers.rounds = Math.round(value ?? 5)));
    numberInput(element('faster-seed'), { min: 0, max: 1e9, step: 1 }, (value) => (numbers.seed = Math.round(value ?? 1)));
    this.start.addEventListener('click', () => (this.search ? this.search.stop() : this.begin()));
    this.takeIt.addEventListener('click', () => this.takeOver());
    element('faster-both').addEventListener('click', () => void this.compare());
  }

  /** Ends the search if the robot has changed, since its result would not fit. */
  follow(): void {
    if (this.toml === '' || this.session().toml === this.toml) return;
    this.toml = '';
    this.result.hidden = true;
    if (!this.search) return this.say('');
    this.search.drop();
    this.reset();
    this.say('The robot has changed, so the search for the previous one has ended.');
  }

  private begin(): void {
    const bars = this.edited.gait();
    if (!bars) return this.say('There is no gait to start from.');
    const { toml, floor, servos } = this.session();
    this.toml = toml;
    this.reference = bars;
    this.before = this.best = null;
    this.result.hidden = true;
    this.start.textContent = WORDS.stop;
    this.bar.removeAttribute('value');
    this.bar.hidden = false;
    this.say('Looking for the widest stride that the limits allow…');
    this.module ??= files.tune();
    // A failed download is tried again next time.
    this.module.catch(() => (this.module = null));
    this.search = new FasterSearch(this.module, { toml, floor, servos, task: { bars, ...this.numbers } }, (answer) => this.handle(answer));
  }

  private handle(answer: Answer): void {
    switch (answer.of) {
      case 'start':
        this.before = answer.before;
        this.total = this.bar.max = answer.all;
        this.bar.value = 0;
        return this.say(`Trying ${answer.all} gaits whose servos turn at most ${answer.rate.toFixed(0)} °/s…`);
      case 'progress':
        this.bar.value = answer.done;
        return;
      case 'best':
        if (answer.best.better) this.show(answer.best);
        return this.say(answer.best.better ? `So far ${percent(answer.best)} faster.` : 'None of the gaits so far is faster.');
      case 'end':
        this.showEnd(answer);
    }
  }

  private showEnd(answer: Answer & { of: 'end' }): void {
    this.reset();
    if ('refused' in answer) return this.say(`This gait cannot be made faster: ${answer.refused}.`);
    const { best, done } = answer;
    const stopText = done < this.total ? `Stopped after ${done} of ${this.total} gaits. ` : '';
    if (best?.better) {
      this.show(best);
      const { comparison } = best;
      return this.say(`${stopText}Faster on ${comparison.faster} of ${comparison.robots} random robots and floors, and ${percent(best)} faster where only 5 % are slower. No servo turns faster than ${comparison.rate.toFixed(0)} °/s.`);
    }
    this.result.hidden = true;
    if (done === 0) return this.say(`${stopText}Nothing was tried yet.`);
    this.say(`${stopText}No gait was found that is faster than this one on the slow ones of the random robots and floors. More rounds or another seed may find one.`);
  }

  /** Ends the search; the button starts a new one. */
  private reset(): void {
    this.search = null;
    this.bar.hidden = true;
    this.start.textContent = WORDS.start;
  }

  private show(best: Best): void {
    const { before: previousTrial } = this;
    if (!previousTrial) return;
    this.best = best;
    const columns = [previousTrial, best.trial].map((trial) => figures(trial, best.comparison.unit));
    element('faster-rows').replaceChildren(
      ...Object.entries(ROWS).map(([row, label]) => tableRow([label, ...columns.map((column) => column[row as keyof typeof ROWS])])),
    );
    this.replaced = null;
    this.takeIt.textContent = WORDS.take;
    element('faster-ways').textContent = '';
    this.result.hidden = false;
  }

  /** Puts the found gait into the editor, or restores the gait that it replaced. */
  private takeOver(): void {
    const currentGait = this.edited.gait();
    if (!currentGait || !this.best) return;
    const nextGait = this.replaced ?? this.best.bars;
    this.replaced = this.replaced ? null : currentGait;
    this.takeIt.textContent = this.replaced ? WORDS.back : WORDS.take;
    this.edited.setGait({ ...nextGait, name: currentGait.name });
  }

  private async compare(): Promise<void> {
    const { reference, best } = this;
    if (!reference || !best) return;
    const { robot, toml, isReal } = this.session();
    // This change only put the found gait into the robot, so the result stays.
    if (!isReal) this.toml = robot.putGait(toml, best.bars);
    await this.edited.compare(reference, best.bars, element('faster-ways'));
  }

  private say(text: string): void {
    if (this.message.textContent !== text) this.message.textContent = text;
  }
}

const percent = ({ gain }: Best) => `${(100 * gain).toFixed(0)} %`;
