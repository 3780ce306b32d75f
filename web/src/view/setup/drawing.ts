// The drawing of the robot for the first connection, from above with the head upward: each servo, its crank's
// direction, and an arrow for a rotation. The body is shortened, so that the cranks appear large.
import type { Description, Four, Scene, Point } from '../../robot';
import { makeSvg } from '../elements';

/** The positions of servos A1 to A4 in the robot. */
export const SERVO_POSITIONS = ['front left', 'front right', 'back right', 'back left'] as const;
/** Formats a servo's name with its position, such as `A1, front left`. */
export const formatServo = (servo: number): string => `A${servo + 1}, ${SERVO_POSITIONS[servo]}`;

/** The servo that the drawing highlights, and its arrow. */
export interface Highlight {
  servo: number;
  /** The rotation that the arrow shows, deg counter-clockwise; null for no arrow. */
  turnDeg: number | null;
}

/** Half the drawn distance between the front and the rear shafts. */
const HALF_LENGTH_MM = 34;
/** Angle of the arrow's arc: larger than the servo's rotation, so that the arrow is clearly visible. */
const ARC_DEG = 55;
const RADIANS_PER_DEG = Math.PI / 180;

/** Returns the point at a distance and an angle from another point, in the drawing's frame with y downward. */
function pointAt([x, y]: Point, lengthMm: number, degrees: number): Point {
  return [x + lengthMm * Math.cos(degrees * RADIANS_PER_DEG), y - lengthMm * Math.sin(degrees * RADIANS_PER_DEG)];
}

const makeLine = (className: string, [x1, y1]: Point, [x2, y2]: Point) => makeSvg('line', { class: className, x1, y1, x2, y2 });

/** Makes the crank after a rotation by `turnDeg` from its neutral angle, and an arrow for this rotation. */
function makeTurn(shaft: Point, crankLength: number, neutral: number, turnDeg: number): SVGElement[] {
  const direction = Math.sign(turnDeg);
  const radius = crankLength * 0.75;
  const startDeg = neutral + direction * 8;
  const endDeg = startDeg + direction * ARC_DEG;
  const [x1, y1] = pointAt(shaft, radius, startDeg);
  const [x2, y2] = pointAt(shaft, radius, endDeg);
  // Because y is downward, SVG's sweep flag is 0 for counter-clockwise.
  const arc = makeSvg('path', { class: 'arrow', d: `M ${x1} ${y1} A ${radius} ${radius} 0 0 ${turnDeg > 0 ? 0 : 1} ${x2} ${y2}` });
  const arrowheadPoints = [pointAt(shaft, radius + 6, endDeg - direction * 9), [x2, y2], pointAt(shaft, radius - 6, endDeg - direction * 9)];
  const arrowhead = makeSvg('polyline', { class: 'arrow', points: arrowheadPoints.map((point) => point.map((n) => (n as number).toFixed(2)).join()).join(' ') });
  return [makeLine('ghost', shaft, pointAt(shaft, crankLength, neutral + turnDeg)), arc, arrowhead];
}

/** Makes the drawing of the robot; without a highlight, all servos look alike. */
export function makeDrawing({ servos, plate }: Description, { shafts, tips }: Scene, highlight: Highlight | null): SVGElement {
  const shortening = Math.max(...shafts.map(([, y]) => Math.abs(y))) - HALF_LENGTH_MM;
  const shorten = ([x, y]: Point): Point => [x, -Math.sign(y) * (Math.abs(y) - shortening)];
  const shaftPoints = shafts.map(shorten) as Four<Point>;
  const crankLength = Math.hypot(tips[0][0] - shafts[0][0], tips[0][1] - shafts[0][1]);
  const [halfWidth, halfLength] = [plate.half_size[0], plate.half_size[1] - shortening];
  const viewHalfWidth = Math.max(...shaftPoints.map(([x]) => Math.abs(x))) + crankLength + 58;
  const viewHalfHeight = Math.max(HALF_LENGTH_MM + crankLength, halfLength) + 8;
  const angles = servos.map(({ neutral }, n) => `${formatServo(n)}: ${neutral.toFixed(1)}°`).join('; ');
  const arrowText = highlight?.turnDeg ? ` An arrow shows A${highlight.servo + 1} turning ${highlight.turnDeg > 0 ? 'counter-clockwise' : 'clockwise'}.` : '';
  const servoGroups = shaftPoints.map((shaft, n) => {
    const { neutral, pin } = servos[n];
    const isHighlighted = highlight?.servo === n;
    const turn = isHighlighted && highlight.turnDeg !== null ? makeTurn(shaft, crankLength, neutral, highlight.turnDeg) : [];
    // The text is beyond the crank, where it does not overlap the arrow.
    const isLeft = shaft[0] < 0;
    const x = (isLeft ? -1 : 1) * (Math.abs(shaft[0]) + crankLength + 6);
    const y = shaft[1] + Math.sign(shaft[1]) * crankLength * 0.4;
    const side = isLeft ? 'left' : 'right';
    return makeSvg(
      'g',
      { class: `servo a${n + 1}${highlight && !isHighlighted ? ' other' : ''}` },
      makeLine('zero', shaft, pointAt(shaft, crankLength * 0.6, 0)),
      makeLine('crank', shaft, pointAt(shaft, crankLength, neutral)),
      ...turn,
      makeSvg('circle', { class: 'shaft', cx: shaft[0], cy: shaft[1], r: 5 }),
      makeSvg('text', { class: `name ${side}`, x, y: y - 5 }, `A${n + 1}`),
      makeSvg('text', { class: side, x, y: y + 7 }, `${neutral.toFixed(1)}°`),
      makeSvg('text', { class: side, x, y: y + 19 }, `pin D${pin}`),
    );
  });
  return makeSvg(
    'svg',
    {
      class: 'robot-drawing',
      viewBox: `${-viewHalfWidth} ${-viewHalfHeight} ${2 * viewHalfWidth} ${2 * viewHalfHeight}`,
      role: 'img',
      'aria-label': `The robot from above; ahead is up. Angles of the cranks, counter-clockwise from the robot's right: ${angles}.${arrowText}`,
    },
    makeSvg('rect', { class: 'plate', x: -halfWidth, y: -halfLength, width: 2 * halfWidth, height: 2 * halfLength, rx: 8 }),
    makeLine('ahead', [0, 16], [0, -16]),
    makeSvg('polyline', { class: 'ahead', points: '-6,-8 0,-16 6,-8' }),
    makeSvg('text', { x: 0, y: 28 }, 'ahead'),
    ...servoGroups,
  );
}
