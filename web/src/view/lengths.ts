// The number inputs of the robot's lengths. Each change makes a new robot or is refused.
import { type Edits, type Length, Robot } from '../robot';
import type { Session } from '../session';
import { downloadRobot } from './download';
import { element, make, showMessage } from './elements';
import { setInvalid } from './number-input';
import { describeRefusal, makeEditsWithTwin, showOffers } from './tried-lengths';

/** Sets the inputs up; `offerValidLengths` searches for valid alternatives to refused lengths and offers them. */
export function setUpLengths(session: Session, offerValidLengths: (edits: Edits) => void): void {
  const symmetryBox = element<HTMLInputElement>('alike');
  const inputs = new Map<string, HTMLInputElement>();
  const replaceOffersWithMessage = (message: string) => {
    showMessage(element('lengths-refusal'), message);
    showOffers(null, session);
  };
  /** Shows lengths of the robot in their inputs, and marks these inputs as invalid or valid. */
  const fillInputs = (lengths: Length[], { isInvalid }: { isInvalid: boolean }) => {
    for (const { key, value } of lengths) {
      const input = inputs.get(key);
      if (!input) continue;
      input.value = String(value);
      setInvalid(input, isInvalid);
    }
  };
  const changeLength = async (key: string, value: number) => {
    const { lengths } = session.robot.description;
    // An emptied input returns to the robot's length.
    if (!Number.isFinite(value)) return fillInputs(lengths, { isInvalid: false });
    const edits = makeEditsWithTwin(key, value, lengths, symmetryBox.checked);
    const { text: changedToml, refusal } = Robot.tryLengths(session.robot.toml, edits, false);
    if (!refusal) return void (await session.robot.change(changedToml));
    const refusedLengths = lengths.filter((length) => edits.some(([editedKey]) => editedKey === length.key));
    // The inputs return to the robot's lengths.
    fillInputs(refusedLengths, { isInvalid: true });
    replaceOffersWithMessage(describeRefusal(`${value} ${refusedLengths[0]?.unit}`, edits, refusal, lengths));
    offerValidLengths(edits);
  };
  const buildInputs = (lengths: Length[]) => {
    element('lengths').replaceChildren();
    inputs.clear();
    for (const { key, label, unit } of lengths) {
      const input = make('input', { type: 'number', step: '0.5', name: key, onchange: () => void changeLength(key, input.valueAsNumber) });
      element('lengths').append(make('label', {}, `${label} (${key.replace('links.', '')}, ${unit})`, input));
      inputs.set(key, input);
    }
  };
  element('lengths-reset').addEventListener('click', () => void session.robot.change(session.robot.original));
  element('lengths-save').addEventListener('click', () => {
    const refusal = downloadRobot(session.robot.toml, session.robot.floor);
    if (refusal) replaceOffersWithMessage(`This robot.toml does not have the settings of Legs, feet and floor: ${refusal.reason}`);
  });
  session.robot.follow(({ lengths }) => {
    if (lengths.length !== inputs.size) buildInputs(lengths);
    fillInputs(lengths, { isInvalid: false });
    replaceOffersWithMessage('');
  });
}
