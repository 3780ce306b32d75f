// The robots that can be chosen: those that say that they are for the tests come last, under that name.
import { files, isForTests } from '../files';
import { element } from './canvas';

export class Choice {
  private readonly list = element<HTMLSelectElement>('robot');

  private constructor(
    private readonly robots: string[],
    forTests: boolean[],
  ) {
    const tests = document.createElement('optgroup');
    tests.label = 'for tests';
    robots.forEach((name, n) => {
      const option = new Option(`${name}.toml`, name);
      if (forTests[n]) tests.append(option);
      else this.list.add(option);
    });
    if (tests.childElementCount > 0) this.list.append(tests);
  }

  /** Lists what `make web` has put beside the page. Throws a sentence if that is not there. */
  static async load(): Promise<Choice> {
    const robots = await files.robots();
    // One that cannot be read says so when it is chosen.
    const tomls = await Promise.all(robots.map((name) => files.toml(name).catch(() => '')));
    return new Choice(robots, tomls.map(isForTests));
  }

  /** Calls back when a person has chosen. */
  onChange(chosen: () => void): void {
    this.list.addEventListener('change', chosen);
  }

  /** What is chosen. */
  get robot(): string {
    return this.robots.find((name) => name === this.list.value) ?? this.robots[0];
  }

  /** Shows another one, by the name of its file; whether it is there. */
  show(name: string): boolean {
    const isThere = this.robots.includes(name);
    if (isThere) this.list.value = name;
    return isThere;
  }

  /** Whether a person may choose. */
  set enabled(may: boolean) {
    this.list.disabled = !may;
  }
}
