// An image on its way to a board: how far it is, and what became of it, wherever that is shown.
import type { Session } from '../session';
import { sentence } from '../trouble';

/** Where it is shown. */
export interface Display {
  progress: HTMLProgressElement;
  said: HTMLElement;
}

export class Writer {
  private isWriting = false;

  /** `busy` is told when the line belongs to the boot loader, and when it is free again. */
  constructor(
    private readonly session: () => Session,
    private readonly busy: (busy: boolean) => void,
  ) {}

  /** Whether the line belongs to the boot loader. */
  get isBusy(): boolean {
    return this.isWriting;
  }

  /** Writes and verifies an image and waits for it to greet; whether all of that went well. */
  async write(image: Uint8Array, { progress, said }: Display): Promise<boolean> {
    if (this.isWriting) return false;
    const begun = performance.now();
    this.isWriting = true;
    this.busy(true);
    progress.hidden = false;
    progress.value = 0;
    said.textContent = 'calling the boot loader…';
    let written = false;
    try {
      await this.session().flash(image, (done, of, what) => {
        progress.value = (50 * done) / of + (what === 'verifying' ? 50 : 0);
        const text = what === 'writing' ? 'writing…' : 'verifying…';
        if (said.textContent !== text) said.textContent = text;
      });
      written = true;
      said.textContent = `written and verified in ${((performance.now() - begun) / 1000).toFixed(0)} s`;
    } catch (error) {
      said.textContent = `not written: ${sentence(error)}`;
    }
    progress.hidden = true;
    this.isWriting = false;
    this.busy(false);
    if (!written) return false;
    if (await this.session().begins()) return true;
    said.textContent = 'written and verified; it does not greet as this firmware does';
    return false;
  }
}
