// Lengths that the user has tried: their text, the reason for a refusal, and buttons with valid alternatives.
import type { Edits, Length, Refusal, TriedLengths } from '../robot';
import type { Session } from '../session';
import { button, element } from './elements';

/** Makes the edit of a length and, if `isSymmetric`, the same edit of its twin on the opposite side. */
export function makeEditsWithTwin(key: string, value: number, lengths: Length[], isSymmetric: boolean): Edits {
  const twin = lengths.find((length) => length.key === key)?.twin ?? key;
  return [...new Set(isSymmetric ? [key, twin] : [key])].map((editedKey) => [editedKey, value]);
}

/** Formats lengths grouped by their values, such as `l1 = l4 = 30 mm`. */
export function formatLengths(edits: Edits, lengths: Length[]): string {
  const keysByValue = new Map<number, string[]>();
  for (const [key, value] of edits) keysByValue.set(value, [...(keysByValue.get(value) ?? []), key]);
  const findUnit = (key = '') => lengths.find((length) => length.key === key)?.unit ?? 'mm';
  return [...keysByValue].map(([value, keys]) => `${keys.map((key) => key.replace('links.', '')).join(' = ')} = ${value} ${findUnit(keys[0])}`).join(', ');
}

/**
 * Returns a message with the reason for refusing lengths; `lengthsText` names these lengths, and `lengths` are the
 * current robot's lengths.
 */
export function describeRefusal(lengthsText: string, edits: Edits, { reason, consequence, key }: Refusal, lengths: Length[]): string {
  const lengthByKey = new Map(lengths.map((length) => [length.key, length]));
  const changes = edits.map(([editedKey, value]) => value - (lengthByKey.get(editedKey)?.value ?? value));
  const [more, less] = edits.every(([editedKey]) => lengthByKey.get(editedKey)?.unit === 'deg') ? ['large', 'small'] : ['long', 'short'];
  const judgement = changes.every((change) => change >= 0) ? `too ${more}` : changes.every((change) => change <= 0) ? `too ${less}` : 'not possible';
  // The message of a refusal without a consequence starts with the key.
  const cause = consequence ?? reason.slice(Math.max(0, reason.indexOf(key))).replace(key, lengthByKey.get(key)?.label ?? key);
  return `${lengthsText} is ${judgement}: ${cause}.`;
}

/** Shows a button for each valid alternative to refused lengths; null removes the buttons. */
export function showOffers(alternatives: Pick<TriedLengths, 'nearest' | 'without'> | null, session: Session): void {
  const { nearest = null, without = null } = alternatives ?? {};
  const changeTo = (text: string) => () => void session.robot.change(text);
  element('lengths-alternatives').replaceChildren(
    ...(nearest ? [button(`Try ${formatLengths(nearest.lengths, session.robot.description.lengths).replace(/^[^,]* = ([^,]*)$/, '$1')}`, changeTo(nearest.text))] : []),
    ...(without ? [button(`Drop “${without.gait.replaceAll('-', ' ')}”`, changeTo(without.text))] : []),
  );
}
