// Draws a link as a QR code for a phone's camera.
import { encode } from 'uqr';

import { makeSvg } from './elements';

/** Width of the empty border in modules (ISO/IEC 18004, 9.1). */
const BORDER_MODULES = 4;

/** Makes the QR code of a link. Throws an error if the link is too long. */
export function makeQrCode(link: string): SVGSVGElement {
  const { size, data } = encode(link, { ecc: 'L', border: BORDER_MODULES });
  const darkModules = data.flatMap((row, y) => row.map((isDark, x) => (isDark ? `M${x} ${y}h1v1h-1z` : ''))).join('');
  return makeSvg('svg', { viewBox: `0 0 ${size} ${size}`, role: 'img', 'aria-label': 'QR code of the link to this robot' }, makeSvg('path', { d: darkModules }));
}
