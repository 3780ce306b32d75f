// The drawing of the robot from above, in mm of the chassis frame: x to the right, y forward.
import type { Plate, Scene, Point } from '../robot';
import { addCircle, addPolyline, beginLines } from './canvas';
import { getPalette, getServoColour } from './palette';

const FOOT_RADIUS_MM = 6;
/** Width of the plate's drawn edge. */
const RIM_WIDTH_MM = 0.6;
/** Slip in one frame above which a foot counts as slipping. */
const SLIP_THRESHOLD_MM = 0.3;

type Context = CanvasRenderingContext2D;

function drawBar(context: Context, from: Point, to: Point, colour: string, widthMm: number): void {
  context.lineCap = 'round';
  beginLines(context, colour, widthMm);
  addPolyline(context, from, to);
  context.stroke();
}

function drawDisc(context: Context, [x, y]: Point, radiusMm: number, fill: string, edge?: string, edgeWidthMm = 0.8): void {
  context.fillStyle = fill;
  context.beginPath();
  addCircle(context, x, y, radiusMm);
  context.fill();
  if (edge === undefined) return;
  context.strokeStyle = edge;
  context.lineWidth = edgeWidthMm;
  context.stroke();
}

/** Number of coils of a drawn spring. */
const SPRING_TURNS = 5;
const SPRING_HALF_WIDTH_MM = 2.4;

/** Draws a coil spring between two hooks. */
function drawSpring(context: Context, [x1, y1]: Point, [x2, y2]: Point): void {
  const length = Math.hypot(x2 - x1, y2 - y1);
  if (length < 1) return;
  const [direction, normal] = [[(x2 - x1) / length, (y2 - y1) / length], [(y1 - y2) / length, (x2 - x1) / length]];
  const pointAt = (fraction: number, offset: number): Point => [
    x1 + direction[0] * fraction * length + normal[0] * offset,
    y1 + direction[1] * fraction * length + normal[1] * offset,
  ];
  context.lineJoin = 'round';
  beginLines(context, getPalette().steel, 0.9);
  const windings = Array.from({ length: 2 * SPRING_TURNS }, (_, n) => pointAt(0.12 + (0.76 * (n + 0.5)) / (2 * SPRING_TURNS), n % 2 === 0 ? SPRING_HALF_WIDTH_MM : -SPRING_HALF_WIDTH_MM));
  addPolyline(context, [x1, y1], pointAt(0.12, 0), ...windings, pointAt(0.88, 0), [x2, y2]);
  context.stroke();
}

/** Draws the outline of a lizard from the head's point to the tail's point. */
function drawSkin(context: Context, scene: Scene): void {
  const [[hx, hy], [tx, ty]] = scene.points;
  const shoulderY = Math.max(...scene.shafts.map(([, y]) => y));
  const neckY = shoulderY + 16;
  const flankY = shoulderY * 0.74;
  context.beginPath();
  context.moveTo(hx, hy + 30);
  context.bezierCurveTo(hx + 18, hy + 30, hx + 27, hy + 2, 27, neckY);
  context.bezierCurveTo(44, flankY, 44, -flankY, 27, -neckY);
  context.bezierCurveTo(tx + 22, ty, tx + 6, ty - 6, tx + 3, ty - 40);
  context.lineTo(tx - 3, ty - 40);
  context.bezierCurveTo(tx - 6, ty - 6, tx - 22, ty, -27, -neckY);
  context.bezierCurveTo(-44, -flankY, -44, flankY, -27, neckY);
  context.bezierCurveTo(hx - 27, hy + 2, hx - 18, hy + 30, hx, hy + 30);
  context.fillStyle = getPalette().skin;
  context.strokeStyle = getPalette()['skin-edge'];
  context.lineWidth = 1;
  context.fill();
  context.stroke();
  for (const eyeX of [-9, 9]) drawDisc(context, [hx + eyeX, hy + 12], 2.3, getPalette().ink);
}

const SERVO_INDICES = [0, 1, 2, 3];

/** Draws a leg's bodies next to and below the plate: foot, leaf spring and coupler. `slipMm` is the foot's slip. */
function drawLegBelowPlate(context: Context, scene: Scene, servo: number, slipMm: number): void {
  const colours = getPalette();
  const { joints, foot } = scene.legs[servo];
  drawBar(context, joints[1], foot, colours.steel, 2.2);
  // A sticking foot is a disc; a slipping foot is a ring.
  drawDisc(context, foot, FOOT_RADIUS_MM, slipMm > SLIP_THRESHOLD_MM ? colours.card : colours.ink, colours.ink, 2);
  drawBar(context, joints[0], joints[1], getServoColour(servo), 4.2);
}

