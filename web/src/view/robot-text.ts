// The robot.toml as text: edited, opened, dropped into the box, undone, and shared as a link.
import { partsOf } from '../address';
import { linkTo, unpack } from '../link-text';
import type { Refused } from '../robot';
import type { Session } from '../session';
import { messageOf } from '../trouble';
import { element } from './canvas';
import { reveal } from './rooms';
import { NO_BOARD, type Writer } from './writer';

/** Largest number of robots that undo can restore. */
const MAX_UNDO_STEPS = 50;

export class RobotText {
  private readonly box = element<HTMLTextAreaElement>('robot-text');
  private readonly undo = element<HTMLButtonElement>('robot-undo');
  private readonly redo = element<HTMLButtonElement>('robot-redo');
  /** The previous robots, the latest at the end. */
  private before: string[] = [];
  /** The robots that were undone, the latest at the end. */
  private undone: string[] = [];
  private shown = '';
  /** The refusal of the shown text; null if the session's robot was loaded from it. */
  refused: Refused | null = null;

  /** `onText` is called when the text or its refusal has changed. */
  constructor(
    private readonly session: () => Session,
    private readonly writer: Writer,
    private readonly onText: () => void,
  ) {
    element('robot-write').addEventListener('click', () => void this.write());
    element('robot-take').addEventListener('click', () => void this.loadAndShow(this.box.value));
    this.box.addEventListener('keydown', (event) => {
      if (event.key !== 'Enter' || !(event.ctrlKey || event.metaKey)) return;
      event.preventDefault();
      void this.loadAndShow(this.box.value);
    });
    this.box.addEventListener('input', onText);
    this.undo.addEventListener('click', () => void this.undoLast());
    this.redo.addEventListener('click', () => void this.redoLast());
    element('robot-line').addEventListener('click', () => this.goToMistake());
    element('robot-link').addEventListener('click', () => void this.copyLink());
    element('robot-code').addEventListener('click', () => void this.showCode());
    const opener = element<HTMLInputElement>('robot-open');
    opener.addEventListener('change', () => {
      const file = opener.files?.[0];
      if (file) void this.open(file);
      // Otherwise the same file could not be chosen again.
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
  showRobot(): void {
    const { toml, file } = this.session();
    // While a file of the list is being read it has no name; then there is nothing to undo.
    if (file === '') this.before = [];
    else if (this.shown !== '' && this.shown !== toml) this.before = [...this.before.slice(1 - MAX_UNDO_STEPS), this.shown];
    if (this.shown !== toml) this.undone = [];
    this.shown = toml;
    this.box.value = toml;
    this.showRefusal(null);
  }

  /** The shown text: the session's robot, or a text that is being edited or has a mistake. */
  get draft(): string {
    return this.box.value;
  }

  /** True if there is a step to undo. */
  get canUndo(): boolean {
    return this.before.length > 0 || this.refused !== null;
  }

  /** Loads the robot in the page's address, if there is one; returns false if it is invalid. */
  async fromAddress(hash = location.hash): Promise<boolean> {
    try {
      const encoded = partsOf(hash).get('robot');
      const toml = encoded === null ? this.session().toml : await unpack(encoded);
      return toml === this.session().toml || (await this.loadAndShow(toml));
    } catch (error) {
      reveal(this.box);
      this.showRefusal({ refused: messageOf(error), meaning: null, line: null, key: '' });
      return false;
    }
  }

  private async open(file: File): Promise<void> {
    reveal(this.box);
    // A binary file is not shown in the box.
    const toml = file.size > 1_000_000 ? '' : await file.text();
    if (toml === '' || toml.includes('\0')) return this.showRefusal({ refused: `${file.name} is not a robot.toml.`, meaning: null, line: null, key: '' });
    await this.loadAndShow(toml);
  }

  /** Loads a text as the robot, or shows it with its mistake; returns true if it was accepted. */
  async loadText(toml: string): Promise<boolean> {
    const refusal = await this.session().change(toml);
    if (!refusal) return true;
    this.box.value = toml;
    this.showRefusal(refusal);
    return false;
  }

  /**
   * Loads a text as the robot; if it is refused, opens the panel and selects the line of the mistake. Returns true if
   * accepted.
   */
  private async loadAndShow(toml: string): Promise<boolean> {
    if (await this.loadText(toml)) return true;
    reveal(this.box);
    this.goToMistake();
    return false;
  }

  /** Loads the text as the robot and writes it to the board on USB. */
  private async write(): Promise<void> {
    const session = this.session();
    if (this.box.value !== session.toml) await this.loadAndShow(this.box.value);
    if (this.box.value !== session.toml) return;
    const message = element('robot-said');
    if (!session.isReal) message.textContent = NO_BOARD;
    else await this.writer.write('robot', { message, progress: element<HTMLProgressElement>('robot-progress') });
  }

  /** Undoes the last change: restores the previous robot, or the current one if the shown text is refused. */
  async undoLast(): Promise<void> {
    if (this.refused) return this.showRobot();
    const { before, undone, shown } = this;
    const lastToml = before.at(-1);
    if (lastToml !== undefined) await this.restore(lastToml, before.slice(0, -1), [...undone, shown]);
  }

  /** Restores the robot that was undone last. */
  private async redoLast(): Promise<void> {
    const { before, undone, shown } = this;
    const nextToml = undone.at(-1);
    if (nextToml !== undefined) await this.restore(nextToml, [...before, shown], undone.slice(0, -1));
  }

  /** Loads an earlier robot into the session, with the lists of robots for undo and redo that belong to it. */
  private async restore(toml: string, before: string[], undone: string[]): Promise<void> {
    const current = { before: this.before, undone: this.undone, shown: this.shown };
    // A restored robot is not recorded as a step.
    Object.assign(this, { before, undone, shown: toml });
    const refusal = await this.session().change(toml);
    if (!refusal) return;
    Object.assign(this, current);
    this.showRefusal(refusal);
  }

  private async copyLink(): Promise<void> {
    try {
      await navigator.clipboard.writeText(await linkTo(this.session().toml));
      this.showMessage('The link is copied: it opens this robot, without the comments of its text.');
    } catch (error) {
      this.showMessage(`The link could not be copied: ${messageOf(error)}`);
    }
  }

  /** Shows the link to the robot as a QR code, or hides it. */
  private async showCode(): Promise<void> {
    const codeBox = element('robot-drawn');
    const isShown = codeBox.childElementCount === 0;
    element('robot-code').setAttribute('aria-pressed', String(isShown));
    codeBox.replaceChildren();
    if (!isShown) return this.showMessage('');
    try {
      const { qrCode } = await import('./qr-code');
      codeBox.replaceChildren(qrCode(await linkTo(this.session().toml)));
      const isLocal = ['localhost', '127.0.0.1', '[::1]'].includes(location.hostname);
      this.showMessage(isLocal ? 'This address is this computer’s own: a phone reaches the page only where a web server serves it.' : 'A phone’s camera opens this robot.');
    } catch (error) {
      this.showMessage(`No code can be drawn: ${messageOf(error)}`);
    }
  }

  private showMessage(text: string): void {
    element('robot-said').textContent = text;
  }

  private goToMistake(): void {
    const line = this.refused?.line;
    if (line == null) return;
    const lines = this.box.value.split('\n');
    const begin = lines.slice(0, line - 1).reduce((sum, text) => sum + text.length + 1, 0);
    this.box.focus();
    this.box.setSelectionRange(begin, begin + (lines[line - 1]?.length ?? 0));
    this.box.scrollTop = ((line - 4) / lines.length) * this.box.scrollHeight;
  }

  private showRefusal(refusal: Refused | null): void {
    this.refused = refusal;
    element('robot-refusal').hidden = refusal === null;
    element('robot-refusal').textContent = refusal?.refused ?? '';
    const button = element('robot-line');
    button.hidden = refusal?.line == null;
    button.textContent = `Go to line ${refusal?.line}`;
    this.showMessage('');
    // The code that was shown belongs to another robot.
    element('robot-drawn').replaceChildren();
    element('robot-code').setAttribute('aria-pressed', 'false');
    this.box.setAttribute('aria-invalid', String(refusal !== null));
    this.undo.disabled = !this.canUndo;
    this.redo.disabled = this.undone.length === 0;
    this.onText();
  }
}
