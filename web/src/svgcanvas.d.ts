// The package has no types of its own; this is what the page uses of it.
declare module 'svgcanvas' {
  /** A canvas's pen that writes SVG. */
  export class Context {
    constructor(width: number, height: number);
    getSvg(): SVGSVGElement;
    getSerializedSvg(): string;
  }
}
