// Steering by hand: keys, a stick on the screen or a gamepad give a direction, and the robot walks the gait for this
// direction as long as the control is held.
import type { PredictedGait, Predictor } from '../predictor';
import type { Displacement } from '../robot';
import type { Session } from '../session';
import { WORDS } from '../words';
import { element } from './canvas';

/** A direction of steering: its components forward and to the left, each from -1 to 1. */
export interface Direction {
  ahead: number;
  left: number;
}

/** Dead zone of a stick, as a share of its full deflection. */
const DEAD_ZONE = 0.35;
/** Deflection of a stick below which the robot walks at half its pace, as a share of the full deflection. */
const HALF_PACE_DEFLECTION = 0.65;
/** Deflection of a stick above which the robot returns to its full pace; greater, so that the pace does not flutter. */
const FULL_PACE_DEFLECTION = 0.75;
/** Lowest pace that the robot accepts. */
const MIN_PACE_PERCENT = 10;
/** The direction of each button of a gamepad's D-pad, by the browser's number; any other button stops the robot. */
const CROSS_DIRECTIONS: Record<number, Direction> = {
  12: { ahead: 1, left: 0 },
  13: { ahead: -1, left: 0 },
  14: { ahead: 0, left: 1 },
  15: { ahead: 0, left: -1 },
};

/** Least cosine of the angle between a gait's displacement and the direction of steering. */
const MIN_COSINE = 0.8;

/** Least displacement per cycle that counts; a smaller one is a drift. */
const MIN_DISPLACEMENT = { forwardMm: 2, turnDeg: 1 };

