// The button "Make it faster", which searches for a gait that is faster than the edited gait, and offers it.
import type { SearchTask } from '../../generated/tune';
import { CallableWorker } from '../callable-worker';
import { files } from '../files';
import type { BestGait, FasterWorkerApi } from '../gaits/faster-worker';
import { getMessage } from '../problem';
import type { Bars, RobotOnFloor, Trial } from '../robot';
import type { Session } from '../session';
import { element, setText, tableRow } from './elements';
import { setUpNumberInput } from './number-input';
import { formatResults } from './trial';

/** Number of gaits between two reports of the best gait so far: the size of the search's population. */
const GAITS_PER_REPORT = 20;
/**
 * Number of random robots on which gaits are compared, for a report during the search and for the final report, as in
 * `lizard tune`.
 */
const ROBOT_COUNT = { progress: 20, final: 200 };

/** Access to the edited gait. */
export interface GaitEditor {
  gait(): Bars | null;
  setGait(gait: Bars): void;
  /** Makes two robots walk the found gait and the gait to beat, and shows their displacements in `output`. */
  compare(referenceGait: Bars, foundGait: Bars, output: HTMLElement): Promise<void>;
}

const BUTTON_LABELS = { start: 'Make it faster', stop: 'Stop the search', take: 'Use this gait', back: 'Back to the previous gait' };
/** The labels of the comparison's rows. */
const ROW_LABELS = { speed: 'speed', distance: 'distance per cycle', turn: 'turn per cycle', margin: 'least margin', fastest: 'fastest servo', cycle: 'cycle' } as const;

export class FasterView {
  private readonly startButton = element<HTMLButtonElement>('faster-start');
  private readonly takeButton = element<HTMLButtonElement>('faster-take');
  private readonly progressBar = element<HTMLProgressElement>('faster-progress');
  private readonly resultBox = element('faster-result');
  /** The inputs' numbers; `rate` is the highest allowed servo speed, deg/s, or null for that of the edited gait. */
  private readonly settings = { rate: null as number | null, rounds: 5, seed: 1 };
  /** The worker of the running search; null while there is none. */
  private worker: CallableWorker<FasterWorkerApi> | null = null;
  /** True once the user has stopped the search, which then ends after the current gait. */
  private isStopped = false;
  /** The gait to beat, and its trial. */
  private referenceGait: Bars | null = null;
  private referenceTrial: Trial | null = null;
  private best: BestGait | null = null;
  /** The gait that the found gait has replaced in the editor; null if it has replaced no gait. */
  private replacedGait: Bars | null = null;
  /** The robot.toml of the running search or the shown result; empty for none. */
  private toml = '';

  constructor(
    private readonly session: Session,
    private readonly editor: GaitEditor,
  ) {
    const { settings } = this;
    setUpNumberInput(element('faster-rate'), (value) => (settings.rate = value));
    setUpNumberInput(element('faster-rounds'), (value) => (settings.rounds = Math.round(value ?? 5)));
    setUpNumberInput(element('faster-seed'), (value) => (settings.seed = Math.round(value ?? 1)));
    this.startButton.addEventListener('click', () => {
      if (this.worker) this.isStopped = true;
      else void this.startSearch();
    });
    this.takeButton.addEventListener('click', () => this.useFoundGait());
    element('faster-both').addEventListener('click', () => void this.compare());
  }

  /** Ends the search and hides the result if the robot has changed, because the result would not fit the new robot. */
  discardIfRobotChanged(): void {
    if (this.toml === '' || this.session.robot.toml === this.toml) return;
    this.toml = '';
    this.resultBox.hidden = true;
    if (!this.worker) return this.setMessage('');
    this.endSearch();
    this.setMessage('The robot has changed; the search for the previous robot has ended.');
  }

