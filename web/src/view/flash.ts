// The panel that writes the firmware and the robot to the board through its boot loader.
import { effect } from '@preact/signals-core';

import { loadBoardModule } from '../board-module';
import { NO_WRITING_BY_RADIO } from '../board-program';
import type { Session } from '../session';
import { getMessage } from '../problem';
import { element, onFile } from './elements';
import { reveal } from './rooms';
import type { WriteContent, BoardWriter } from './writer';

export class FlashView {
  private readonly note = element('flash-note');
  private readonly fileInput = element<HTMLInputElement>('flash-file');
  private readonly writeAllButton = element<HTMLButtonElement>('flash-write');
  private readonly writeRobotButton = element<HTMLButtonElement>('flash-robot');
  private readonly confirmationBox = element('flash-question');
  private readonly message = element('flash-message');
  /** The image of the chosen file until the user confirms or rejects it; null if there is none. */
  private chosenImage: Uint8Array | null = null;

  constructor(
    private readonly session: Session,
    private readonly writer: BoardWriter,
  ) {
    this.writeAllButton.addEventListener('click', () => this.write('all'));
    this.writeRobotButton.addEventListener('click', () => this.write('robot'));
    onFile(this.fileInput, (file) => void this.askToConfirm(file));
    element('flash-yes').addEventListener('click', () => {
      const { chosenImage } = this;
      this.dropChosenImage();
      if (chosenImage) this.write(chosenImage);
    });
    element('flash-no').addEventListener('click', () => this.dropChosenImage());
    effect(() => this.update());
  }

  /** Updates the controls and the note for the session's link; drops the chosen file. */
  private update(): void {
    const { link } = this.session.board;
    const { section, description } = this.session.robot;
    const isBusy = this.writer.isBusy.value;
    if (!link) return;
    this.dropChosenImage();
    for (const control of [this.fileInput, this.writeAllButton, this.writeRobotButton]) control.disabled = isBusy || link.kind === 'radio';
    const radioNote = `The page cannot write to the ${link.name}: ${NO_WRITING_BY_RADIO}.`;
    const cableNote =
      `Writes to the ${link.name} through its boot loader, verifies, and starts the board. The firmware is the same for every robot; saved settings stay. ` +
      `If the board already has firmware ${description.version}, the robot alone (${section.length} bytes) can be written in about a second.`;
    this.note.textContent = link.kind === 'radio' ? radioNote : cableNote;
  }

  /** Opens the panel and writes the robot alone, firmware and robot, or the image of a file. */
  write(content: WriteContent): void {
    reveal(this.note);
    this.message.scrollIntoView({ block: 'nearest' });
    this.dropChosenImage();
    void this.writer.write(content, 'flash');
  }

  /** Reads a file and asks the user whether to write it. */
  private async askToConfirm(file: File): Promise<void> {
    this.dropChosenImage();
    this.message.textContent = '';
    let isLizard: boolean;
    try {
      const board = await loadBoardModule();
      this.chosenImage = board.parseImage(await file.text());
      isLizard = board.isLizard(this.chosenImage);
    } catch (error) {
      this.message.textContent = `not written: ${getMessage(error)}`;
      return;
    }
    const kindText = isLizard
      ? 'It is lizard firmware.'
      : 'It is not this firmware: the board will not be a lizard until firmware and robot are written again.';
    element('flash-question-text').textContent =
      `${file.name}, ${this.chosenImage.length} bytes. ${kindText} Write it to the ${this.session.board.link.name}?`;
    this.confirmationBox.hidden = false;
    element('flash-no').focus();
  }

  private dropChosenImage(): void {
    this.chosenImage = null;
    this.confirmationBox.hidden = true;
  }
}
