// Types of the package svgcanvas, as far as the page uses it.
declare module 'svgcanvas' {
  /** A canvas context that writes SVG. */
  export class Context {
    constructor(width: number, height: number);
    getSvg(): SVGSVGElement;
    getSerializedSvg(): string;
  }
}
