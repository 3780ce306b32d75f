// A number input that marks values out of range and ignores them.

export interface Range {
  min: number;
  max: number;
  step: number;
}

/**
 * Sets an input's range, and calls `take` with each valid number that is typed, or with null when the input is emptied.
 * Leaving the input with an invalid number restores the last valid one.
 */
export function numberInput(input: HTMLInputElement, { min, max, step }: Range, take: (value: number | null) => void): void {
  Object.assign(input, { type: 'number', min: String(min), max: String(max), step: String(step), title: `from ${min} to ${max}` });
  input.addEventListener('input', () => {
    const value = input.valueAsNumber;
    const isEmpty = input.value === '' && !input.validity.badInput;
    const isInRange = value >= min && value <= max;
    mark(input, !isEmpty && !isInRange);
    if (isInRange || isEmpty) input.defaultValue = input.value;
    if (isInRange || isEmpty) take(isInRange ? value : null);
  });
  input.addEventListener('change', () => {
    if (!input.hasAttribute('aria-invalid')) return;
    input.value = input.defaultValue;
    mark(input, false);
  });
}

/** Sets the number of an input; while the user is typing there, the text stays. */
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
