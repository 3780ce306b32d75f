// The scale: not every servo turns a degree for 10 us of pulse.
import { nameOf } from './drawing';
import { button, note, number, row, words } from './parts';
import type { Step } from './step';

/** By how much a servo was turned, deg; null before. */
let turned: { servo: number; by: number } | null = null;

export const scale: Step = {
  name: 'Scale',
  title: 'Measure how far they turn',
  needsRobot: true,
  drawing: ({ servo }) => ({ servo, by: turned?.servo === servo ? turned.by : 20 }),
  parts({ guide, servo, run, done }) {
    const has = guide?.has.servos[servo].scale;
    const span = () =>
      run(async (guide) => {
        turned = { servo, by: await guide.span(servo) };
        return `A${servo + 1} was told to turn ${Math.abs(turned.by)}°. Measure it.`;
      });
    const isTurned = turned?.servo === servo;
    const measured = (degrees: number) =>
      run(async (guide) => {
        if (!turned || degrees <= 0) return 'Give how far it turned, in degrees, more than 0.';
        const asked = turned.by;
        turned = null;
        const now = await guide.scale(servo, asked, degrees);
        done('Scale');
        return `The scale of A${servo + 1} is ${now.toFixed(2)} µs per degree.`;
      });
    return [
      words(`Mark where the crank of ${nameOf(servo)} points, turn it, and measure how far it went.`),
      row(button(`Turn A${servo + 1} by 20°`, span, !isTurned)),
      ...(isTurned ? [row(number('It turned by, degrees', null, '0.1', measured))] : []),
      words(`Scale: ${has === undefined ? '–' : `${has.toFixed(2)} µs per degree`}`),
      note('Most servos are near 10. Without a protractor, leave this step out.'),
    ];
  },
};

/** Begins anew, for another robot. */
export function forgetScale(): void {
  turned = null;
}
