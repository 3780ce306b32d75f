// Finds, fills and makes page elements: paragraphs, buttons, number inputs, lists, tables and SVG.

type Child = Node | string;

/** Returns an element of index.html. Throws an error if it is missing. */
export function element<T extends HTMLElement>(id: string): T {
  const node = document.getElementById(id);
  if (!node) throw new Error(`the page has no #${id}`);
  return node as T;
}

/** Shows a message in a box; an empty message hides the box. */
export function showMessage(box: HTMLElement, text: string): void {
  setText(box, text);
  box.hidden = text === '';
}

/** Sets an element's text unless the text is unchanged, so that it is not laid out or read aloud again. */
export function setText(box: HTMLElement, text: string): void {
  if (box.textContent !== text) box.textContent = text;
}

/** Shows a slider's value as a text: on the page in the element `ID-out`, and for screen readers. */
export function showSliderText(slider: HTMLInputElement, text: string): void {
  setText(element(`${slider.id}-out`), text);
  slider.setAttribute('aria-valuetext', text);
}

/** Sets an attribute of an element, or removes it if the value is null. */
export function setAttribute(node: Element, name: string, value: string | null): void {
  if (value === null) node.removeAttribute(name);
  else node.setAttribute(name, value);
}

/** Makes an HTML element with these properties and children. */
export function make<K extends keyof HTMLElementTagNameMap>(tag: K, properties: Partial<HTMLElementTagNameMap[K]>, ...children: Child[]): HTMLElementTagNameMap[K] {
  const node = Object.assign(document.createElement(tag), properties);
  node.append(...children);
  return node;
}

/** Sets the attributes of an element, if it exists; numbers are rounded to hundredths. */
export function setAttributes(node: Element | undefined, attributes: Record<string, string | number>): void {
  for (const [name, value] of Object.entries(attributes)) node?.setAttribute(name, typeof value === 'number' ? String(Number(value.toFixed(2))) : value);
}

/** Makes an SVG element with these attributes and children. */
export function makeSvg<K extends keyof SVGElementTagNameMap>(tag: K, attributes: Record<string, string | number>, ...children: Child[]): SVGElementTagNameMap[K] {
  const node = document.createElementNS('http://www.w3.org/2000/svg', tag);
  setAttributes(node, attributes);
  node.append(...children);
  return node;
}

export const paragraph = (...children: Child[]): HTMLElement => make('p', {}, ...children);
/** Makes a paragraph of less important text. */
export const note = (...children: Child[]): HTMLElement => make('p', { className: 'note' }, ...children);
/** Makes a paragraph that warns of a problem. */
export const warning = (text: string): HTMLElement => make('p', { className: 'refusal' }, text);
/** Makes a row of buttons or other controls. */
export const row = (...children: Child[]): HTMLElement => make('p', { className: 'actions' }, ...children);
export const list = (...items: Child[]): HTMLElement => make('ul', {}, ...items.map((item) => make('li', {}, item)));

/** Makes a button that calls `action`; `isMain` marks the button that the user is expected to press. */
export function button(label: string, action: () => void, isMain = false): HTMLButtonElement {
  return make('button', { type: 'button', className: isMain ? 'main' : '', onclick: action }, label);
}

/** Calls `action` with the file that the user chooses in a file input. */
export function onFile(input: HTMLInputElement, action: (file: File) => void): void {
  input.addEventListener('change', () => {
    const file = input.files?.[0];
    if (file) action(file);
    // Without this reset, the same file could not be chosen again.
    input.value = '';
  });
}

/** Converts a pointer's position to the units of an SVG picture; null while the picture is not shown. */
export function toPicture(picture: SVGSVGElement, { clientX, clientY }: PointerEvent): DOMPoint | null {
  const matrix = picture.getScreenCTM();
  return matrix && new DOMPoint(clientX, clientY).matrixTransform(matrix.inverse());
}

/** Replaces the options of a list. Returns true if the chosen option still exists, which then stays chosen. */
export function replaceOptions(list: HTMLSelectElement, options: HTMLOptionElement[]): boolean {
  const chosen = options.find(({ value }) => value === list.value);
  list.replaceChildren(...options);
  if (chosen) list.value = chosen.value;
  return chosen !== undefined;
}

/** Makes a labelled number input; `onNumber` is called with each number that the user enters. */
export function numberBox(label: string, value: number | null, step: string, onNumber: (value: number) => void): HTMLElement {
  const box = make('input', { type: 'number', step, value: String(value ?? '') });
  box.addEventListener('change', () => Number.isFinite(box.valueAsNumber) && onNumber(box.valueAsNumber));
  return make('label', { className: 'number' }, label, ' ', box);
}

/** Makes a table row; the first cell is the row's heading. */
export function tableRow([heading = '', ...cells]: string[]): HTMLElement {
  return make('tr', {}, make('th', { scope: 'row' }, heading), ...cells.map((text) => make('td', {}, text)));
}

/** Makes a table with a header row and a caption for screen readers. */
export function table(caption: string, headings: string[], rows: string[][]): HTMLElement {
  const headingCells = headings.map((text) => make('th', { scope: 'col' }, text));
  const captionElement = make('caption', { className: 'hidden' }, caption);
  return make('table', { className: 'settings' }, captionElement, make('thead', {}, make('tr', {}, ...headingCells)), make('tbody', {}, ...rows.map(tableRow)));
}
