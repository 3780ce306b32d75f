// Lengths that were tried: their text, the reason of a refusal, and buttons for valid alternatives.
import type { Edits, Length, Refused, TriedLengths } from '../robot';
import type { Session } from '../session';
import { element } from './canvas';
import { button } from './make';

/** Returns the edit of a length and, if `isSymmetric`, the same edit of its twin. */
export function withTwin(key: string, value: number, lengths: Length[], isSymmetric: boolean): Edits {
  const twin = lengths.find((length) => length.key === key)?.twin ?? key;
  return [...new Set(isSymmetric ? [key, twin] : [key])].map((each) => [each, value]);
}

/** Lists lengths as a text, grouped by value, such as `l1 = l4 = 30 mm`. */
export function words(edits: Edits, lengths: Length[]): string {
  const by = new Map<number, string[]>();
  for (const [key, value] of edits) by.set(value, [...(by.get(value) ?? []), key]);
  const unit = (key = '') => lengths.find((length) => length.key === key)?.unit ?? 'mm';
  return [...by].map(([value, keys]) => `${keys.map((key) => key.replace('links.', '')).join(' = ')} = ${value} ${unit(keys[0])}`).join(', ');
}

/** Describes why lengths are refused, beginning with the consequence for the robot; `named` are the user's lengths in words. */
export function refusalOf(named: string, edits: Edits, { refused, meaning, key }: Refused, lengths: Length[]): string {
  const known = new Map(lengths.map((length) => [length.key, length]));
  const ways = edits.map(([each, value]) => value - (known.get(each)?.value ?? value));
  const [more, less] = edits.every(([each]) => known.get(each)?.unit === 'deg') ? ['large', 'small'] : ['long', 'short'];
  const how = ways.every((way) => way >= 0) ? `too ${more}` : ways.every((way) => way <= 0) ? `too ${less}` : 'not possible';
  // Without a meaning the message has the key as its subject.
  const why = meaning ?? refused.slice(Math.max(0, refused.indexOf(key))).replace(key, known.get(key)?.label ?? key);
  return `${named} is ${how}: ${why}.`;
}

/** Shows a button for each valid alternative to refused lengths; removes the buttons for null. */
export function showOffers(tried: Pick<TriedLengths, 'nearest' | 'without'> | null, session: Session): void {
  const { nearest = null, without = null } = tried ?? {};
  const change = (text: string) => () => void session.change(text);
  element('lengths-instead').replaceChildren(
    ...(nearest ? [button(`Try ${words(nearest.lengths, session.description.lengths).replace(/^[^,]* = ([^,]*)$/, '$1')}`, change(nearest.text))] : []),
    ...(without ? [button(`Drop “${without.gait.replaceAll('-', ' ')}”`, change(without.text))] : []),
  );
}