  private async startSearch(): Promise<void> {
    const bars = this.editor.gait();
    if (!bars) return this.setMessage('There is no gait to start from.');
    const { toml, floor, servos } = this.session.robot;
    this.worker = new CallableWorker<FasterWorkerApi>(new Worker(new URL('../gaits/faster-worker.ts', import.meta.url), { type: 'module' }));
    this.isStopped = false;
    this.toml = toml;
    this.referenceGait = bars;
    this.referenceTrial = this.best = null;
    this.resultBox.hidden = true;
    this.startButton.textContent = BUTTON_LABELS.stop;
    this.progressBar.removeAttribute('value');
    this.progressBar.hidden = false;
    this.setMessage('Searching for the widest stride within the limits…');
    try {
      await this.search(this.worker, { toml, floor, servos, task: { bars, ...this.settings } });
    } catch (error) {
      this.endSearch();
      this.setMessage(`This gait cannot be made faster: ${getMessage(error)}.`);
    }
  }

  /** Tries gaits until all are tried or the user stops the search; shows the progress and the result. */
  private async search(worker: CallableWorker<FasterWorkerApi>, request: RobotOnFloor & { task: SearchTask }): Promise<void> {
    const module = await files.searchModule();
    const { total: gaitCount, rate, referenceTrial } = await worker.call((search) => search.begin(module, request));
    this.referenceTrial = referenceTrial;
    this.progressBar.max = gaitCount;
    this.progressBar.value = 0;
    this.setMessage(`Trying ${gaitCount} gaits with servo speeds of at most ${rate.toFixed(0)} °/s…`);
    let [reportedScore, triedCount] = [-Infinity, 0];
    while (triedCount < gaitCount && !this.isStopped) {
      const progress = await worker.call((search) => search.tryNext());
      triedCount = progress.done;
      this.progressBar.value = triedCount;
      if (triedCount % GAITS_PER_REPORT !== 0 || triedCount === gaitCount || progress.best_score === null || progress.best_score <= reportedScore) continue;
      reportedScore = progress.best_score;
      const best = await worker.call((search) => search.compareBest(ROBOT_COUNT.progress));
      if (best?.is_better) this.showComparison(best);
      if (best) this.setMessage(best.is_better ? `The best gait so far is ${formatGain(best)}faster.` : 'No faster gait so far.');
    }
    const best = await worker.call((search) => search.compareBest(ROBOT_COUNT.final));
    this.endSearch();
    this.showResult(best, triedCount, triedCount < gaitCount ? `Stopped after ${triedCount} of ${gaitCount} gaits. ` : '');
  }

  /** Shows the result after `triedCount` gaits: the best gait, or null if no gait was valid. */
  private showResult(best: BestGait | null, triedCount: number, stopText: string): void {
    if (best?.is_better) {
      this.showComparison(best);
      const { comparison } = best;
      return this.setMessage(`${stopText}Faster on ${comparison.faster} of ${comparison.robots} random robots and floors; the speed that 95 % of them exceed is ${formatGain(best)}higher. No servo turns faster than ${comparison.rate.toFixed(0)} °/s.`);
    }
    this.resultBox.hidden = true;
    if (triedCount === 0) return this.setMessage(`${stopText}No gait was tried.`);
    this.setMessage(`${stopText}No gait was found that is faster both on most of the random robots and floors and on the slowest of them. More rounds or another seed may find one.`);
  }

  /** Ends the search at once, and resets the view, so that the button starts a new search. */
  private endSearch(): void {
    this.worker?.terminate();
    this.worker = null;
    this.progressBar.hidden = true;
    this.startButton.textContent = BUTTON_LABELS.start;
  }

  private showComparison(bestGait: BestGait): void {
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
    const { robot, board } = this.session;
    // The comparison only puts the found gait into the robot; therefore the result stays valid.
    if (!board.isReal) this.toml = robot.wasm.putGait(robot.toml, best.bars);
    await this.editor.compare(referenceGait, best.bars, element('faster-distances'));
  }

  private readonly setMessage = (text: string): void => setText(element('faster-message'), text);
}

const formatGain = ({ gain }: BestGait) => (gain === null ? '' : `${(100 * gain).toFixed(0)} % `);
