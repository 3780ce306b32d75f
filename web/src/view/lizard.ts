// Draws the robot from above, in mm of the chassis frame: x to the right, y forward.
import type { Plate, Scene, Point } from '../robot';
import { circle, polyline } from './canvas';
import { palette, servoColour } from './palette';

const FOOT_RADIUS_MM = 6;
/** Width of the plate's drawn edge. */
const RIM_WIDTH_MM = 0.6;
/** Slide in one frame beyond which a foot counts as slipping. */
const SLIP_LIMIT_MM = 0.3;

type Pen = CanvasRenderingContext2D;

function drawBar(pen: Pen, from: Point, to: Point, colour: string, widthMm: number): void {
  pen.strokeStyle = colour;
  pen.lineWidth = widthMm;
  pen.lineCap = 'round';
  pen.beginPath();
  polyline(pen, from, to);
  pen.stroke();
}

function drawDisc(pen: Pen, [x, y]: Point, radiusMm: number, fill: string, edge?: string): void {
  pen.fillStyle = fill;
  pen.beginPath();
  circle(pen, x, y, radiusMm);
  pen.fill();
  if (edge === undefined) return;
  pen.strokeStyle = edge;
  pen.lineWidth = 0.8;
  pen.stroke();
}

/** Number of turns of a drawn spring. */
const SPRING_TURNS = 5;
/** Half of a drawn spring's width. */
const SPRING_HALF_WIDTH_MM = 2.4;

/** Draws a spring between two hooks. */
function drawSpring(pen: Pen, [x1, y1]: Point, [x2, y2]: Point): void {
  const length = Math.hypot(x2 - x1, y2 - y1);
  if (length < 1) return;
  const [direction, normal] = [[(x2 - x1) / length, (y2 - y1) / length], [(y1 - y2) / length, (x2 - x1) / length]];
  const pointAt = (share: number, offset: number): Point => [
    x1 + direction[0] * share * length + normal[0] * offset,
    y1 + direction[1] * share * length + normal[1] * offset,
  ];
  pen.strokeStyle = palette().steel;
  pen.lineWidth = 0.9;
  pen.lineJoin = 'round';
  pen.beginPath();
  const windings = Array.from({ length: 2 * SPRING_TURNS }, (_, n) => pointAt(0.12 + (0.76 * (n + 0.5)) / (2 * SPRING_TURNS), n % 2 === 0 ? SPRING_HALF_WIDTH_MM : -SPRING_HALF_WIDTH_MM));
  polyline(pen, [x1, y1], pointAt(0.12, 0), ...windings, pointAt(0.88, 0), [x2, y2]);
  pen.stroke();
}

/** Draws the outline of a lizard from the head's end point to the tail's. */
function drawSkin(pen: Pen, scene: Scene): void {
  const [[hx, hy], [tx, ty]] = scene.points;
  const backY = Math.max(...scene.shafts.map(([, y]) => y));
  const neckY = backY + 16;
  const flankY = backY * 0.74;
  pen.beginPath();
  pen.moveTo(hx, hy + 30);
  pen.bezierCurveTo(hx + 18, hy + 30, hx + 27, hy + 2, 27, neckY);
  pen.bezierCurveTo(44, flankY, 44, -flankY, 27, -neckY);
  pen.bezierCurveTo(tx + 22, ty, tx + 6, ty - 6, tx + 3, ty - 40);
  pen.lineTo(tx - 3, ty - 40);
  pen.bezierCurveTo(tx - 6, ty - 6, tx - 22, ty, -27, -neckY);
  pen.bezierCurveTo(-44, -flankY, -44, flankY, -27, neckY);
  pen.bezierCurveTo(hx - 27, hy + 2, hx - 18, hy + 30, hx, hy + 30);
  pen.fillStyle = palette().skin;
  pen.strokeStyle = palette()['skin-edge'];
  pen.lineWidth = 1;
  pen.fill();
  pen.stroke();
  for (const eyeX of [-9, 9]) drawDisc(pen, [hx + eyeX, hy + 12], 2.3, palette().ink);
}

const SERVOS = [0, 1, 2, 3];

/** Draws a leg's bodies beside and below the plate: foot, leaf spring and coupler. */
function drawFoot(pen: Pen, scene: Scene, servo: number, slide: number): void {
  const colours = palette();
  const { joints, foot } = scene.legs[servo];
  drawBar(pen, joints[1], foot, colours.steel, 2.2);
  // A foot that holds is filled; one that slips is a ring.
  drawDisc(pen, foot, FOOT_RADIUS_MM, slide > SLIP_LIMIT_MM ? colours.card : colours.ink);
  pen.strokeStyle = colours.ink;
  pen.lineWidth = 2;
  pen.stroke();
  drawBar(pen, joints[0], joints[1], servoColour(servo), 4.2);
}

