// Drives by hand: keys, a stick on the screen or a gamepad give a direction, and the gait for it walks as long as
// they are held.
import type { Way } from '../robot';
import { WORDS } from '../words';
import { element } from './canvas';

/** A direction: forward and left, each from -1 to 1. */
export interface Wish {
  ahead: number;
  left: number;
}

/** A gait and its displacement per cycle. */
export interface Choice {
  command: string;
  way: Way;
}

/** Dead zone of a stick. */
const DEAD = 0.35;

/** Least cosine of the angle between a gait's displacement and the direction. */
const NEAR = 0.8;

/** Least displacement of a gait that counts, mm and deg per cycle. */
const LEAST = { ahead: 2, turn: 1 };

/** The direction of each key. */
const KEYS: Record<string, Wish> = {
  ArrowUp: { ahead: 1, left: 0 },
  ArrowDown: { ahead: -1, left: 0 },
  ArrowLeft: { ahead: 0, left: 1 },
  ArrowRight: { ahead: 0, left: -1 },
  KeyW: { ahead: 1, left: 0 },
  KeyS: { ahead: -1, left: 0 },
  KeyA: { ahead: 0, left: 1 },
  KeyD: { ahead: 0, left: -1 },
};

/**
 * Returns the gait for a direction, of those with a known prediction; null if there is none. Displacement and turn
 * are scaled by the robot's largest, and of gaits with the same direction the farthest is taken.
 */
export function gaitFor({ ahead, left }: Wish, choices: Choice[]): string | null {
  const size = Math.hypot(ahead, left);
  if (size < DEAD) return null;
  const most = (of: (way: Way) => number | null) => Math.max(...choices.map(({ way }) => Math.abs(of(way) ?? 0)), 0);
  const [farthest, widest] = [most(({ forward }) => forward), most(({ turn }) => turn)];
  let best: { command: string; value: number } | null = null;
  for (const { command, way } of choices) {
    const small = (value: number | null, least: number) => value === null || Math.abs(value) < least;
    if (small(way.forward, LEAST.ahead) && small(way.turn, LEAST.turn)) continue;
    const x = farthest > 0 ? (way.forward ?? 0) / farthest : 0;
    const y = widest > 0 ? (way.turn ?? 0) / widest : 0;
    const long = Math.hypot(x, y);
    const cosine = (x * ahead + y * left) / (long * size);
    if (cosine < NEAR) continue;
    // Direction counts more than distance: an arc does not go straight.
    const value = cosine ** 4 * Math.min(1, long) ** 0.25;
    if (!best || value > best.value) best = { command, value };
  }
  return best?.command ?? null;
}

export class Steer {
  private readonly held = new Set<string>();
  private readonly stick = element('stick');
  private readonly knob = element('knob');
  private atStick: Wish = { ahead: 0, left: 0 };
  private atPad: Wish = { ahead: 0, left: 0 };
  /** The gait that was sent last; null while nothing is held. */
  private walking: string | null = null;

  /** Takes functions that list the robot's gaits and that send a line. */
  constructor(
    private readonly choices: () => Choice[],
    private readonly send: (line: string) => void,
  ) {
    document.addEventListener('keydown', (event) => this.key(event, true));
    document.addEventListener('keyup', (event) => this.key(event, false));
    // A user in another window does not see the robot.
    addEventListener('blur', () => this.release());
    document.addEventListener('visibilitychange', () => document.hidden && this.release());
    this.stick.addEventListener('pointerdown', (event) => {
      this.stick.setPointerCapture(event.pointerId);
      this.drag(event);
    });
    this.stick.addEventListener('pointermove', (event) => this.stick.hasPointerCapture(event.pointerId) && this.drag(event));
    for (const end of ['pointerup', 'pointercancel'] as const) this.stick.addEventListener(end, () => this.drag(null));
  }

  /** Reads the gamepads; called in every picture. */
  look(): void {
    const pads = (navigator.getGamepads?.() ?? []).filter((pad) => pad !== null);
    const pad = pads[0];
    const [x, y] = pad?.axes ?? [];
    const wish = { ahead: -(y ?? 0), left: -(x ?? 0) };
    if (pad?.buttons.some(({ pressed }) => pressed) && this.walking) this.release();
    if (wish.ahead === this.atPad.ahead && wish.left === this.atPad.left) return;
    this.atPad = wish;
    this.follow();
  }

  /** Releases everything that is held. */
  release(): void {
    this.held.clear();
    this.atPad = { ahead: 0, left: 0 };
    this.drag(null);
  }

  private key(event: KeyboardEvent, down: boolean): void {
    if (!(event.code in KEYS)) return;
    if (!down) {
      if (this.held.delete(event.code)) this.follow();
      return;
    }
    const { target } = event;
    // The keys belong to an input, a list, a slider, a view or the setup.
    const taken = target instanceof Element && target.closest('input, select, textarea, canvas, [role="log"], #setup') !== null;
    if (taken || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    if (event.repeat) return;
    this.held.add(event.code);
    this.follow();
  }

  private drag(event: PointerEvent | null): void {
    const { left, top, width, height } = this.stick.getBoundingClientRect();
    const half = Math.min(width, height) / 2 || 1;
    let [x, y] = event ? [(event.clientX - left - width / 2) / half, (event.clientY - top - height / 2) / half] : [0, 0];
    const beyond = Math.max(1, Math.hypot(x, y));
    [x, y] = [x / beyond, y / beyond];
    this.atStick = { ahead: -y, left: -x };
    this.knob.style.translate = `${x * half * 0.6}px ${y * half * 0.6}px`;
    this.follow();
  }

  private follow(): void {
    const wish = { ahead: this.atStick.ahead + this.atPad.ahead, left: this.atStick.left + this.atPad.left };
    for (const code of this.held) {
      wish.ahead += KEYS[code]?.ahead ?? 0;
      wish.left += KEYS[code]?.left ?? 0;
    }
    const nothing = Math.hypot(wish.ahead, wish.left) < DEAD;
    const gait = nothing ? null : gaitFor(wish, this.choices());
    // No gait for this direction: the current one goes on.
    if (gait === this.walking || (!nothing && gait === null)) return;
    if (gait === null && this.walking === null) return;
    this.walking = gait;
    this.send(gait ?? WORDS.stop);
  }
}