/** The direction of each key. */
const KEY_DIRECTIONS: Record<string, Direction> = {
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
 * Returns the command of the best gait for a direction; null if none fits. Distances and turns are compared as shares
 * of the largest among the gaits; of gaits with the same direction, the one that moves farthest is taken.
 */
export function gaitFor({ ahead, left }: Direction, choices: PredictedGait[]): string | null {
  const deflection = Math.hypot(ahead, left);
  if (deflection < DEAD_ZONE) return null;
  const largestOf = (componentOf: (displacement: Displacement) => number | null) => Math.max(...choices.map(({ displacement }) => Math.abs(componentOf(displacement) ?? 0)), 0);
  const [largestForward, largestTurn] = [largestOf(({ forward }) => forward), largestOf(({ turn }) => turn)];
  // A drift counts as zero, even if no gait that turns is predicted yet and the drift would be the largest turn.
  const shareOf = (value: number | null, smallest: number, largest: number) => (value !== null && Math.abs(value) >= smallest ? value / largest : 0);
  let best: { command: string; score: number } | null = null;
  for (const { command, displacement } of choices) {
    const forwardShare = shareOf(displacement.forward, MIN_DISPLACEMENT.forwardMm, largestForward);
    const turnShare = shareOf(displacement.turn, MIN_DISPLACEMENT.turnDeg, largestTurn);
    if (forwardShare === 0 && turnShare === 0) continue;
    const length = Math.hypot(forwardShare, turnShare);
    const cosine = (forwardShare * ahead + turnShare * left) / (length * deflection);
    if (cosine < MIN_COSINE) continue;
    // The direction counts more than the distance, so that a gait in an arc is not taken for straight ahead.
    const score = cosine ** 4 * Math.min(1, length) ** 0.25;
    if (!best || score > best.score) best = { command, score };
  }
  return best?.command ?? null;
}

/** The controls for steering by hand, and the commands that were sent for them. */
export class Steering {
  private readonly heldKeys = new Set<string>();
  private readonly stick = element('stick');
  private readonly knob = element('knob');
  private stickDirection: Direction = { ahead: 0, left: 0 };
  private padDirection: Direction = { ahead: 0, left: 0 };
  /** True once the gamepads' sticks are let go after a release; a stick that is still held does not steer. */
  private isPadReleased = true;
  /** True while a gamepad's button that stops the robot is pressed. */
  private isButtonPressed = false;
  /** The element that the pointer pressed last, until Tab moves the focus. */
  private pressedElement: EventTarget | null = null;
  /** True while another window has the keyboard. */
  private isWindowInactive = false;
  /** The command of the gait that was sent last; null while nothing is held. */
  private sentGait: string | null = null;
  /** The pace to restore, in percent, while a stick asks for half of it; null otherwise. */
  private fullPace: number | null = null;

  /** `isDrivingForbidden` returns true while the robot must not be driven. */
  constructor(
    private readonly session: Session,
    private readonly predictor: Predictor,
    private readonly isDrivingForbidden: () => boolean,
  ) {
    // The keys are handled in the capture phase, before a slider or a view handles an arrow key.
    document.addEventListener('keydown', (event) => this.handleKey(event, true), true);
    document.addEventListener('pointerdown', ({ target }) => (this.pressedElement = target), true);
    document.addEventListener('keyup', (event) => this.handleKey(event, false));
    // A user in another window does not see the robot.
    addEventListener('blur', () => {
      this.isWindowInactive = true;
      this.release();
    });
    for (const eventName of ['focus', 'pointerdown', 'keydown']) addEventListener(eventName, () => (this.isWindowInactive = false), true);
    document.addEventListener('visibilitychange', () => document.hidden && this.release());
    this.stick.addEventListener('pointerdown', (event) => {
      this.stick.setPointerCapture(event.pointerId);
      this.moveStick(event);
    });
    this.stick.addEventListener('pointermove', (event) => this.stick.hasPointerCapture(event.pointerId) && this.moveStick(event));
    for (const eventName of ['pointerup', 'pointercancel'] as const) this.stick.addEventListener(eventName, () => this.moveStick(null));
  }

  /** Reads the gamepads; called for every frame of the page. */
  readGamepads(): void {
    const pads = (navigator.getGamepads?.() ?? []).filter((pad) => pad !== null);
    const direction = { ahead: 0, left: 0 };
    let isButtonPressed = false;
    for (const { axes, buttons } of pads) {
      direction.ahead -= axes[1] ?? 0;
      direction.left -= axes[0] ?? 0;
      buttons.forEach(({ pressed }, index) => {
        if (!pressed) return;
        isButtonPressed ||= !(index in CROSS_DIRECTIONS);
        direction.ahead += CROSS_DIRECTIONS[index]?.ahead ?? 0;
        direction.left += CROSS_DIRECTIONS[index]?.left ?? 0;
      });
    }
    if (isButtonPressed && !this.isButtonPressed) {
      void this.session.drive(WORDS.stop);
      this.release(false);
    }
    this.isButtonPressed = isButtonPressed;
    if (this.sentGait && this.isDrivingForbidden()) this.release();
    this.isPadReleased ||= Math.hypot(direction.ahead, direction.left) < DEAD_ZONE;
    if (!this.isPadReleased || this.isWindowInactive || (direction.ahead === this.padDirection.ahead && direction.left === this.padDirection.left)) return;
    this.padDirection = direction;
    this.applyDirection();
  }

  /** Releases everything that is held; if `stopsRobot`, also stops the robot if it walks because of that. */
  release(stopsRobot = true): void {
    this.heldKeys.clear();
    this.padDirection = { ahead: 0, left: 0 };
    this.isPadReleased = false;
    if (!stopsRobot) this.sentGait = null;
    this.moveStick(null);
  }

  /** Takes a key that is pressed (`isDown`) or released. */
  private handleKey(event: KeyboardEvent, isDown: boolean): void {
    if (event.key === 'Tab') this.pressedElement = null;
    if (!(event.code in KEY_DIRECTIONS)) return;
    if (!isDown) {
      if (this.heldKeys.delete(event.code)) this.applyDirection();
      return;
    }
    const { target } = event;
    // Text inputs and the setup keep these keys for themselves; so does a slider, a list or a view that was reached
    // with Tab.
    const textFields = 'textarea, [type="text"], [type="number"], #setup';
    const isTaken = target instanceof Element && target.closest(target === this.pressedElement ? textFields : `${textFields}, input, select, canvas, [role="log"]`) !== null;
    if (isTaken || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    if (event.repeat) return;
    this.heldKeys.add(event.code);
    this.applyDirection();
  }

  /** Moves the stick on the screen to the pointer; null lets it go. */
  private moveStick(event: PointerEvent | null): void {
    const { left, top, width, height } = this.stick.getBoundingClientRect();
    const radius = Math.min(width, height) / 2 || 1;
    let [x, y] = event ? [(event.clientX - left - width / 2) / radius, (event.clientY - top - height / 2) / radius] : [0, 0];
    const divisor = Math.max(1, Math.hypot(x, y));
    [x, y] = [x / divisor, y / divisor];
    this.stickDirection = { ahead: -y, left: -x };
    this.knob.style.translate = `${x * radius * 0.6}px ${y * radius * 0.6}px`;
    this.applyDirection();
  }

  /** Sends the gait and the pace for everything that is held now, if they have changed. */
  private applyDirection(): void {
    const direction = { ahead: this.stickDirection.ahead + this.padDirection.ahead, left: this.stickDirection.left + this.padDirection.left };
    for (const code of this.heldKeys) {
      direction.ahead += KEY_DIRECTIONS[code]?.ahead ?? 0;
      direction.left += KEY_DIRECTIONS[code]?.left ?? 0;
    }
    const deflection = Math.hypot(direction.ahead, direction.left);
    const isIdle = this.isDrivingForbidden() || deflection < DEAD_ZONE;
    const isHalfPace = !isIdle && deflection < (this.fullPace === null ? HALF_PACE_DEFLECTION : FULL_PACE_DEFLECTION);
    if (isHalfPace && this.fullPace === null) {
      this.fullPace = this.session.pace;
      void this.session.drive(`${WORDS.speed} ${Math.max(MIN_PACE_PERCENT, Math.round(this.fullPace / 2))}`);
    }
    const gait = isIdle ? null : gaitFor(direction, this.predictor.gaits);
    // If no gait has this direction, the current one goes on.
    if (gait !== this.sentGait && (isIdle || gait !== null)) {
      this.sentGait = gait;
      void this.session.drive(gait ?? WORDS.stop);
    }
    if (!isHalfPace && this.fullPace !== null) {
      void this.session.drive(`${WORDS.speed} ${this.fullPace}`);
      this.fullPace = null;
    }
  }
}
