// Types of the part of the package svgcanvas that the page uses.
declare module 'svgcanvas' {
  /** A canvas context that writes SVG. */
  export class Context {
    constructor(width: number, height: number);
    getSvg(): SVGSVGElement;
    getSerializedSvg(): string;
  }
}
