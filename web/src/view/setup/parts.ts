// Elements of the steps: paragraphs, buttons, number boxes.

type Child = Node | string;

function make<K extends keyof HTMLElementTagNameMap>(tag: K, children: Child[], className = ''): HTMLElementTagNameMap[K] {
  const box = document.createElement(tag);
  box.append(...children);
  if (className !== '') box.className = className;
  return box;
}

export const words = (...children: Child[]): HTMLElement => make('p', children);
export const note = (...children: Child[]): HTMLElement => make('p', children, 'note');
export const warning = (text: string): HTMLElement => make('p', [text], 'refusal');
export const row = (...children: Child[]): HTMLElement => make('p', children, 'actions');
export const list = (...items: Child[]): HTMLElement => make('ul', items.map((item) => make('li', [item])));

export function button(label: string, act: () => void, isMain = false): HTMLButtonElement {
  const box = make('button', [label], isMain ? 'main' : '');
  box.type = 'button';
  box.addEventListener('click', act);
  return box;
}

/** Makes a number box; `act` gets the number that the user enters. */
export function number(label: string, value: number | null, step: string, act: (value: number) => void): HTMLElement {
  const box = document.createElement('input');
  box.type = 'number';
  box.step = step;
  if (value !== null) box.value = String(value);
  box.addEventListener('change', () => Number.isFinite(box.valueAsNumber) && act(box.valueAsNumber));
  return make('label', [label, ' ', box], 'number');
}

/** Saves a text as a file. */
export function save(name: string, type: string, text: string): void {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(new Blob([text], { type }));
  link.download = name;
  link.click();
  URL.revokeObjectURL(link.href);
}

/** Makes a table with a header row. */
export function table(caption: string, head: string[], rows: string[][]): HTMLElement {
  const cells = (texts: string[], isHead: boolean) =>
    make('tr', texts.map((text, n) => {
      const cell = document.createElement(isHead || n === 0 ? 'th' : 'td');
      if (isHead || n === 0) cell.scope = isHead ? 'col' : 'row';
      cell.textContent = text;
      return cell;
    }));
  const name = make('caption', [caption], 'hidden');
  return make('table', [name, make('thead', [cells(head, true)]), make('tbody', rows.map((texts) => cells(texts, false)))], 'settings');
}
