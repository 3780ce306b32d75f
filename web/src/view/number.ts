// A number that is typed: what is out of its range is marked and not taken.

export interface Range {
  min: number;
  max: number;
  step: number;
}

/**
 * Gives an input its range, and calls back with each number in it that is typed; null of one that is emptied. Whoever
 * leaves an input with another number finds the last one that was taken.
 */
export function numberInput(input: HTMLInputElement, { min, max, step }: Range, take: (value: number | null) => void): void {
  Object.assign(input, { type: 'number', min: String(min), max: String(max), step: String(step), title: `from ${min} to ${max}` });
  input.addEventListener('input', () => {
    const value = input.valueAsNumber;
    const isEmpty = input.value === '' && !input.validity.badInput;
    const isIn = value >= min && value <= max;
    mark(input, !isEmpty && !isIn);
    if (isIn || isEmpty) input.defaultValue = input.value;
    if (isIn || isEmpty) take(isIn ? value : null);
  });
  input.addEventListener('change', () => {
    if (!input.hasAttribute('aria-invalid')) return;
    input.value = input.defaultValue;
    mark(input, false);
  });
}

/** Shows a number in an input; what is being typed there is not written over. */
export function putNumber(input: HTMLInputElement, value: number): void {
  input.defaultValue = String(value);
  if (document.activeElement === input) return;
  input.value = String(value);
  mark(input, false);
}

function mark(input: HTMLInputElement, isWrong: boolean): void {
  if (isWrong) input.setAttribute('aria-invalid', 'true');
  else input.removeAttribute('aria-invalid');
}
