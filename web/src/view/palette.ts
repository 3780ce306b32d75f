// The colours of style.css, for canvases. Only style.css decides which colours light and dark mode have.

const NAMES = [
  'card', 'ink', 'soft', 'line', 'floor', 'grid', 'skin', 'skin-edge', 'frame', 'frame-edge', 'steel', 'tube',
  'track', 'accent', 'alarm', 'safe', 'near', 'a1', 'a2', 'a3', 'a4',
] as const;

export type Palette = Record<(typeof NAMES)[number], string>;

let cachedPalette: Palette | null = null;
const changeCallbacks: (() => void)[] = [];

export function palette(): Palette {
  if (!cachedPalette) {
    const style = getComputedStyle(document.documentElement);
    cachedPalette = Object.fromEntries(NAMES.map((name) => [name, style.getPropertyValue(`--${name}`).trim()])) as Palette;
  }
  return cachedPalette;
}

/** Calls `callback` when the colour scheme changes between light and dark. */
export function onPaletteChange(callback: () => void): void {
  changeCallbacks.push(callback);
}

matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
  cachedPalette = null;
  for (const callback of changeCallbacks) callback();
});

/** The colour of a servo and of its leg. */
export function servoColour(servo: number): string {
  const { a1, a2, a3, a4 } = palette();
  return [a1, a2, a3, a4][servo] ?? a1;
}
