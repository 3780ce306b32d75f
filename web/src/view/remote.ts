// The phone as a remote control: the page fills the screen in landscape, with the stick under one thumb and `stop`
// under the other. The screen stays on, because the page stops the robot when the screen turns off.
import { element } from './elements';

const VIBRATION_MS = 200;

const isRemote = () => document.body.classList.contains('remote');

/** Vibrates the phone to report that the robot has stopped by itself. */
export function vibrate(): void {
  if (navigator.userActivation?.hasBeenActive) navigator.vibrate?.(VIBRATION_MS);
}

/** `stop` stops the robot. */
export function setUpRemote(stop: () => void): void {
  const button = element('remote');
  let wakeLock: WakeLockSentinel | null = null;
  const releaseWakeLock = () => {
    void wakeLock?.release();
    wakeLock = null;
  };
  const keepScreenOn = async () => {
    wakeLock = (await navigator.wakeLock?.request('screen').catch(() => null)) ?? null;
    if (!isRemote()) releaseWakeLock();
  };
  const setRemote = (isOn: boolean) => {
    document.body.classList.toggle('remote', isOn);
    button.setAttribute('aria-pressed', String(isOn));
    if (!isOn) releaseWakeLock();
  };
  const enter = async () => {
    setRemote(true);
    // Some browsers, for example on an iPhone, do not have all these features; the remote control works without them.
    await document.documentElement.requestFullscreen?.().catch(() => {});
    const { orientation } = screen as Screen & { orientation?: { lock?(to: string): Promise<void> } };
    await orientation?.lock?.('landscape').catch(() => {});
    await keepScreenOn();
  };
  const leave = async () => {
    setRemote(false);
    if (document.fullscreenElement) await document.exitFullscreen().catch(() => {});
  };
  button.addEventListener('click', () => void (isRemote() ? leave() : enter()));
  // The system's gesture that leaves full screen also leaves the remote control. In full screen the browser keeps the
  // Esc key, by which the user stops the robot, and only leaves full screen.
  document.addEventListener('fullscreenchange', () => {
    if (document.fullscreenElement || !isRemote()) return;
    setRemote(false);
    stop();
  });
  // A hidden page loses its wake lock.
  document.addEventListener('visibilitychange', () => !document.hidden && isRemote() && void keepScreenOn());
}
