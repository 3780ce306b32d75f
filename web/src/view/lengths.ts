// The robot's lengths as numbers: a change makes a new robot or is refused.
import { isRefused, type Length, type Refused } from '../robot';
import type { Session } from '../session';
import { element } from './canvas';
import { download } from './download';
import { make } from './make';

export class Lengths {
  private readonly list = element('lengths');
  private readonly alike = element<HTMLInputElement>('alike');
  private readonly refusal = element('lengths-refusal');
  private inputs = new Map<string, HTMLInputElement>();

  constructor(private readonly session: () => Session) {
    element('lengths-reset').addEventListener('click', () => void this.session().restore());
    element('lengths-save').addEventListener('click', () => this.download());
  }

  /** Shows the lengths of the session's robot. */
  showRobot(lengths: Length[]): void {
    if (lengths.length !== this.inputs.size) this.build(lengths);
    for (const { key, value } of lengths) {
      const input = this.inputs.get(key);
      if (input) {
        input.value = String(value);
        input.removeAttribute('aria-invalid');
      }
    }
    this.say(null);
  }

  private build(lengths: Length[]): void {
    this.list.replaceChildren();
    this.inputs.clear();
    for (const { key, label, unit } of lengths) {
      const input = make('input', { type: 'number', step: '0.5', name: key });
      this.list.append(make('label', {}, `${label} (${key.replace('links.', '')}, ${unit})`, input));
      input.addEventListener('change', () => void this.change(key));
      this.inputs.set(key, input);
    }
  }

  private async change(key: string): Promise<void> {
    const session = this.session();
    const input = this.inputs.get(key);
    const value = input?.valueAsNumber;
    if (!input || value === undefined || !Number.isFinite(value)) return;
    const twin = session.description.lengths.find((length) => length.key === key)?.twin ?? key;
    const keys = this.alike.checked && twin !== key ? [key, twin] : [key];
    let text = session.toml;
    for (const each of keys) {
      const edited = session.robot.edit(text, each, value);
      if (isRefused(edited)) return this.refuse(keys, value, edited);
      text = edited.text;
    }
    const refused = await session.change(text);
    if (refused) this.refuse(keys, value, refused);
  }

  /** Shows a refusal and restores the robot's number in the box. */
  private refuse(keys: string[], value: number, { refused }: Refused): void {
    const { lengths } = this.session().description;
    const kept = lengths.filter(({ key }) => keys.includes(key));
    for (const { key, value } of kept) {
      const input = this.inputs.get(key);
      if (!input) continue;
      input.value = String(value);
      input.setAttribute('aria-invalid', 'true');
    }
    const stays = kept.map((length) => `${length.key} stays ${length.value} ${length.unit}`).join(', ');
    this.say(`${value} is refused, ${stays}: ${refused}`);
  }

  private download(): void {
    const { robot, toml, floor } = this.session();
    const refused = download(robot, toml, floor);
    if (refused) this.say(`This robot.toml has not what Legs, feet and floor are set to: ${refused.refused}`);
  }

  private say(message: string | null): void {
    this.refusal.hidden = message === null;
    this.refusal.textContent = message ?? '';
  }
}
