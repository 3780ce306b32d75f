// The drawing of the first connection, from above with forward upward: each servo, the direction of its crank, and an
// arrow for a turn. The body is drawn shorter than it is, so that the cranks are large.
import type { Description, Four, Scene, Point } from '../../robot';

export const PLACES = ['front left', 'front right', 'back right', 'back left'] as const;
export const nameOf = (servo: number): string => `A${servo + 1}, ${PLACES[servo]}`;

/** The selected servo. */
export interface SelectedServo {
  servo: number;
  /** The servo's turn, deg counter-clockwise; null for none. */
  by: number | null;
}

/** Half of the drawn distance from the front shafts to the rear shafts, mm. */
const HALF_LENGTH_MM = 34;
/** Length of the arrow's arc, deg: more than the servo turns, to be seen clearly. */
const ARC = 55;
const NAMESPACE = 'http://www.w3.org/2000/svg';
const RADIANS = Math.PI / 180;

function shape(tag: string, attributes: Record<string, string | number>, text = ''): SVGElement {
  const made = document.createElementNS(NAMESPACE, tag);
  for (const [key, value] of Object.entries(attributes)) {
    made.setAttribute(key, typeof value === 'number' ? value.toFixed(2) : value);
  }
  made.textContent = text;
  return made;
}

/** Returns the point at a distance, mm, and an angle from another point, in the drawing's frame with y downward. */
function pointAt([x, y]: Point, length: number, degrees: number): Point {
  return [x + length * Math.cos(degrees * RADIANS), y - length * Math.sin(degrees * RADIANS)];
}

const line = (className: string, [x1, y1]: Point, [x2, y2]: Point) => shape('line', { class: className, x1, y1, x2, y2 });

/** Draws an arrow about a shaft. It begins at the angle `begin`, deg, and turns in the direction of `by`. */
function arrow(shaft: Point, radius: number, begin: number, by: number): SVGElement[] {
  const sense = Math.sign(by);
  const end = begin + sense * ARC;
  const [x1, y1] = pointAt(shaft, radius, begin);
  const [x2, y2] = pointAt(shaft, radius, end);
  // SVG's sweep flag is 0 for counter-clockwise, since y is downward.
  const arc = shape('path', { class: 'arrow', d: `M ${x1} ${y1} A ${radius} ${radius} 0 0 ${by > 0 ? 0 : 1} ${x2} ${y2}` });
  const head = [pointAt(shaft, radius + 6, end - sense * 9), [x2, y2], pointAt(shaft, radius - 6, end - sense * 9)];
  return [arc, shape('polyline', { class: 'arrow', points: head.map((spot) => spot.map((n) => (n as number).toFixed(2)).join()).join(' ') })];
}

/** Draws the robot; `shown` selects one servo. */
export function drawing({ servos, plate }: Description, { shafts, tips }: Scene, shown: SelectedServo | null): SVGElement {
  const cut = Math.max(...shafts.map(([, y]) => Math.abs(y))) - HALF_LENGTH_MM;
  const short = ([x, y]: Point): Point => [x, -Math.sign(y) * (Math.abs(y) - cut)];
  const places = shafts.map(short) as Four<Point>;
  const length = Math.hypot(tips[0][0] - shafts[0][0], tips[0][1] - shafts[0][1]);
  const [half, tall] = [plate.half[0], plate.half[1] - cut];
  const wide = Math.max(...places.map(([x]) => Math.abs(x))) + length + 58;
  const high = Math.max(HALF_LENGTH_MM + length, tall) + 8;
  const angles = servos.map(({ neutral }, n) => `${nameOf(n)}: ${neutral.toFixed(1)}°`).join('; ');
  const turn = shown?.by ? ` An arrow shows A${shown.servo + 1} turning ${shown.by > 0 ? 'counter-clockwise' : 'clockwise'}.` : '';
  const svg = shape('svg', {
    class: 'robot-drawing',
    viewBox: `${-wide} ${-high} ${2 * wide} ${2 * high}`,
    role: 'img',
    'aria-label': `The robot from above, ahead is up. Where the cranks point, from its right, counter-clockwise: ${angles}.${turn}`,
  });
  svg.append(
    shape('rect', { class: 'plate', x: -half, y: -tall, width: 2 * half, height: 2 * tall, rx: 8 }),
    line('ahead', [0, 16], [0, -16]),
    shape('polyline', { class: 'ahead', points: '-6,-8 0,-16 6,-8' }),
    shape('text', { x: 0, y: 28 }, 'ahead'),
  );
  places.forEach((shaft, n) => {
    const { neutral, pin } = servos[n];
    const isShown = shown?.servo === n;
    const group = shape('g', { class: `servo a${n + 1}${shown && !isShown ? ' other' : ''}` });
    const tip = pointAt(shaft, length, neutral);
    group.append(line('zero', shaft, pointAt(shaft, length * 0.6, 0)), line('crank', shaft, tip));
    if (isShown && shown.by !== null) {
      group.append(line('ghost', shaft, pointAt(shaft, length, neutral + shown.by)), ...arrow(shaft, length * 0.75, neutral + Math.sign(shown.by) * 8, shown.by));
    }
    group.append(shape('circle', { class: 'shaft', cx: shaft[0], cy: shaft[1], r: 5 }));
    // The text is outside the arrow, which may reach as far as the crank.
    const isLeft = shaft[0] < 0;
    const x = (isLeft ? -1 : 1) * (Math.abs(shaft[0]) + length + 6);
    const y = shaft[1] + Math.sign(shaft[1]) * length * 0.4;
    const side = isLeft ? 'left' : 'right';
    group.append(
      shape('text', { class: `name ${side}`, x, y: y - 5 }, `A${n + 1}`),
      shape('text', { class: side, x, y: y + 7 }, `${neutral.toFixed(1)}°`),
      shape('text', { class: side, x, y: y + 19 }, `pin D${pin}`),
    );
    svg.append(group);
  });
  return svg;
}
