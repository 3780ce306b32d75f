// The panel that writes firmware and robot through the board's boot loader.
import { loadBoard } from '../board';
import { BY_CABLE, type Session } from '../session';
import { messageOf } from '../trouble';
import { element } from './canvas';
import { reveal } from './rooms';
import type { WriteContent, Writer } from './writer';

export class FlashView {
  private readonly note = element('flash-note');
  private readonly file = element<HTMLInputElement>('flash-file');
  private readonly all = element<HTMLButtonElement>('flash-write');
  private readonly robot = element<HTMLButtonElement>('flash-robot');
  private readonly question = element('flash-question');
  readonly progress = element<HTMLProgressElement>('flash-progress');
  readonly message = element('flash-said');
  /** The image of the chosen file until the user confirms or rejects it; null without one. */
  private chosen: Uint8Array | null = null;

  constructor(
    private readonly session: () => Session,
    private readonly writer: Writer,
  ) {
    this.all.addEventListener('click', () => this.write('all'));
    this.robot.addEventListener('click', () => this.write('robot'));
    this.file.addEventListener('change', () => {
      const file = this.file.files?.[0];
      if (file) void this.choose(file).finally(() => (this.file.value = ''));
    });
    element('flash-yes').addEventListener('click', () => {
      const { chosen } = this;
      this.forget();
      if (chosen) this.write(chosen);
    });
    element('flash-no').addEventListener('click', () => this.forget());
  }

  /** Shows what can be written over this link; drops a chosen file. */
  update(): void {
    const { link, section, description } = this.session();
    this.forget();
    for (const control of [this.file, this.all, this.robot]) control.disabled = this.writer.isBusy || link.kind === 'radio';
    const radioNote = `Nothing can be written to the ${link.name}: ${BY_CABLE}.`;
    const cableNote =
      `Writes to the ${link.name} by its boot loader, verifies, and starts it. The firmware is the same for every robot; what is saved in the board stays. ` +
      `The robot alone is ${section.length} bytes for firmware ${description.version} that is there already, and takes about a second.`;
    this.note.textContent = link.kind === 'radio' ? radioNote : cableNote;
  }

  /** Scrolls to the panel and writes the robot, firmware and robot, or the image of a file. */
  write(content: WriteContent): void {
    reveal(this.note);
    this.message.scrollIntoView({ block: 'nearest' });
    this.forget();
    void this.writer.write(content, this);
  }

  /** Asks the user to confirm a file before it is written. */
  private async choose(file: File): Promise<void> {
    this.forget();
    this.message.textContent = '';
    let isLizard: boolean;
    try {
      const board = await loadBoard();
      this.chosen = board.imageOf(await file.text());
      isLizard = board.isLizard(this.chosen);
    } catch (error) {
      this.message.textContent = `not written: ${messageOf(error)}`;
      return;
    }
    const meaning = isLizard
      ? 'It is lizard firmware.'
      : 'It is not this firmware: with it the board is no longer a lizard, until firmware and robot are written again.';
    element('flash-what').textContent =
      `${file.name}, ${this.chosen.length} bytes. ${meaning} Write it to the ${this.session().link.name}?`;
    this.question.hidden = false;
    element('flash-no').focus();
  }

  private forget(): void {
    this.chosen = null;
    this.question.hidden = true;
  }
}
