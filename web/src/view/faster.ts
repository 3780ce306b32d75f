// The button "Make it faster", which searches for a gait that is faster than the edited one, and offers it.
import { files } from '../files';
import { type SearchReport, type BestGait, FasterSearch } from '../gaits/faster';
import type { Bars, Trial } from '../robot';
import type { Session } from '../session';
import { element, setText } from './canvas';
import { tableRow } from './make';
import { setUpNumberInput } from './number';
import { formatFigures } from './trial';

/** Access to the edited gait. */
export interface GaitEditor {
  gait(): Bars | null;
  setGait(gait: Bars): void;
  /** Lets two robots walk the found gait and the previous one, and shows their displacements in `output`. */
  compare(previousGait: Bars, foundGait: Bars, output: HTMLElement): Promise<void>;
}

const BUTTON_LABELS = { start: 'Make it faster', stop: 'Stop the search', take: 'Use this gait', back: 'Back to the previous gait' };
/** The labels of the rows of the comparison. */
const ROW_LABELS = { speed: 'speed', way: 'distance per cycle', turn: 'turn per cycle', least: 'least margin', fastest: 'fastest servo', cycle: 'cycle' } as const;

export class FasterView {
  private readonly startButton = element<HTMLButtonElement>('faster-start');
  private readonly takeButton = element<HTMLButtonElement>('faster-take');
  private readonly progressBar = element<HTMLProgressElement>('faster-progress');
  private readonly message = element('faster-said');
  private readonly resultBox = element('faster-result');
  private readonly settings = { rate: null as number | null, rounds: 5, seed: 1 };
  private search: FasterSearch | null = null;
  /** The gait to beat, and its trial. */
  private reference: Bars | null = null;
  private referenceTrial: Trial | null = null;
  private best: BestGait | null = null;
  /** The gait that the found one has replaced in the editor; null while it has replaced none. */
  private replacedGait: Bars | null = null;
  /** The robot.toml for which the search runs or its result is shown; empty for none. */
  private toml = '';
  /** Number of gaits that the search tries. */
  private gaitCount = 0;
  /** The WebAssembly module with the search, loaded on demand. */
  private module: Promise<WebAssembly.Module> | null = null;

  constructor(
    private readonly session: Session,
    private readonly editor: GaitEditor,
  ) {
    const { settings } = this;
    setUpNumberInput(element('faster-rate'), { min: 10, max: 1000, step: 1 }, (value) => (settings.rate = value));
    setUpNumberInput(element('faster-rounds'), { min: 1, max: 200, step: 1 }, (value) => (settings.rounds = Math.round(value ?? 5)));
    setUpNumberInput(element('faster-seed'), { min: 0, max: 1e9, step: 1 }, (value) => (settings.seed = Math.round(value ?? 1)));
    this.startButton.addEventListener('click', () => (this.search ? this.search.stop() : this.startSearch()));
    this.takeButton.addEventListener('click', () => this.useFoundGait());
    element('faster-both').addEventListener('click', () => void this.compare());
  }

  /** Ends the search if the robot has changed, since the result would not fit the new robot. */
  endIfRobotChanged(): void {
    if (this.toml === '' || this.session.toml === this.toml) return;
    this.toml = '';
    this.resultBox.hidden = true;
    if (!this.search) return this.setMessage('');
    this.search.cancel();
    this.endSearch();
    this.setMessage('The robot has changed, so the search for the previous one has ended.');
  }

  private startSearch(): void {
    const bars = this.editor.gait();
    if (!bars) return this.setMessage('There is no gait to start from.');
    const { toml, floor, servos } = this.session;
    this.toml = toml;
    this.reference = bars;
    this.referenceTrial = this.best = null;
    this.resultBox.hidden = true;
    this.startButton.textContent = BUTTON_LABELS.stop;
    this.progressBar.removeAttribute('value');
    this.progressBar.hidden = false;
    this.setMessage('Looking for the widest stride that the limits allow…');
    this.module ??= files.tune();
    // A failed download is repeated next time.
    this.module.catch(() => (this.module = null));
    this.search = new FasterSearch(this.module, { toml, floor, servos, task: { bars, ...this.settings } }, (report) => this.handleReport(report));
  }

