// The button "Make it faster", which searches for a gait that is faster than the edited gait, and offers it.
import { files } from '../files';
import { type SearchReport, type BestGait, FasterSearch } from '../gaits/faster';
import type { Bars, Trial } from '../robot';
import type { Session } from '../session';
import { element, setText, tableRow } from './elements';
import { setUpNumberInput } from './number-input';
import { formatResults } from './trial';

/** Access to the edited gait. */
export interface GaitEditor {
  gait(): Bars | null;
  setGait(gait: Bars): void;
  /** Makes two robots walk the found gait and the previous gait, and shows their displacements in `output`. */
  compare(previousGait: Bars, foundGait: Bars, output: HTMLElement): Promise<void>;
}

const BUTTON_LABELS = { start: 'Make it faster', stop: 'Stop the search', take: 'Use this gait', back: 'Back to the previous gait' };
/** The labels of the comparison's rows. */
const ROW_LABELS = { speed: 'speed', distance: 'distance per cycle', turn: 'turn per cycle', margin: 'least margin', fastest: 'fastest servo', cycle: 'cycle' } as const;

export class FasterView {
  private readonly startButton = element<HTMLButtonElement>('faster-start');
  private readonly takeButton = element<HTMLButtonElement>('faster-take');
  private readonly progressBar = element<HTMLProgressElement>('faster-progress');
  private readonly message = element('faster-message');
  private readonly resultBox = element('faster-result');
  private readonly settings = { rate: null as number | null, rounds: 5, seed: 1 };
  private search: FasterSearch | null = null;
  /** The gait to beat, and its trial. */
  private referenceGait: Bars | null = null;
  private referenceTrial: Trial | null = null;
  private best: BestGait | null = null;
  /** The gait that the found gait has replaced in the editor; null if it has replaced no gait. */
  private replacedGait: Bars | null = null;
  /** The robot.toml of the running search or the shown result; empty for none. */
  private toml = '';
  /** Number of gaits that the search tries. */
  private gaitCount = 0;

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

  /** Ends the search if the robot has changed, because the result would not fit the new robot. */
  endIfRobotChanged(): void {
    if (this.toml === '' || this.session.toml === this.toml) return;
    this.toml = '';
    this.resultBox.hidden = true;
    if (!this.search) return this.setMessage('');
    this.search.cancel();
    this.endSearch();
    this.setMessage('The robot has changed; the search for the previous robot has ended.');
  }

  private startSearch(): void {
    const bars = this.editor.gait();
    if (!bars) return this.setMessage('There is no gait to start from.');
    const { toml, floor, servos } = this.session;
    this.toml = toml;
    this.referenceGait = bars;
    this.referenceTrial = this.best = null;
    this.resultBox.hidden = true;
    this.startButton.textContent = BUTTON_LABELS.stop;
    this.progressBar.removeAttribute('value');
    this.progressBar.hidden = false;
    this.setMessage('Searching for the widest stride within the limits…');
    this.search = new FasterSearch(files.searchModule(), { toml, floor, servos, task: { bars, ...this.settings } }, (report) => this.handleReport(report));
  }

  private handleReport(report: SearchReport): void {
    switch (report.kind) {
      case 'start':
        this.referenceTrial = report.referenceTrial;
        this.gaitCount = this.progressBar.max = report.total;
        this.progressBar.value = 0;
        return this.setMessage(`Trying ${report.total} gaits with servo speeds of at most ${report.rate.toFixed(0)} °/s…`);
      case 'progress':
        this.progressBar.value = report.done;
        return;
      case 'best':
        if (report.best.is_better) this.show(report.best);
        return this.setMessage(report.best.is_better ? `${formatGain(report.best)} faster so far.` : 'No faster gait so far.');
      case 'end':
        this.showEnd(report);
    }
  }

  private showEnd(report: SearchReport & { kind: 'end' }): void {
    this.endSearch();
    if ('refused' in report) return this.setMessage(`This gait cannot be made faster: ${report.refused}.`);
    const { best, done } = report;
    const stopText = done < this.gaitCount ? `Stopped after ${done} of ${this.gaitCount} gaits. ` : '';
    if (best?.is_better) {
      this.show(best);
      const { comparison } = best;
      return this.setMessage(`${stopText}Faster on ${comparison.faster} of ${comparison.robots} random robots and floors; the speed that 95 % of them exceed is ${formatGain(best)} higher. No servo turns faster than ${comparison.rate.toFixed(0)} °/s.`);
    }
    this.resultBox.hidden = true;
    if (done === 0) return this.setMessage(`${stopText}No gait was tried.`);
    this.setMessage(`${stopText}No faster gait was found for the slowest random robots and floors. More rounds or another seed may find a faster gait.`);
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
    const columns = [referenceTrial, bestGait.trial].map((trial) => formatResults(trial, bestGait.comparison.unit));
    element('faster-rows').replaceChildren(
      ...Object.entries(ROW_LABELS).map(([row, label]) => tableRow([label, ...columns.map((column) => column[row as keyof typeof ROW_LABELS])])),
    );
    this.replacedGait = null;
    this.takeButton.textContent = BUTTON_LABELS.take;
    element('faster-distances').textContent = '';
    this.resultBox.hidden = false;
  }

  /** Puts the found gait into the editor, or restores the replaced gait. */
  private useFoundGait(): void {
    const currentGait = this.editor.gait();
    if (!currentGait || !this.best) return;
    const nextGait = this.replacedGait ?? this.best.bars;
    this.replacedGait = this.replacedGait ? null : currentGait;
    this.takeButton.textContent = this.replacedGait ? BUTTON_LABELS.back : BUTTON_LABELS.take;
    this.editor.setGait({ ...nextGait, name: currentGait.name });
  }

  private async compare(): Promise<void> {
    const { referenceGait, best } = this;
    if (!referenceGait || !best) return;
    const { robot, toml, isReal } = this.session;
    // The comparison only puts the found gait into the robot; therefore the result stays valid.
    if (!isReal) this.toml = robot.putGait(toml, best.bars);
    await this.editor.compare(referenceGait, best.bars, element('faster-distances'));
  }

  private readonly setMessage = (text: string): void => setText(this.message, text);
}

const formatGain = ({ gain }: BestGait) => `${(100 * gain).toFixed(0)} %`;
