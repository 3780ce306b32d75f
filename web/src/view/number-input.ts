// A number input that marks and ignores values out of range.

/** The range of valid numbers, and the step of the input's arrows. */
export interface Range {
  min: number;
  max: number;
  step: number;
}

/**
 * Sets an input's range. `onNumber` is called with each valid number that the user types, and with null when the input
 * is empty. When the user leaves the input with an invalid number, the last valid number is restored.
 */
export function setUpNumberInput(input: HTMLInputElement, { min, max, step }: Range, onNumber: (value: number | null) => void): void {
  Object.assign(input, { type: 'number', min: String(min), max: String(max), step: String(step), title: `from ${min} to ${max}` });
  input.addEventListener('input', () => {
    const value = input.valueAsNumber;
    const isEmpty = input.value === '' && !input.validity.badInput;
    const isInRange = value >= min && value <= max;
    markInvalid(input, !isEmpty && !isInRange);
    if (isInRange || isEmpty) input.defaultValue = input.value;
    if (isInRange || isEmpty) onNumber(isInRange ? value : null);
  });
  input.addEventListener('change', () => {
    if (!input.hasAttribute('aria-invalid')) return;
    input.value = input.defaultValue;
    markInvalid(input, false);
  });
}

/** Sets the number of an input; the text stays while the user is typing in it. */
export function putNumber(input: HTMLInputElement, value: number): void {
  input.defaultValue = String(value);
  if (document.activeElement === input) return;
  input.value = String(value);
  markInvalid(input, false);
}

function markInvalid(input: HTMLInputElement, isInvalid: boolean): void {
  if (isInvalid) input.setAttribute('aria-invalid', 'true');
  else input.removeAttribute('aria-invalid');
}
