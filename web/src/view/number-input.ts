// A number input that marks and ignores values out of range.
import { setAttribute } from './elements';

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
    const isAllowedEmpty = input.value === '' && !input.required && !input.validity.badInput;
    const isInRange = value >= Number(min) && value <= Number(max);
    setInvalid(input, !isAllowedEmpty && !isInRange);
    if (isInRange || isAllowedEmpty) input.defaultValue = input.value;
    if (isInRange || isAllowedEmpty) onNumber(isInRange ? value : null);
  });
  input.addEventListener('change', () => {
    if (!input.hasAttribute('aria-invalid')) return;
    input.value = input.defaultValue;
    setInvalid(input, false);
  });
}

/** Sets the number of an input. While the user is typing in it, only the number to restore changes. */
export function setNumber(input: HTMLInputElement, value: number): void {
  input.defaultValue = String(value);
  if (document.activeElement === input) return;
  input.value = String(value);
  setInvalid(input, false);
}

/** Marks the number of an input as invalid or valid. */
export const setInvalid = (input: HTMLInputElement, isInvalid: boolean) => setAttribute(input, 'aria-invalid', isInvalid ? 'true' : null);
