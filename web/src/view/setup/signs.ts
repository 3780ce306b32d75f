// The signs: a servo whose sign is wrong stands on the other side of its neutral angle, and the guard would take
// an unsafe pose for a safe one.
import { nameOf } from './drawing';
import { button, note, row, words } from './parts';
import type { Step, Tools } from './step';

/** By how much the servo of the step has been turned, deg; null before. */
let moved: { servo: number; by: number } | null = null;
/** What a person may have seen that no answer mends. */
let advice: 'other' | 'none' | null = null;

const doneWord = (servo: number) => `sign ${servo}`;

/** The servos whose signs nobody has proven. */
export const unproven = (tools: Tools): number[] => [0, 1, 2, 3].filter((servo) => !tools.isDone(doneWord(servo)));

function turn(tools: Tools): void {
  const { servo } = tools;
  advice = null;
  tools.run(async (guide) => {
    moved = { servo, by: await guide.prove(servo) };
    return `A${servo + 1} was told to turn ${Math.abs(moved.by)}° ${moved.by > 0 ? 'counter-clockwise' : 'clockwise'}.`;
  });
}

export const signs: Step = {
  name: 'Signs',
  title: 'Prove the signs',
  needsRobot: true,
  drawing: ({ servo }) => ({ servo, by: moved?.servo === servo ? moved.by : 10 }),
  parts(tools) {
    const { servo } = tools;
    const wasMoved = moved?.servo === servo;
    const next = () => {
      tools.done(doneWord(servo));
      moved = advice = null;
      const [first] = unproven(tools);
      if (first === undefined) {
        tools.done('Signs');
        tools.run(async (guide) => {
          await guide.stand();
          return 'All four turn the right way.';
        });
        return tools.go('Trims');
      }
      tools.servo = first;
      tools.show();
    };
    const parts: Node[] = [
      words(`${nameOf(servo)}: one servo alone turns by 10°. Look from above.`),
      row(button(wasMoved ? `Turn A${servo + 1} once more` : `Turn A${servo + 1}`, () => turn(tools), !wasMoved)),
    ];
    if (wasMoved) {
      const reverse = () =>
        tools.run(async (guide) => {
          await guide.reverse(servo);
          moved = null;
          return `The sign of A${servo + 1} is "${guide.has.servos[servo].dir}" now. Turn it once more and look.`;
        });
      const say = (what: 'other' | 'none') => () => {
        advice = what;
        tools.show();
      };
      parts.push(
        words('Did it turn as the arrow shows?'),
        row(button('Yes', next, true), button('No, the other way', reverse), button('Another servo turned', say('other')), button('Nothing turned', say('none'))),
      );
      const pin = tools.session.description.servos[servo].pin;
      if (advice === 'other') parts.push(words(`Two signal wires are exchanged. Switch the servos' supply off and put the signal of the servo at the ${nameOf(servo).slice(4)} on pin D${pin}. Then turn it once more.`));
      if (advice === 'none') parts.push(words(`Has its supply power, and are its ground and the UNO's joined? Is its plug the right way round, the signal (orange) on pin D${pin}? Then turn it once more.`));
    }
    parts.push(note('Do not leave this step out: the robot would take an unsafe pose for a safe one.'));
    return parts;
  },
};

/** Begins anew, for another robot. */
export function forgetSigns(): void {
  moved = advice = null;
}