  private handleReport(report: SearchReport): void {
    switch (report.kind) {
      case 'start':
        this.referenceTrial = report.referenceTrial;
        this.gaitCount = this.progressBar.max = report.all;
        this.progressBar.value = 0;
        return this.setMessage(`Trying ${report.all} gaits whose servos turn at most ${report.rate.toFixed(0)} °/s…`);
      case 'progress':
        this.progressBar.value = report.done;
        return;
      case 'best':
        if (report.best.better) this.show(report.best);
        return this.setMessage(report.best.better ? `So far ${percent(report.best)} faster.` : 'None of the gaits so far is faster.');
      case 'end':
        this.showEnd(report);
    }
  }

  private showEnd(report: SearchReport & { kind: 'end' }): void {
    this.endSearch();
    if ('refused' in report) return this.setMessage(`This gait cannot be made faster: ${report.refused}.`);
    const { best, done } = report;
    const stopText = done < this.gaitCount ? `Stopped after ${done} of ${this.gaitCount} gaits. ` : '';
    if (best?.better) {
      this.show(best);
      const { comparison } = best;
      return this.setMessage(`${stopText}Faster on ${comparison.faster} of ${comparison.robots} random robots and floors, and ${percent(best)} faster where only 5 % are slower. No servo turns faster than ${comparison.rate.toFixed(0)} °/s.`);
    }
    this.resultBox.hidden = true;
    if (done === 0) return this.setMessage(`${stopText}Nothing was tried yet.`);
    this.setMessage(`${stopText}No gait was found that is faster than this one on the slow ones of the random robots and floors. More rounds or another seed may find one.`);
  }

  /** Resets the view after a search, so that the button starts a new one. */
  private endSearch(): void {
    this.search = null;
    this.progressBar.hidden = true;
    this.startButton.textContent = BUTTON_LABELS.start;
  }

  private show(bestGait: BestGait): void {
    const { referenceTrial } = this;
    if (!referenceTrial) return;
    this.best = bestGait;
    const columns = [referenceTrial, bestGait.trial].map((trial) => formatFigures(trial, bestGait.comparison.unit));
    element('faster-rows').replaceChildren(
      ...Object.entries(ROW_LABELS).map(([row, label]) => tableRow([label, ...columns.map((column) => column[row as keyof typeof ROW_LABELS])])),
    );
    this.replacedGait = null;
    this.takeButton.textContent = BUTTON_LABELS.take;
    element('faster-ways').textContent = '';
    this.resultBox.hidden = false;
  }

  /** Puts the found gait into the editor, or restores the gait that it has replaced. */
  private useFoundGait(): void {
    const currentGait = this.editor.gait();
    if (!currentGait || !this.best) return;
    const nextGait = this.replacedGait ?? this.best.bars;
    this.replacedGait = this.replacedGait ? null : currentGait;
    this.takeButton.textContent = this.replacedGait ? BUTTON_LABELS.back : BUTTON_LABELS.take;
    this.editor.setGait({ ...nextGait, name: currentGait.name });
  }

  private async compare(): Promise<void> {
    const { reference, best } = this;
    if (!reference || !best) return;
    const { robot, toml, isReal } = this.session;
    // The comparison only puts the found gait into the robot, so the result stays.
    if (!isReal) this.toml = robot.putGait(toml, best.bars);
    await this.editor.compare(reference, best.bars, element('faster-ways'));
  }

  private readonly setMessage = (text: string): void => setText(this.message, text);
}

const percent = ({ gain }: BestGait) => `${(100 * gain).toFixed(0)} %`;
