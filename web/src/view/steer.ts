// Steers by hand: keys, a stick on the screen or a gamepad give a direction, and the robot walks the gait for this
// direction as long as they are held.
import type { Displacement } from '../robot';
import { WORDS } from '../words';
import { element } from './canvas';

/** A direction: forward and left components, each from -1 to 1. */
export interface Direction {
  ahead: number;
  left: number;
}

/** A gait and its displacement per cycle. */
export interface Choice {
  command: string;
  displacement: Displacement;
}

/** Dead zone of a stick, as a share of its full deflection. */
const DEAD_ZONE = 0.35;
/**
 * Deflections of a stick below which the robot walks at half its pace, and above which it returns to the full pace.
 */
const HALF_PACE = 0.65;
const FULL_PACE = 0.75;
/** Lowest pace of the robot, percent. */
const MIN_PACE = 10;
/** The direction of each button of a gamepad's cross, by the browser's number; any other button stops the robot. */
const CROSS: Record<number, Direction> = {
  12: { ahead: 1, left: 0 },
  13: { ahead: -1, left: 0 },
  14: { ahead: 0, left: 1 },
  15: { ahead: 0, left: -1 },
};

/** Least cosine of the angle between a gait's displacement and the direction. */
const MIN_COSINE = 0.8;

/** Least displacement of a gait that counts, mm and deg per cycle. */
const MIN_DISPLACEMENT = { ahead: 2, turn: 1 };

