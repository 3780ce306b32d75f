// The list of robots: the user's own robots, the page's robots, and, under a heading, the robots for tests.
import { files } from '../files';
import { element } from './elements';

export class RobotChoice {
  private readonly list = element<HTMLSelectElement>('robot');
  private readonly ownGroup = document.createElement('optgroup');

  private constructor(
    private readonly robots: string[],
    testRobots: string[],
  ) {
    const testGroup = document.createElement('optgroup');
    testGroup.label = 'for tests';
    robots.forEach((name) => {
      const option = new Option(`${name}.toml`, name);
      if (testRobots.includes(name)) testGroup.append(option);
      else this.list.add(option);
    });
    if (testGroup.childElementCount > 0) this.list.append(testGroup);
    this.ownGroup.label = 'your own';
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

  /** Loads the list of the page's robots. Throws an error with a message for the user if the list is missing. */
  static async load(): Promise<RobotChoice> {
    const { all, tests } = await files.robots();
    return new RobotChoice(all, tests);
  }

  /** Calls `action` when the user chooses a robot. */
  onChange(action: () => void): void {
    this.list.addEventListener('change', action);
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

  /** True if the user may choose a robot. */
  set isEnabled(isEnabled: boolean) {
    this.list.disabled = !isEnabled;
  }
}
