// Writing an image by the board's boot loader.
import type { Session } from '../session';
import { element } from './canvas';

export class FlashView {
  private readonly note = element('flash-note');
  private readonly file = element<HTMLInputElement>('flash-file');
  private readonly write = element<HTMLButtonElement>('flash-write');
  private readonly progress = element<HTMLProgressElement>('flash-progress');
  private readonly said = element('flash-said');

  constructor(
    private readonly session: () => Session,
    private readonly busy: (busy: boolean) => void,
  ) {
    this.write.addEventListener('click', () => {
      const { image } = this.session();
      if (image !== null) void this.flash(image);
    });
    this.file.addEventListener('change', () => {
      const file = this.file.files?.[0];
      if (file) void file.text().then((hex) => this.flash(hex));
      this.file.value = '';
    });
  }

  /** Shows what can be written here. */
  update(): void {
    const { link, image } = this.session();
    this.file.disabled = !link.canFlash;
    this.write.disabled = !link.canFlash || image === null;
    this.note.textContent = !link.canFlash
      ? 'The core runs in the page, without a chip: there is nothing to flash. Build an image with `make firmware` and this robot.toml.'
      : image === null
        ? `No image of this robot was built with the page; choose a HEX file for the ${link.name}.`
        : `Writes to the ${link.name} by its boot loader, verifies, and starts it. What its EEPROM holds stays.`;
  }

  private async flash(hex: string): Promise<void> {
    this.busy(true);
    this.write.disabled = this.file.disabled = true;
    this.progress.hidden = false;
    this.said.textContent = 'calling the boot loader…';
    try {
      await this.session().flash(hex, (done, of, what) => {
        const share = (50 * done) / of + (what === 'verifying' ? 50 : 0);
        this.progress.value = share;
        const text = what === 'writing' ? 'writing…' : 'verifying…';
        if (this.said.textContent !== text) this.said.textContent = text;
      });
      this.said.textContent = 'written and verified';
    } catch (error) {
      this.said.textContent = `not written: ${error instanceof Error ? error.message : String(error)}`;
    }
    this.progress.hidden = true;
    this.busy(false);
    this.update();
  }
}
