// The phone as a remote control: the whole screen in landscape, with the stick under one thumb and `stop` under the
// other. The screen is kept on, since the page stops the robot when the screen goes dark.
import { element } from './canvas';

/** Duration of a buzz, ms. */
const BUZZ_MS = 200;

export class Remote {
  private readonly button = element('remote');
  private light: WakeLockSentinel | null = null;

  constructor() {
    this.button.addEventListener('click', () => void (this.isOn ? this.leave() : this.enter()));
    // The system's own gesture for leaving full screen also ends the remote.
    document.addEventListener('fullscreenchange', () => !document.fullscreenElement && this.show(false));
    // The wake lock is lost when the page is hidden.
    document.addEventListener('visibilitychange', () => !document.hidden && this.isOn && void this.keepLight());
  }

  private get isOn(): boolean {
    return document.body.classList.contains('remote');
  }

  /** Buzzes because the robot has stopped by itself. */
  buzz(): void {
    if (navigator.userActivation?.hasBeenActive) navigator.vibrate?.(BUZZ_MS);
  }

  private async enter(): Promise<void> {
    this.show(true);
    // The remote also works in a browser that lacks one of these features, such as an iPhone's.
    await document.documentElement.requestFullscreen?.().catch(() => {});
    const { orientation } = screen as Screen & { orientation?: { lock?(to: string): Promise<void> } };
    await orientation?.lock?.('landscape').catch(() => {});
    await this.keepLight();
  }

  private async leave(): Promise<void> {
    this.show(false);
    if (document.fullscreenElement) await document.exitFullscreen().catch(() => {});
  }

  private async keepLight(): Promise<void> {
    this.light = (await navigator.wakeLock?.request('screen').catch(() => null)) ?? null;
    if (!this.isOn) this.release();
  }

  private release(): void {
    void this.light?.release();
    this.light = null;
  }

  private show(isOn: boolean): void {
    document.body.classList.toggle('remote', isOn);
    this.button.setAttribute('aria-pressed', String(isOn));
    if (!isOn) this.release();
  }
}
