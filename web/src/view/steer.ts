// Driving by hand: keys, a stick on the screen or a gamepad say where to, and the gait that leads there walks for as long
// as they are held.
import type { Way } from '../robot';
import { WORDS } from '../words';
import { element } from './canvas';

/** Where to: ahead and to the left, each from -1 to 1. */
export interface Wish {
  ahead: number;
  left: number;
}

/** A gait and the way of its cycle. */
export interface Choice {
  command: string;
  way: Way;
}

/** A stick that is nearer to its middle than this wishes nothing. */
const DEAD = 0.35;

/** The way of a gait may be so far beside the wish: the cosine of the angle between them. */
const NEAR = 0.8;

/** mm and deg in a cycle below which a gait leads nowhere. */
const LEAST = { ahead: 2, turn: 1 };

/** What keys wish; letters for hands that rest on them. */
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
 * The gait that leads where somebody wishes, of those whose ways are known; null where none does. Ways ahead and turns
 * are compared with the greatest of the robot's own, and of gaits that lead the same way the one that leads the farthest
 * is taken.
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
    // The direction counts more than the length: a bow is no way straight on.
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
  /** What was sent last: a gait while something is held. */
  private walking: string | null = null;

  /** `choices` are the robot's gaits, `send` sends a line. */
  constructor(
    private readonly choices: () => Choice[],
    private readonly send: (line: string) => void,
  ) {
    document.addEventListener('keydown', (event) => this.key(event, true));
    document.addEventListener('keyup', (event) => this.key(event, false));
    // Whoever looks elsewhere does not see where it walks.
    addEventListener('blur', () => this.release());
    document.addEventListener('visibilitychange', () => document.hidden && this.release());
    this.stick.addEventListener('pointerdown', (event) => {
      this.stick.setPointerCapture(event.pointerId);
      this.drag(event);
    });
    this.stick.addEventListener('pointermove', (event) => this.stick.hasPointerCapture(event.pointerId) && this.drag(event));
    for (const end of ['pointerup', 'pointercancel'] as const) this.stick.addEventListener(end, () => this.drag(null));
  }

  /** Looks at gamepads; in every picture. */
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

  /** Lets go of everything. */
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
    // Somebody types, chooses, moves a slider or the view, or sets the robot up.
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
    // Between two directions that no gait leads to, it goes on.
    if (gait === this.walking || (!nothing && gait === null)) return;
    if (gait === null && this.walking === null) return;
    this.walking = gait;
    this.send(gait ?? WORDS.stop);
  }
}