/** Draws the plate, the arms on it that carry the legs' pivots, and the servos' cases. */
function drawChassis(pen: Pen, plate: Plate): void {
  const colours = palette();
  const [halfWidth, halfLength] = plate.half;
  for (const [rim, colour] of [[RIM_WIDTH_MM, colours['frame-edge']], [0, colours.frame]] as const) {
    for (const [from, to] of plate.arms) drawBar(pen, from, to, colour, 2 * (plate.arm + rim));
    pen.fillStyle = colour;
    pen.beginPath();
    pen.roundRect(-halfWidth - rim, -halfLength - rim, 2 * (halfWidth + rim), 2 * (halfLength + rim), plate.corner + rim);
    pen.fill();
  }
  const [width, length] = plate.case;
  plate.cases.forEach(([x, y], servo) => {
    pen.globalAlpha = 0.35;
    pen.fillStyle = servoColour(servo);
    pen.beginPath();
    pen.roundRect(x - width / 2, y - length / 2, width, length, 1.3);
    pen.fill();
    pen.globalAlpha = 1;
  });
}

/** Draws a leg's bodies above the plate: crank, follower and strut. */
function drawLeg(pen: Pen, scene: Scene, servo: number): void {
  const colours = palette();
  const { pivots, joints, strut, sprung } = scene.legs[servo];
  const colour = servoColour(servo);
  drawBar(pen, pivots[0], strut[1], colour, 3.2);
  for (const n of [0, 1]) drawBar(pen, pivots[n], joints[n], colour, 3.2);
  for (const point of [...pivots, ...joints]) drawDisc(pen, point, 1.6, colours.card, colours.ink);
  drawBar(pen, strut[0], strut[1], colours.steel, sprung ? 0.8 : 1.6);
  if (sprung) drawSpring(pen, strut[0], strut[1]);
  drawDisc(pen, strut[1], 1.2, colours.card, colours.ink);
  drawBar(pen, scene.shafts[servo], strut[0], colour, 3);
}

/** Draws the telescopic slider between the two servos of a side, 0 for left and 1 for right. */
function drawSlider(pen: Pen, scene: Scene, side: 0 | 1): void {
  const colours = palette();
  const { shafts, tips, tube } = scene.sliders[side];
  drawBar(pen, tips[0], tips[1], colours.steel, 1.8);
  drawBar(pen, tips[1], tube, colours.tube, 5);
  const servos = side === 0 ? [0, 3] : [1, 2];
  servos.forEach((servo, n) => {
    pen.globalAlpha = 0.75;
    drawBar(pen, shafts[n], tips[n], servoColour(servo), 3);
    pen.globalAlpha = 1;
    drawDisc(pen, tips[n], 2, colours.card, colours.ink);
  });
}

/** Draws the five-bar of an end, 0 for the head and 1 for the tail. */
function drawFiveBar(pen: Pen, scene: Scene, end: 0 | 1): void {
  const colours = palette();
  const servos = end === 0 ? [0, 1] : [2, 3];
  const point = scene.points[end];
  for (const servo of servos) drawBar(pen, scene.tips[servo], point, colours.steel, 3.4);
  for (const servo of servos) {
    drawBar(pen, scene.shafts[servo], scene.tips[servo], servoColour(servo), 4.6);
    drawDisc(pen, scene.tips[servo], 2.2, colours.card, colours.ink);
    drawDisc(pen, scene.shafts[servo], 3.4, colours.ink);
    drawDisc(pen, scene.shafts[servo], 1.2, colours.card);
  }
  drawDisc(pen, point, 3.2, '#f0e442', '#222222');
}

/** Draws a pose, the lowest bodies first; `slides` are the distances that the feet slid in this frame, mm. */
export function drawLizard(pen: Pen, plate: Plate, scene: Scene, slides: readonly number[]): void {
  drawSkin(pen, scene);
  for (const servo of SERVOS) drawFoot(pen, scene, servo, slides[servo] ?? 0);
  drawChassis(pen, plate);
  for (const servo of SERVOS) drawLeg(pen, scene, servo);
  drawSlider(pen, scene, 0);
  drawSlider(pen, scene, 1);
  drawFiveBar(pen, scene, 0);
  drawFiveBar(pen, scene, 1);
  for (const { strut } of scene.legs) drawDisc(pen, strut[0], 1.2, palette().card, palette().ink);
}
