// Canvases at the screen's resolution, which follow the size of their elements, and access to the page's elements.

export interface Surface {
  pen: CanvasRenderingContext2D;
  /** Width, CSS pixels. */
  width: number;
  height: number;
}

/**
 * Returns a canvas with its context in CSS pixels; null while its room or its panel is closed. The canvas is cleared,
 * except an opaque one: the caller must fill it. An opaque canvas saves blending.
 */
export function surface(canvas: HTMLCanvasElement, opaque = false): Surface | null {
  const { clientWidth: width, clientHeight: height } = canvas;
  if (width === 0 || height === 0) return null;
  const scale = devicePixelRatio;
  const [w, h] = [Math.round(width * scale), Math.round(height * scale)];
  if (canvas.width !== w || canvas.height !== h) {
    canvas.width = w;
    canvas.height = h;
  }
  const pen = canvas.getContext('2d', { alpha: !opaque });
  if (!pen) return null;
  pen.setTransform(scale, 0, 0, scale, 0, 0);
  if (!opaque) pen.clearRect(0, 0, width, height);
  return { pen, width, height };
}

/**
 * Adds a circle to the path, as two half circles: with the y axis upward, the context for SVG draws an arc in the
 * wrong direction, which makes no difference for half circles.
 */
export function circle(pen: CanvasRenderingContext2D, x: number, y: number, radius: number): void {
  pen.moveTo(x + radius, y);
  pen.arc(x, y, radius, 0, Math.PI);
  pen.arc(x, y, radius, Math.PI, 2 * Math.PI);
}

/** Finds an element of index.html. */
export function element<T extends HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no #${id}`);
  return found as T;
}
