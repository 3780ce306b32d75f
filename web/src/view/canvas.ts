// Canvases at the screen's resolution and at the size of their elements.

/**
 * Prepares a canvas for drawing; returns its context and its width and height in CSS pixels, or null while the canvas
 * is hidden. Clears the canvas unless it is opaque. An opaque canvas saves blending, but the caller must fill it.
 */
export function prepareSurface(canvas: HTMLCanvasElement, isOpaque = false) {
  const { clientWidth: width, clientHeight: height } = canvas;
  if (width === 0 || height === 0) return null;
  const scale = devicePixelRatio;
  const [pixelWidth, pixelHeight] = [Math.round(width * scale), Math.round(height * scale)];
  if (canvas.width !== pixelWidth || canvas.height !== pixelHeight) {
    canvas.width = pixelWidth;
    canvas.height = pixelHeight;
  }
  const context = canvas.getContext('2d', { alpha: !isOpaque });
  if (!context) return null;
  context.setTransform(scale, 0, 0, scale, 0, 0);
  if (!isOpaque) context.clearRect(0, 0, width, height);
  return { context, width, height };
}

/** Begins a path for lines of this colour and width. */
export function beginLines(context: CanvasRenderingContext2D, colour: string, width: number): void {
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.beginPath();
}

/** Adds the straight lines between successive points to the path. */
export function addPolyline(context: CanvasRenderingContext2D, ...[[x, y], ...others]: [[number, number], ...[number, number][]]): void {
  context.moveTo(x, y);
  for (const point of others) context.lineTo(...point);
}

/**
 * Adds a circle to the path, as two half circles: with an upward y axis, the SVG context reverses the direction of an
 * arc, but a half circle looks the same in both directions.
 */
export function addCircle(context: CanvasRenderingContext2D, x: number, y: number, radius: number): void {
  context.moveTo(x + radius, y);
  context.arc(x, y, radius, 0, Math.PI);
  context.arc(x, y, radius, Math.PI, 2 * Math.PI);
}
