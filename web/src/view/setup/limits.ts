// The step Limits: limits each servo's travel where printed parts would touch each other.
import { nameOf, type SelectedServo } from './drawing';
import { button, note, number, row, words } from '../make';
import type { Step, Tools } from './step';

/** Turn of the servo per press of a button, deg. */
const STEP_DEG = 5;

export class Limits implements Step {
  readonly name = 'Limits';
  readonly title = 'Limit their travel';
  readonly needsRobot = true;
  readonly isByServo = true;
  /** The servo turned last, and its angle in deg; null while the robot stands. */
  private at: { servo: number; degrees: number } | null = null;

  forget(): void {
    this.at = null;
  }

  drawing({ servo }: Tools): SelectedServo {
    return { servo, by: null };
  }

  parts(tools: Tools): Node[] {
    const { guide, servo, session } = tools;
    const limit = guide?.calibration.servos[servo].limit ?? null;
    const currentAngle = this.at?.servo === servo ? this.at.degrees : session.description.servos[servo].neutral;
    const [from, to] = limit ?? [0, 0];
    const makeBox = (label: string, value: number, act: (value: number) => void) => number(label, value, '0.01', act);
    return [
      words(`Turn ${nameOf(servo)} until a part of your print is about to touch another, and let it go no further. Where nothing touches, there is nothing to do.`),
      row(
        button(`↺ ${STEP_DEG}°`, () => this.turn(tools, currentAngle + STEP_DEG)),
        button(`↻ ${STEP_DEG}°`, () => this.turn(tools, currentAngle - STEP_DEG)),
        button('Stand', () => this.stand(tools)),
      ),
      ...(limit
        ? [
            row(
              button('Not further ↺ than here', () => this.set(tools, from, currentAngle)),
              button('Not further ↻ than here', () => this.set(tools, currentAngle, to)),
            ),
            row(
              makeBox('From, degrees', from, (value) => this.set(tools, value, to)),
              makeBox('to, degrees', to, (value) => this.set(tools, from, value)),
            ),
          ]
        : []),
      note('A limit goes counter-clockwise from its first angle to its second. One with which a gait could not be walked is refused.'),
    ];
  }

  private turn({ servo, run }: Tools, degrees: number): void {
    run(async (guide) => {
      const angle = await guide.point(servo, degrees);
      this.at = { servo, degrees };
      return `A${servo + 1} points to ${angle.toFixed(2)}°.`;
    });
  }

  private stand({ run }: Tools): void {
    run(async (guide) => {
      await guide.stand();
      this.forget();
      return 'The robot stands.';
    });
  }

  private set({ servo, run, done }: Tools, from: number, to: number): void {
    run(async (guide) => {
      await guide.limit(servo, from, to);
      done(this.name);
      const [min, max] = guide.calibration.servos[servo].limit;
      return `A${servo + 1} goes from ${min.toFixed(2)}° to ${max.toFixed(2)}°.`;
    });
  }
}
