// The colours of theme.css for canvases. Only theme.css defines the colours of light and dark mode.

const COLOUR_NAMES = [
  'card', 'ink', 'soft', 'line', 'floor', 'grid', 'skin', 'skin-edge', 'frame', 'frame-edge', 'steel', 'tube',
  'track', 'accent', 'alarm', 'safe', 'near', 'a1', 'a2', 'a3', 'a4',
] as const;

export type Palette = Record<(typeof COLOUR_NAMES)[number], string>;

let cachedPalette: Palette | null = null;
const changeCallbacks: (() => void)[] = [];

/** Returns the colours of the current colour scheme. */
export function getPalette(): Palette {
  if (!cachedPalette) {
    const style = getComputedStyle(document.documentElement);
    cachedPalette = Object.fromEntries(COLOUR_NAMES.map((name) => [name, style.getPropertyValue(`--${name}`).trim()])) as Palette;
  }
  return cachedPalette;
}

/** Calls `callback` whenever the colour scheme changes between light and dark. */
export const onPaletteChange = (callback: () => void) => changeCallbacks.push(callback);

matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
  cachedPalette = null;
  for (const callback of changeCallbacks) callback();
});

/** Returns the colour of a servo and its leg. */
export function getServoColour(servo: number): string {
  const { a1, a2, a3, a4 } = getPalette();
  return [a1, a2, a3, a4][servo] ?? a1;
}
