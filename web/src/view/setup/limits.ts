// The limits: how far a servo may go before a part of the print touches another.
import { angle } from '../../setup/calibration';
import { nameOf } from './drawing';
import { button, note, number, row, words } from './parts';
import type { Step } from './step';

/** Where a servo was turned to, deg; null while it stands. */
let at: { servo: number; degrees: number } | null = null;
const BY = 5;

export const limits: Step = {
  name: 'Limits',
  title: 'Limit their travel',
  needsRobot: true,
  drawing: ({ servo }) => ({ servo, by: null }),
  parts({ guide, servo, run, done, session }) {
    const limit = guide?.has.servos[servo].limit ?? null;
    const { neutral } = session.description.servos[servo];
    const place = at?.servo === servo ? at.degrees : neutral;
    const turn = (by: number) => () =>
      run(async (guide) => {
        await guide.point(servo, place + by);
        at = { servo, degrees: place + by };
        return `A${servo + 1} points to ${angle(place + by).toFixed(2)}°.`;
      });
    const set = (from: number, to: number) =>
      run(async (guide) => {
        await guide.limit(servo, from, to);
        done('Limits');
        return `A${servo + 1} goes from ${angle(from).toFixed(2)}° to ${angle(to).toFixed(2)}°.`;
      });
    const [from, to] = limit ?? [0, 0];
    return [
      words(`Turn ${nameOf(servo)} until a part of your print is about to touch another, and let it go no further. Where nothing touches, there is nothing to do.`),
      row(button(`↺ ${BY}°`, turn(BY)), button(`↻ ${BY}°`, turn(-BY)), button('Stand', () => run(async (guide) => {
        await guide.stand();
        at = null;
        return 'The robot stands.';
      }))),
      row(button('Not further ↺ than here', () => set(from, place)), button('Not further ↻ than here', () => set(place, to))),
      ...(limit ? [row(number('From, degrees', from, '0.01', (value) => set(value, to)), number('to, degrees', to, '0.01', (value) => set(from, value)))] : []),
      note('A limit goes counter-clockwise from its first angle to its second. One with which a gait could not be walked is refused.'),
    ];
  },
};

/** Begins anew, for another robot. */
export function forgetLimits(): void {
  at = null;
}
