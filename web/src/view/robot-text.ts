// The robot.toml behind everything, as text: edited, opened, dropped, undone, and given away as a link.
import { linkTo, linked } from '../link-text';
import type { Refused } from '../robot';
import type { Session } from '../session';
import { sentence } from '../trouble';
import { element } from './canvas';
import { NO_BOARD, type Writer } from './writer';

/** So many robots can be gone back to. */
const STEPS = 50;

export class RobotText {
  private readonly panel = element<HTMLDetailsElement>('robot-editor');
  private readonly box = element<HTMLTextAreaElement>('robot-text');
  private readonly undo = element<HTMLButtonElement>('robot-undo');
  /** The robots of before, the last one at the end. */
  private before: string[] = [];
  private shown = '';
  private faulty: number | null = null;

  constructor(
    private readonly session: () => Session,
    private readonly writer: Writer,
  ) {
    element('robot-write').addEventListener('click', () => void this.write());
    element('robot-take').addEventListener('click', () => void this.give(this.box.value));
    this.box.addEventListener('keydown', (event) => {
      if (event.key !== 'Enter' || !(event.ctrlKey || event.metaKey)) return;
      event.preventDefault();
      void this.give(this.box.value);
    });
    this.undo.addEventListener('click', () => void this.back());
    element('robot-line').addEventListener('click', () => this.toLine());
    element('robot-link').addEventListener('click', () => void this.link());
    const opener = element<HTMLInputElement>('robot-open');
    opener.addEventListener('change', () => {
      const file = opener.files?.[0];
      if (file) void this.open(file);
      // The same file may be chosen once more.
      opener.value = '';
    });
    document.addEventListener('dragover', (event) => {
      if (event.dataTransfer?.types.includes('Files')) event.preventDefault();
    });
    document.addEventListener('drop', (event) => {
      const file = event.dataTransfer?.files[0];
      if (!file) return;
      event.preventDefault();
      void this.open(file);
    });
  }

  /** Shows the session's robot. */
  take(): void {
    const { toml, file } = this.session();
    // While a file of the list is being read it has no name; then there is nothing to undo.
    if (file === '') this.before = [];
    else if (this.shown !== '' && this.shown !== toml) this.before = [...this.before.slice(1 - STEPS), this.shown];
    this.shown = toml;
    this.box.value = toml;
    this.undo.disabled = this.before.length === 0;
    this.say(null);
  }

  /** Takes the robot that the page's address has, if any; whether nothing was wrong with that. */
  async fromAddress(hash = location.hash): Promise<boolean> {
    try {
      const toml = await linked(hash);
      return toml === null || toml === this.session().toml || (await this.give(toml));
    } catch (error) {
      this.panel.open = true;
      this.say({ refused: sentence(error), line: null, key: '' });
      return false;
    }
  }

  private async open(file: File): Promise<void> {
    this.panel.open = true;
    // A file that is not text does not belong into the box.
    const toml = file.size > 1_000_000 ? '' : await file.text();
    if (toml === '' || toml.includes('\0')) return this.say({ refused: `${file.name} is no robot.toml.`, line: null, key: '' });
    await this.give(toml);
  }

  /** Makes the text the robot, or shows its mistakes; returns true if it became the robot. */
  private async give(toml: string): Promise<boolean> {
    const refused = await this.session().change(toml);
    if (!refused) return true;
    this.panel.open = true;
    this.box.value = toml;
    this.say(refused);
    return false;
  }

  /** Makes the text the robot and writes it to the board on USB. */
  private async write(): Promise<void> {
    const session = this.session();
    if (this.box.value !== session.toml) await this.give(this.box.value);
    if (this.box.value !== session.toml) return;
    const said = element('robot-said');
    if (!session.isReal) said.textContent = NO_BOARD;
    else await this.writer.write('robot', { said, progress: element<HTMLProgressElement>('robot-progress') });
  }

  private async back(): Promise<void> {
    const last = this.before.at(-1);
    if (last === undefined) return;
    const kept = this.before.slice(0, -1);
    const refused = await this.session().change(last);
    if (refused) return this.say(refused);
    // An undo adds no step of its own.
    this.before = kept;
    this.undo.disabled = kept.length === 0;
  }

  private async link(): Promise<void> {
    try {
      const { toml } = this.session();
      await navigator.clipboard.writeText(await linkTo(toml));
      element('robot-said').textContent = 'The link is copied: whoever opens it has this robot.';
    } catch (error) {
      element('robot-said').textContent = `The link could not be copied: ${sentence(error)}`;
    }
  }

  private toLine(): void {
    if (this.faulty === null) return;
    const lines = this.box.value.split('\n');
    const begin = lines.slice(0, this.faulty - 1).reduce((sum, line) => sum + line.length + 1, 0);
    this.box.focus();
    this.box.setSelectionRange(begin, begin + (lines[this.faulty - 1]?.length ?? 0));
    this.box.scrollTop = ((this.faulty - 4) / lines.length) * this.box.scrollHeight;
  }

  private say(refused: Refused | null): void {
    this.faulty = refused?.line ?? null;
    element('robot-refusal').hidden = refused === null;
    element('robot-refusal').textContent = refused?.refused ?? '';
    const button = element('robot-line');
    button.hidden = this.faulty === null;
    button.textContent = `Go to line ${this.faulty}`;
    element('robot-said').textContent = '';
    this.box.setAttribute('aria-invalid', String(refused !== null));
    if (this.faulty !== null) this.toLine();
  }
}
