// A number input that marks and ignores values out of range.
import { putAttribute } from './elements';

/**
 * Calls `onNumber` with each number in the input's range that the user types, and with null when an input that is not
 * required is empty. When the user leaves an input with an invalid number, or a required input without a number, the
 * last valid number is restored.
 */
export function setUpNumberInput(input: HTMLInputElement, onNumber: (value: number | null) => void): void {
  const { min, max } = input;
  input.title = `from ${min} to ${max}`;
  input.addEventListener('input', () => {
    const value = input.valueAsNumber;
    const isEmpty = input.value === '' && !input.required && !input.validity.badInput;
    const isInRange = value >= Number(min) && value <= Number(max);
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

/** Marks the number of an input as invalid or valid. */
export const markInvalid = (input: HTMLInputElement, isInvalid: boolean) => putAttribute(input, 'aria-invalid', isInvalid ? 'true' : null);
