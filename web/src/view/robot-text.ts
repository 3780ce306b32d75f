// The panel with the robot.toml as text: the user can edit and share it, open or drop a file, and undo changes.
import { parseFragment } from '../address';
import { makeLink, unpack } from '../share-link';
import { type Refusal, refuse } from '../robot';
import type { Session } from '../session';
import { getMessage } from '../problem';
import { element, onFile, setText, showMessage } from './elements';
import { reveal } from './rooms';
import type { BoardWriter } from './writer';

/** Largest number of changes that can be undone. */
const MAX_UNDO_STEPS = 50;

export class RobotTextView {
  private readonly textBox = element<HTMLTextAreaElement>('robot-text');
  private readonly undoButton = element<HTMLButtonElement>('robot-undo');
  private readonly redoButton = element<HTMLButtonElement>('robot-redo');
  /** The robot.toml texts before and after the last changes, including undone changes. */
  private history: string[] = [];
  /** The index of the shown robot.toml in the history. */
  private position = 0;
  /**
   * The refusal of the last text that was tried; null if that text was loaded. The shown text may have been edited
   * since.
   */
  refusal: Refusal | null = null;

  /** `onChange` is called when the text or its refusal changes. */
  constructor(
    private readonly session: Session,
    private readonly writer: BoardWriter,
    private readonly onChange: () => void,
  ) {
    element('robot-write').addEventListener('click', () => void this.loadAndWrite());
    element('robot-take').addEventListener('click', () => void this.loadOrShowError(this.textBox.value));
    this.textBox.addEventListener('keydown', (event) => {
      if (event.key !== 'Enter' || !(event.ctrlKey || event.metaKey)) return;
      event.preventDefault();
      void this.loadOrShowError(this.textBox.value);
    });
    this.textBox.addEventListener('input', onChange);
    this.undoButton.addEventListener('click', () => void this.undo());
    this.redoButton.addEventListener('click', () => void this.restore(this.position + 1));
    element('robot-line').addEventListener('click', () => this.selectErrorLine());
    element('robot-link').addEventListener('click', () => void this.copyLink());
    element('robot-code').addEventListener('click', () => void this.toggleQrCode());
    session.robot.follow(() => this.showRobot());
    onFile(element('robot-open'), (file) => void this.openFile(file));
    document.addEventListener('dragover', (event) => {
      if (event.dataTransfer?.types.includes('Files')) event.preventDefault();
    });
    document.addEventListener('drop', (event) => {
      const file = event.dataTransfer?.files[0];
      if (!file) return;
      event.preventDefault();
      void this.openFile(file);
    });
  }

  /** Shows the session's robot. */
  private showRobot(): void {
    const { toml, file } = this.session.robot;
    if (this.history[this.position] !== toml) {
      this.history = [...this.history.slice(0, this.position + 1).slice(-MAX_UNDO_STEPS), toml];
      this.position = this.history.length - 1;
    }
    // `file` is empty while a robot from the list is loading; such a robot has no changes to undo.
    if (file === '') {
      this.history.splice(0, this.position);
      this.position = 0;
    }
    this.textBox.value = toml;
    this.showRefusal(null);
  }

  /** The shown text: the session's robot.toml, or a text that is being edited or has an error. */
  get draft(): string {
    return this.textBox.value;
  }

  /** True if there is a change to undo. */
  get canUndo(): boolean {
    return this.position > 0 || this.refusal !== null;
  }

  /** Loads the robot in an address, if any; returns false if the link or the robot in it is invalid. */
  async loadFromAddress(hash = location.hash): Promise<boolean> {
    try {
      const encoded = parseFragment(hash).get('robot');
      const toml = encoded === null ? this.session.robot.toml : await unpack(encoded);
      return toml === this.session.robot.toml || (await this.loadOrShowError(toml, null));
    } catch (error) {
      reveal(this.textBox);
      this.showRefusal(refuse(getMessage(error)));
      return false;
    }
  }

  private async openFile(file: File): Promise<void> {
    reveal(this.textBox);
    // The box must not show a binary file; a folder has no text.
    const toml = file.size > 1_000_000 ? '' : await file.text().catch(() => '');
    if (toml === '' || toml.includes('\0')) return this.showRefusal(refuse(`${file.name} is not a robot.toml.`));
    await this.loadOrShowError(toml, null);
  }