/** The direction of each key. */
const KEYS: Record<string, Direction> = {
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
 * Returns the best gait for a direction among gaits with a known prediction; null if none fits. Distances and turns
 * are scaled by the robot's largest, and of gaits with the same direction the farthest is taken.
 */
export function gaitFor({ ahead, left }: Direction, choices: Choice[]): string | null {
  const size = Math.hypot(ahead, left);
  if (size < DEAD_ZONE) return null;
  const largestOf = (componentOf: (displacement: Displacement) => number | null) => Math.max(...choices.map(({ displacement }) => Math.abs(componentOf(displacement) ?? 0)), 0);
  const [largestForward, largestTurn] = [largestOf(({ forward }) => forward), largestOf(({ turn }) => turn)];
  // A drift counts as zero, even if no gait that turns is predicted yet and the drift would be the largest turn.
  const shareOf = (value: number | null, smallest: number, largest: number) => (value !== null && Math.abs(value) >= smallest ? value / largest : 0);
  let best: { command: string; value: number } | null = null;
  for (const { command, displacement } of choices) {
    const x = shareOf(displacement.forward, MIN_DISPLACEMENT.ahead, largestForward);
    const y = shareOf(displacement.turn, MIN_DISPLACEMENT.turn, largestTurn);
    if (x === 0 && y === 0) continue;
    const length = Math.hypot(x, y);
    const cosine = (x * ahead + y * left) / (length * size);
    if (cosine < MIN_COSINE) continue;
    // Direction counts more than distance, so that no arc is taken for straight ahead.
    const value = cosine ** 4 * Math.min(1, length) ** 0.25;
    if (!best || value > best.value) best = { command, value };
  }
  return best?.command ?? null;
}

export class Steer {
  private readonly held = new Set<string>();
  private readonly stick = element('stick');
  private readonly knob = element('knob');
  private atStick: Direction = { ahead: 0, left: 0 };
  private atPad: Direction = { ahead: 0, left: 0 };
  /**
   * False from a release until the gamepads' sticks are let go, so that a stick that is still held does not drive.
   */
  private isPadActive = true;
  private isPressed = false;
  /** The element that the pointer pressed last, until Tab moves the focus. */
  private touched: EventTarget | null = null;
  /** True while another window has the keyboard. */
  private isAway = false;
  /** The gait that was sent last; null while nothing is held. */
  private walking: string | null = null;
  /** The pace to restore, percent, while a stick asks for half of it. */
  private fullPace: number | null = null;

  /**
   * `choices` lists the predicted gaits, `send` sends a line, `isBarred` forbids to drive, `pace` returns the pace,
   * percent.
   */
  constructor(
    private readonly choices: () => Choice[],
    private readonly send: (line: string) => void,
    private readonly isBarred: () => boolean,
    private readonly pace: () => number,
  ) {
    // In the capture phase, before a slider or a view handles an arrow key.
    document.addEventListener('keydown', (event) => this.handleKey(event, true), true);
    document.addEventListener('pointerdown', ({ target }) => (this.touched = target), true);
    document.addEventListener('keyup', (event) => this.handleKey(event, false));
    // A user in another window does not see the robot.
    addEventListener('blur', () => {
      this.isAway = true;
      this.release();
    });
    for (const eventName of ['focus', 'pointerdown', 'keydown']) addEventListener(eventName, () => (this.isAway = false), true);
    document.addEventListener('visibilitychange', () => document.hidden && this.release());
    this.stick.addEventListener('pointerdown', (event) => {
      this.stick.setPointerCapture(event.pointerId);
      this.drag(event);
    });
    this.stick.addEventListener('pointermove', (event) => this.stick.hasPointerCapture(event.pointerId) && this.drag(event));
    for (const eventName of ['pointerup', 'pointercancel'] as const) this.stick.addEventListener(eventName, () => this.drag(null));
  }

  /** Reads the gamepads; called for every frame of the page. */
  readGamepads(): void {
    const pads = (navigator.getGamepads?.() ?? []).filter((pad) => pad !== null);
    const direction = { ahead: 0, left: 0 };
    let isPressed = false;
    for (const { axes, buttons } of pads) {
      direction.ahead -= axes[1] ?? 0;
      direction.left -= axes[0] ?? 0;
      buttons.forEach(({ pressed }, n) => {
        if (!pressed) return;
        isPressed ||= !(n in CROSS);
        direction.ahead += CROSS[n]?.ahead ?? 0;
        direction.left += CROSS[n]?.left ?? 0;
      });
    }
    if (isPressed && !this.isPressed) {
      this.send(WORDS.stop);
      this.release(false);
    }
    this.isPressed = isPressed;
    if (this.walking && this.isBarred()) this.release();
    this.isPadActive ||= Math.hypot(direction.ahead, direction.left) < DEAD_ZONE;
    if (!this.isPadActive || this.isAway || (direction.ahead === this.atPad.ahead && direction.left === this.atPad.left)) return;
    this.atPad = direction;
    this.follow();
  }

  /** Releases everything that is held; if `stopsRobot`, also stops a robot that walks because of it. */
  release(stopsRobot = true): void {
    this.held.clear();
    this.atPad = { ahead: 0, left: 0 };
    this.isPadActive = false;
    if (!stopsRobot) this.walking = null;
    this.drag(null);
  }

  private handleKey(event: KeyboardEvent, isDown: boolean): void {
    if (event.key === 'Tab') this.touched = null;
    if (!(event.code in KEYS)) return;
    if (!isDown) {
      if (this.held.delete(event.code)) this.follow();
      return;
    }
    const { target } = event;
    // Text inputs and the setup keep these keys for themselves; so does a slider, a list or a view that was reached
    // with Tab.
    const textFields = 'textarea, [type="text"], [type="number"], #setup';
    const isTaken = target instanceof Element && target.closest(target === this.touched ? textFields : `${textFields}, input, select, canvas, [role="log"]`) !== null;
    if (isTaken || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    if (event.repeat) return;
    this.held.add(event.code);
    this.follow();
  }

  private drag(event: PointerEvent | null): void {
    const { left, top, width, height } = this.stick.getBoundingClientRect();
    const radius = Math.min(width, height) / 2 || 1;
    let [x, y] = event ? [(event.clientX - left - width / 2) / radius, (event.clientY - top - height / 2) / radius] : [0, 0];
    const divisor = Math.max(1, Math.hypot(x, y));
    [x, y] = [x / divisor, y / divisor];
    this.atStick = { ahead: -y, left: -x };
    this.knob.style.translate = `${x * radius * 0.6}px ${y * radius * 0.6}px`;
    this.follow();
  }

  private follow(): void {
    const direction = { ahead: this.atStick.ahead + this.atPad.ahead, left: this.atStick.left + this.atPad.left };
    for (const code of this.held) {
      direction.ahead += KEYS[code]?.ahead ?? 0;
      direction.left += KEYS[code]?.left ?? 0;
    }
    const size = Math.hypot(direction.ahead, direction.left);
    const isIdle = this.isBarred() || size < DEAD_ZONE;
    const isHalfPace = !isIdle && size < (this.fullPace === null ? HALF_PACE : FULL_PACE);
    if (isHalfPace && this.fullPace === null) {
      this.fullPace = this.pace();
      this.send(`${WORDS.speed} ${Math.max(MIN_PACE, Math.round(this.fullPace / 2))}`);
    }
    const gait = isIdle ? null : gaitFor(direction, this.choices());
    // Without a gait for this direction the current one goes on.
    if (gait !== this.walking && (isIdle || gait !== null)) {
      this.walking = gait;
      this.send(gait ?? WORDS.stop);
    }
    if (!isHalfPace && this.fullPace !== null) {
      this.send(`${WORDS.speed} ${this.fullPace}`);
      this.fullPace = null;
    }
  }
}
