// Manual steering: keys, the stick on the screen or a gamepad give a direction, and the robot walks the gait for this
// direction while the user holds the control.
import type { PredictedGait, Predictor } from '../predictor';
import type { Displacement } from '../robot';
import type { Session } from '../session';
import { WORDS } from '../words';
import { element } from './elements';

/** A steering direction; `forward` and `left` are from -1 to 1. */
export interface Direction {
  forward: number;
  left: number;
}

/** Dead zone of a stick, as a fraction of its full deflection. */
const DEAD_ZONE = 0.35;
/** Deflection of a stick below which the robot walks at half its pace, as a fraction of the full deflection. */
const HALF_PACE_DEFLECTION = 0.65;
/** Deflection of a stick above which the robot returns to its full pace; the hysteresis prevents flutter. */
const FULL_PACE_DEFLECTION = 0.75;
/** Lowest pace that the robot accepts. */
const MIN_PACE_PERCENT = 10;

const IDLE: Direction = { forward: 0, left: 0 };
const AHEAD: Direction = { forward: 1, left: 0 };
const BACK: Direction = { forward: -1, left: 0 };
const LEFT: Direction = { forward: 0, left: 1 };
const RIGHT: Direction = { forward: 0, left: -1 };
/** The direction of each D-pad button of a gamepad, by its index in the browser; all other buttons stop the robot. */
const D_PAD_DIRECTIONS: Record<number, Direction> = { 12: AHEAD, 13: BACK, 14: LEFT, 15: RIGHT };

/** Smallest cosine of the angle between a gait's displacement and the steering direction. */
const MIN_COSINE = 0.8;

/** Smallest displacement per cycle that counts; smaller displacements are drift. */
const MIN_DISPLACEMENT = { forwardMm: 2, turnDeg: 1 };

/** The direction of each key, by code. */
const KEY_DIRECTIONS: Record<string, Direction> = {
  ArrowUp: AHEAD, ArrowDown: BACK, ArrowLeft: LEFT, ArrowRight: RIGHT,
  KeyW: AHEAD, KeyS: BACK, KeyA: LEFT, KeyD: RIGHT,
};

/** Returns the sum of directions. */
const addDirections = (directions: Direction[]) =>
  directions.reduce((a, b) => ({ forward: a.forward + b.forward, left: a.left + b.left }), IDLE);

/**
 * Returns the command of the best gait for a direction; null if no gait fits. Distances and turns are compared as
 * fractions of the largest values among the gaits. Among gaits with the same direction, the farthest movement is best.
 */
export function chooseGait({ forward, left }: Direction, gaits: PredictedGait[]): string | null {
  const deflection = Math.hypot(forward, left);
  if (deflection < DEAD_ZONE) return null;
  const findMax = (getComponent: (displacement: Displacement) => number | null) => Math.max(...gaits.map(({ displacement }) => Math.abs(getComponent(displacement) ?? 0)), 0);
  const [maxForward, maxTurn] = [findMax(({ forward }) => forward), findMax(({ turn }) => turn)];
  // Drift counts as zero, even if no turning gait is predicted yet and the drift would be the largest turn.
  const toFraction = (value: number | null, min: number, max: number) => (value !== null && Math.abs(value) >= min ? value / max : 0);
  let best: { command: string; score: number } | null = null;
  for (const { command, displacement } of gaits) {
    const forwardFraction = toFraction(displacement.forward, MIN_DISPLACEMENT.forwardMm, maxForward);
    const turnFraction = toFraction(displacement.turn, MIN_DISPLACEMENT.turnDeg, maxTurn);
    if (forwardFraction === 0 && turnFraction === 0) continue;
    const length = Math.hypot(forwardFraction, turnFraction);
    const cosine = (forwardFraction * forward + turnFraction * left) / (length * deflection);
    if (cosine < MIN_COSINE) continue;
    // The direction counts more than the distance, so that an arc is not preferred to a straight gait.
    const score = cosine ** 4 * Math.min(1, length) ** 0.25;
    if (!best || score > best.score) best = { command, score };
  }
  return best?.command ?? null;
}

/** The controls for manual steering, and the commands that they have sent. */
export class Steering {
  private readonly heldKeys = new Set<string>();
  private readonly stick = element('stick');
  private stickDirection = IDLE;
  private gamepadDirection = IDLE;
  /** True once the gamepads' sticks are in the dead zone after `release`; until then, a held stick does not steer. */
  private isGamepadReleased = true;
  /** True while a gamepad's stop button is pressed. */
  private isStopButtonPressed = false;
  /** The element that the pointer pressed last; null once Tab has moved the focus. */
  private pressedElement: EventTarget | null = null;
  /** True while another window has the keyboard focus. */
  private isWindowInactive = false;
  /** The last sent gait command; null while no control is held. */
  private sentGait: string | null = null;
  /** The pace to restore, percent, while a stick halves the pace; null otherwise. */
  private fullPace: number | null = null;

