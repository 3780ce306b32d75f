// The list of robots: the user's own robots, the page's robots, and, under a heading, the robots for tests.
import { element, make } from './elements';

export class RobotChoice {
  readonly list = element<HTMLSelectElement>('robot');
  private readonly ownGroup = make('optgroup', { label: 'your own' });
  private readonly robots: string[];

  /** Lists `all` of the page's robots; those for `tests` are under a heading. */
  constructor({ all, tests }: { all: string[]; tests: string[] }) {
    this.robots = all;
    const testGroup = make('optgroup', { label: 'for tests' });
    for (const name of all) {
      const option = new Option(`${name}.toml`, name);
      if (tests.includes(name)) testGroup.append(option);
      else this.list.add(option);
    }
    if (testGroup.childElementCount > 0) this.list.append(testGroup);
  }

  /** Lists the names of the user's own robots. */
  showOwn(names: string[]): void {
    this.ownGroup.replaceChildren(...names.map((name) => new Option(name, '')));
    if (names.length > 0) this.list.prepend(this.ownGroup);
    else this.ownGroup.remove();
  }

  /** The index of the chosen robot among the user's own robots; null if a file is chosen. */
  get chosenOwnIndex(): number | null {
    const index = [...this.ownGroup.children].indexOf(this.list.selectedOptions[0]);
    return index < 0 ? null : index;
  }

  /** The file name of the chosen robot; the first file name if one of the user's own robots is chosen. */
  get chosenFile(): string {
    return this.robots.find((name) => name === this.list.value) ?? this.robots[0];
  }

  /** Selects a robot by its file name; returns true if the list has this name. */
  select(name: string): boolean {
    const isListed = this.robots.includes(name);
    if (isListed) this.list.value = name;
    return isListed;
  }
}