  /**
   * Loads a text as the robot, or shows it with its error; returns true if the text was accepted. `floor` is as in
   * `ShownRobot.change`: null for another robot, whose own floor must replace the floor set in the page.
   */
  async loadText(toml: string, floor?: null): Promise<boolean> {
    const refusal = await this.session.robot.change(toml, floor);
    if (!refusal) return true;
    this.textBox.value = toml;
    this.showRefusal(refusal);
    return false;
  }

  /**
   * Loads a text as the robot; after a refusal, opens the panel and selects the line with the error. Returns true if
   * the text was accepted.
   */
  private async loadOrShowError(toml: string, floor?: null): Promise<boolean> {
    if (await this.loadText(toml, floor)) return true;
    reveal(this.textBox);
    this.selectErrorLine();
    return false;
  }

  /** Loads the text as the robot and writes the robot to the board. */
  private async loadAndWrite(): Promise<void> {
    if (this.textBox.value !== this.session.robot.toml) await this.loadOrShowError(this.textBox.value);
    if (this.textBox.value !== this.session.robot.toml) return;
    await this.writer.writeRobot('robot');
  }

  /** Undoes the last change: restores the previous robot, or the current one if the shown text is refused. */
  async undo(): Promise<void> {
    if (this.refusal) return this.showRobot();
    await this.restore(this.position - 1);
  }

  /** Loads the robot at another position of the history, if there is one. */
  private async restore(position: number): Promise<void> {
    const toml = this.history[position];
    if (toml === undefined) return;
    const previousPosition = this.position;
    // The position is set first, so that the restored robot does not count as a new change.
    this.position = position;
    const refusal = await this.session.robot.change(toml);
    if (!refusal) return;
    this.position = previousPosition;
    this.showRefusal(refusal);
  }

  private async copyLink(): Promise<void> {
    try {
      await navigator.clipboard.writeText(await makeLink(this.session.robot.toml));
      this.setMessage('Link copied. It opens this robot, without the comments in the text.');
    } catch (error) {
      this.setMessage(`Cannot copy the link: ${getMessage(error)}`);
    }
  }

  /** Shows the link to the robot as a QR code, or hides it. */
  private async toggleQrCode(): Promise<void> {
    const qrCodeBox = element('robot-drawn');
    const isShown = qrCodeBox.childElementCount === 0;
    element('robot-code').setAttribute('aria-pressed', String(isShown));
    qrCodeBox.replaceChildren();
    if (!isShown) return this.setMessage('');
    const { toml } = this.session.robot;
    try {
      const [{ makeQrCode }, link] = await Promise.all([import('./qr-code'), makeLink(toml)]);
      // If the robot has changed meanwhile, the code would belong to the previous one.
      if (this.session.robot.toml !== toml) return;
      qrCodeBox.replaceChildren(makeQrCode(link));
      const isLocal = ['localhost', '127.0.0.1', '[::1]'].includes(location.hostname);
      this.setMessage(isLocal ? 'This address works only on this computer: a phone needs the page’s address on a web server.' : 'Scan the code with a phone’s camera to open this robot.');
    } catch (error) {
      this.setMessage(`Cannot draw the code: ${getMessage(error)}`);
    }
  }

  private readonly setMessage = (text: string): void => setText(element('robot-message'), text);

  private selectErrorLine(): void {
    const line = this.refusal?.line;
    if (line == null) return;
    const lines = this.textBox.value.split('\n');
    const start = lines.slice(0, line - 1).reduce((sum, text) => sum + text.length + 1, 0);
    this.textBox.focus();
    this.textBox.setSelectionRange(start, start + (lines[line - 1]?.length ?? 0));
    this.textBox.scrollTop = ((line - 4) / lines.length) * this.textBox.scrollHeight;
  }

  private showRefusal(refusal: Refusal | null): void {
    this.refusal = refusal;
    showMessage(element('robot-refusal'), refusal?.reason ?? '');
    const button = element('robot-line');
    button.hidden = refusal?.line == null;
    button.textContent = `Go to line ${refusal?.line}`;
    this.setMessage('');
    // A shown QR code belongs to the previous text.
    element('robot-drawn').replaceChildren();
    element('robot-code').setAttribute('aria-pressed', 'false');
    this.textBox.setAttribute('aria-invalid', String(refusal !== null));
    this.undoButton.disabled = !this.canUndo;
    this.redoButton.disabled = this.position >= this.history.length - 1;
    this.onChange();
  }
}