  /** `isDrivingForbidden` returns true while the robot must not be driven. */
  constructor(
    private readonly session: Session,
    private readonly predictor: Predictor,
    private readonly isDrivingForbidden: () => boolean,
  ) {
    // Keys are handled in the capture phase, before a slider or a view can handle an arrow key.
    document.addEventListener('keydown', (event) => this.handleKey(event, true), true);
    document.addEventListener('pointerdown', ({ target }) => (this.pressedElement = target), true);
    document.addEventListener('keyup', (event) => this.handleKey(event, false));
    // The user of another window does not see the robot.
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

  /** Reads the gamepads; called in every animation frame. */
  readGamepads(): void {
    const gamepads = (navigator.getGamepads?.() ?? []).filter((gamepad) => gamepad !== null);
    const findPressed = ({ buttons }: Gamepad) =>
      [...buttons.keys()].filter((index) => buttons[index].pressed);
    const directions = gamepads.flatMap((gamepad) => {
      const [x = 0, y = 0] = gamepad.axes;
      const dPad = findPressed(gamepad).flatMap((index) => D_PAD_DIRECTIONS[index] ?? []);
      return [{ forward: -y, left: -x }, ...dPad];
    });
    const direction = addDirections(directions);
    const pressedButtons = gamepads.flatMap(findPressed);
    const isStopButtonPressed = pressedButtons.some((index) => !(index in D_PAD_DIRECTIONS));
    if (isStopButtonPressed && !this.isStopButtonPressed) {
      void this.session.board.drive(WORDS.stop);
      this.release(false);
    }
    this.isStopButtonPressed = isStopButtonPressed;
    if (this.sentGait && this.isDrivingForbidden()) this.release();
    this.isGamepadReleased ||= Math.hypot(direction.forward, direction.left) < DEAD_ZONE;
    if (!this.isGamepadReleased || this.isWindowInactive || (direction.forward === this.gamepadDirection.forward && direction.left === this.gamepadDirection.left)) return;
    this.gamepadDirection = direction;
    this.applyDirection();
  }

  /** Releases all controls; if `stopsRobot`, also stops a robot that they drive. */
  release(stopsRobot = true): void {
    this.heldKeys.clear();
    this.gamepadDirection = IDLE;
    this.isGamepadReleased = false;
    if (!stopsRobot) this.sentGait = null;
    this.moveStick(null);
  }

  /** Handles a key that was pressed (`isDown`) or released. */
  private handleKey(event: KeyboardEvent, isDown: boolean): void {
    if (event.key === 'Tab') this.pressedElement = null;
    if (!(event.code in KEY_DIRECTIONS)) return;
    if (!isDown) {
      if (this.heldKeys.delete(event.code)) this.applyDirection();
      return;
    }
    const { target } = event;
    // Text inputs and the setup handle these keys themselves; so do sliders, lists and views with focus by Tab.
    const textFields = 'textarea, [type="text"], [type="number"], #setup';
    const isHandledByTarget = target instanceof Element && target.closest(target === this.pressedElement ? textFields : `${textFields}, input, select, canvas, [role="log"]`) !== null;
    if (isHandledByTarget || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    if (event.repeat) return;
    this.heldKeys.add(event.code);
    this.applyDirection();
  }

  /** Moves the stick on the screen to the pointer; null releases it. */
  private moveStick(event: PointerEvent | null): void {
    const { left, top, width, height } = this.stick.getBoundingClientRect();
    const radius = Math.min(width, height) / 2 || 1;
    let [x, y] = event ? [(event.clientX - left - width / 2) / radius, (event.clientY - top - height / 2) / radius] : [0, 0];
    const divisor = Math.max(1, Math.hypot(x, y));
    [x, y] = [x / divisor, y / divisor];
    this.stickDirection = { forward: -y, left: -x };
    element('knob').style.translate = `${x * radius * 0.6}px ${y * radius * 0.6}px`;
    this.applyDirection();
  }

  /** Sends the gait and the pace for all held controls, if these have changed. */
  private applyDirection(): void {
    const keyDirections = Array.from(this.heldKeys, (code) => KEY_DIRECTIONS[code]);
    const direction = addDirections([this.stickDirection, this.gamepadDirection, ...keyDirections]);
    const deflection = Math.hypot(direction.forward, direction.left);
    const isIdle = this.isDrivingForbidden() || deflection < DEAD_ZONE;
    const isHalfPace = !isIdle && deflection < (this.fullPace === null ? HALF_PACE_DEFLECTION : FULL_PACE_DEFLECTION);
    if (isHalfPace && this.fullPace === null) {
      this.fullPace = this.session.board.pace;
      void this.session.board.drive(`${WORDS.speed} ${Math.max(MIN_PACE_PERCENT, Math.round(this.fullPace / 2))}`);
    }
    const gait = isIdle ? null : chooseGait(direction, this.predictor.gaits);
    // If no gait has this direction, the current gait continues.
    if (gait !== this.sentGait && (isIdle || gait !== null)) {
      this.sentGait = gait;
      void this.session.board.drive(gait ?? WORDS.stop);
    }
    if (!isHalfPace && this.fullPace !== null) {
      void this.session.board.drive(`${WORDS.speed} ${this.fullPace}`);
      this.fullPace = null;
    }
  }
}
