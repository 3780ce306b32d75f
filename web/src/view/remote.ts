// The phone as a remote control: the page fills the screen in landscape, with the stick under one thumb and `stop`
// under the other. The screen stays on, because the page stops the robot when the screen turns off.
import { element } from './elements';

const VIBRATION_MS = 200;

export class RemoteView {
  private readonly button = element('remote');
  private wakeLock: WakeLockSentinel | null = null;

  constructor() {
    this.button.addEventListener('click', () => void (this.isOn ? this.leave() : this.enter()));
    // The system's gesture that leaves full screen also leaves the remote control.
    document.addEventListener('fullscreenchange', () => !document.fullscreenElement && this.setRemote(false));
    // A hidden page loses its wake lock.
    document.addEventListener('visibilitychange', () => !document.hidden && this.isOn && void this.keepScreenOn());
  }

  private get isOn(): boolean {
    return document.body.classList.contains('remote');
  }

  /** Vibrates the phone to report that the robot has stopped by itself. */
  vibrate(): void {
    if (navigator.userActivation?.hasBeenActive) navigator.vibrate?.(VIBRATION_MS);
  }

  private async enter(): Promise<void> {
    this.setRemote(true);
    // Some browsers, for example on an iPhone, do not have all these features; the remote control works without them.
    await document.documentElement.requestFullscreen?.().catch(() => {});
    const { orientation } = screen as Screen & { orientation?: { lock?(to: string): Promise<void> } };
    await orientation?.lock?.('landscape').catch(() => {});
    await this.keepScreenOn();
  }

  private async leave(): Promise<void> {
    this.setRemote(false);
    if (document.fullscreenElement) await document.exitFullscreen().catch(() => {});
  }

  private async keepScreenOn(): Promise<void> {
    this.wakeLock = (await navigator.wakeLock?.request('screen').catch(() => null)) ?? null;
    if (!this.isOn) this.releaseWakeLock();
  }

  private releaseWakeLock(): void {
    void this.wakeLock?.release();
    this.wakeLock = null;
  }

  private setRemote(isOn: boolean): void {
    document.body.classList.toggle('remote', isOn);
    this.button.setAttribute('aria-pressed', String(isOn));
    if (!isOn) this.releaseWakeLock();
  }
}