/** Draws the plate, its arms with the legs' pivots, and the servos' cases. */
function drawChassis(context: Context, plate: Plate): void {
  const colours = getPalette();
  const [halfWidth, halfLength] = plate.half_size;
  for (const [rim, colour] of [[RIM_WIDTH_MM, colours['frame-edge']], [0, colours.frame]] as const) {
    for (const [from, to] of plate.arms) drawBar(context, from, to, colour, 2 * (plate.arm_half_width + rim));
    context.fillStyle = colour;
    context.beginPath();
    context.roundRect(-halfWidth - rim, -halfLength - rim, 2 * (halfWidth + rim), 2 * (halfLength + rim), plate.corner_radius + rim);
    context.fill();
  }
  const [width, length] = plate.case_size;
  plate.case_centres.forEach(([x, y], servo) => {
    context.globalAlpha = 0.35;
    context.fillStyle = getServoColour(servo);
    context.beginPath();
    context.roundRect(x - width / 2, y - length / 2, width, length, 1.3);
    context.fill();
    context.globalAlpha = 1;
  });
}

/** Draws a leg's bodies above the plate: crank, follower, strut, and the servo's link to the strut. */
function drawLegAbovePlate(context: Context, scene: Scene, servo: number): void {
  const colours = getPalette();
  const { pivots, joints, strut, has_spring: hasSpring } = scene.legs[servo];
  const colour = getServoColour(servo);
  drawBar(context, pivots[0], strut[1], colour, 3.2);
  for (const n of [0, 1]) drawBar(context, pivots[n], joints[n], colour, 3.2);
  for (const point of [...pivots, ...joints]) drawDisc(context, point, 1.6, colours.card, colours.ink);
  drawBar(context, strut[0], strut[1], colours.steel, hasSpring ? 0.8 : 1.6);
  if (hasSpring) drawSpring(context, strut[0], strut[1]);
  drawDisc(context, strut[1], 1.2, colours.card, colours.ink);
  drawBar(context, scene.shafts[servo], strut[0], colour, 3);
}

/** Draws the telescopic slider between the two servos of a side, 0 for left and 1 for right. */
function drawSlider(context: Context, scene: Scene, side: 0 | 1): void {
  const colours = getPalette();
  const { shafts, tips, tube } = scene.sliders[side];
  drawBar(context, tips[0], tips[1], colours.steel, 1.8);
  drawBar(context, tips[1], tube, colours.tube, 5);
  const servos = side === 0 ? [0, 3] : [1, 2];
  servos.forEach((servo, n) => {
    context.globalAlpha = 0.75;
    drawBar(context, shafts[n], tips[n], getServoColour(servo), 3);
    context.globalAlpha = 1;
    drawDisc(context, tips[n], 2, colours.card, colours.ink);
  });
}

/** Draws the five-bar of an end, 0 for the head and 1 for the tail. */
function drawFiveBar(context: Context, scene: Scene, end: 0 | 1): void {
  const colours = getPalette();
  const servos = end === 0 ? [0, 1] : [2, 3];
  const point = scene.points[end];
  for (const servo of servos) drawBar(context, scene.tips[servo], point, colours.steel, 3.4);
  for (const servo of servos) {
    drawBar(context, scene.shafts[servo], scene.tips[servo], getServoColour(servo), 4.6);
    drawDisc(context, scene.tips[servo], 2.2, colours.card, colours.ink);
    drawDisc(context, scene.shafts[servo], 3.4, colours.ink);
    drawDisc(context, scene.shafts[servo], 1.2, colours.card);
  }
  drawDisc(context, point, 3.2, '#f0e442', '#222222');
}

/** Draws the robot, starting with the lowest bodies; `slips` are the feet's slips in this frame, mm. */
export function drawLizard(context: Context, plate: Plate, scene: Scene, slips: readonly number[]): void {
  drawSkin(context, scene);
  for (const servo of SERVO_INDICES) drawLegBelowPlate(context, scene, servo, slips[servo] ?? 0);
  drawChassis(context, plate);
  for (const servo of SERVO_INDICES) drawLegAbovePlate(context, scene, servo);
  for (const side of [0, 1] as const) drawSlider(context, scene, side);
  for (const end of [0, 1] as const) drawFiveBar(context, scene, end);
  for (const { strut } of scene.legs) drawDisc(context, strut[0], 1.2, getPalette().card, getPalette().ink);
}
