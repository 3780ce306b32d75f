// Writing an image by the board's boot loader.
import { hasConsole, imageOf } from '../link/stk500';
import type { Session } from '../session';
import { sentence } from '../trouble';
import { element } from './canvas';
import type { Writer } from './writer';

export class FlashView {
  private readonly note = element('flash-note');
  private readonly file = element<HTMLInputElement>('flash-file');
  private readonly write = element<HTMLButtonElement>('flash-write');
  private readonly question = element('flash-question');
  readonly progress = element<HTMLProgressElement>('flash-progress');
  readonly said = element('flash-said');
  /** The image of the file that was chosen, until a person has decided about it. */
  private chosen: Uint8Array | null = null;

  constructor(
    private readonly session: () => Session,
    private readonly writer: Writer,
  ) {
    this.write.addEventListener('click', () => this.writeOwn());
    this.file.addEventListener('change', () => {
      const file = this.file.files?.[0];
      if (file) void this.choose(file).finally(() => (this.file.value = ''));
    });
    element('flash-yes').addEventListener('click', () => {
      const { chosen } = this;
      this.forget();
      if (chosen) void this.flash(chosen);
    });
    element('flash-no').addEventListener('click', () => this.forget());
  }

  /** Shows what can be written here. */
  update(): void {
    const { link, image } = this.session();
    this.forget();
    this.file.disabled = !link.canFlash || this.writer.isBusy;
    this.write.disabled = !link.canFlash || image === null || this.writer.isBusy;
    this.note.textContent = !link.canFlash
      ? 'The core runs in the page, without a chip: there is nothing to flash. Build an image with `make firmware` and this robot.toml.'
      : image === null
        ? `No image of this robot was built with the page; choose a HEX file for the ${link.name}.`
        : `Writes to the ${link.name} by its boot loader, verifies, and starts it. What its EEPROM holds stays.`;
  }

  /** Writes the image of the page's robot, in sight. */
  writeOwn(): void {
    const { image } = this.session();
    if (image === null) return;
    const panel = this.note.closest('details');
    if (panel) panel.open = true;
    this.said.scrollIntoView({ block: 'nearest' });
    this.forget();
    void this.flash(imageOf(image));
  }

  /** Asks about a file, which is written only then. */
  private async choose(file: File): Promise<void> {
    this.forget();
    this.said.textContent = '';
    try {
      this.chosen = imageOf(await file.text());
    } catch (error) {
      this.said.textContent = `not written: ${sentence(error)}`;
      return;
    }
    const what = hasConsole(this.chosen)
      ? 'It is a firmware of a lizard.'
      : 'It is not this firmware: with it the board no longer is a lizard, until this robot\'s image is written again.';
    element('flash-what').textContent =
      `${file.name}, ${this.chosen.length} bytes. ${what} Write it to the ${this.session().link.name}?`;
    this.question.hidden = false;
    element('flash-no').focus();
  }

  private forget(): void {
    this.chosen = null;
    this.question.hidden = true;
  }

  private async flash(image: Uint8Array): Promise<void> {
    await this.writer.write(image, this);
  }
}
