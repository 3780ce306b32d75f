// Draws the robot from above, in mm of the chassis frame: x to the right, y forward.
import type { Plate, Scene, Point } from '../robot';
import { circle } from './canvas';
import { palette, servoColour } from './palette';

/** Radius of a foot and width of the plate's edge, mm. */
const FOOT = 6;
const RIM = 0.6;
/** Slide in a frame beyond which a foot counts as slipping, mm. */
const SLIPS = 0.3;

type Pen = CanvasRenderingContext2D;

function bar(pen: Pen, [x1, y1]: Point, [x2, y2]: Point, colour: string, mm: number): void {
  pen.strokeStyle = colour;
  pen.lineWidth = mm;
  pen.lineCap = 'round';
  pen.beginPath();
  pen.moveTo(x1, y1);
  pen.lineTo(x2, y2);
  pen.stroke();
}

function disc(pen: Pen, [x, y]: Point, mm: number, fill: string, edge?: string): void {
  pen.fillStyle = fill;
  pen.beginPath();
  circle(pen, x, y, mm);
  pen.fill();
  if (edge === undefined) return;
  pen.strokeStyle = edge;
  pen.lineWidth = 0.8;
  pen.stroke();
}

/** Number of turns of a drawn spring, and half its width, mm. */
const TURNS = 5;
const COIL = 2.4;

/** Draws a spring between two hooks. */
function coil(pen: Pen, [x1, y1]: Point, [x2, y2]: Point): void {
  const length = Math.hypot(x2 - x1, y2 - y1);
  if (length < 1) return;
  const [along, across] = [[(x2 - x1) / length, (y2 - y1) / length], [(y1 - y2) / length, (x2 - x1) / length]];
  const at = (share: number, side: number): Point => [
    x1 + along[0] * share * length + across[0] * side,
    y1 + along[1] * share * length + across[1] * side,
  ];
  pen.strokeStyle = palette().steel;
  pen.lineWidth = 0.9;
  pen.lineJoin = 'round';
  pen.beginPath();
  pen.moveTo(x1, y1);
  pen.lineTo(...at(0.12, 0));
  for (let n = 0; n < 2 * TURNS; n++) pen.lineTo(...at(0.12 + (0.76 * (n + 0.5)) / (2 * TURNS), n % 2 === 0 ? COIL : -COIL));
  pen.lineTo(...at(0.88, 0));
  pen.lineTo(x2, y2);
  pen.stroke();
}

/** Draws the outline of an animal from the head's point to the tail's. */
function skin(pen: Pen, scene: Scene): void {
  const [[hx, hy], [tx, ty]] = scene.points;
  const back = Math.max(...scene.shafts.map(([, y]) => y));
  const neck = back + 16;
  const flank = back * 0.74;
  pen.beginPath();
  pen.moveTo(hx, hy + 30);
  pen.bezierCurveTo(hx + 18, hy + 30, hx + 27, hy + 2, 27, neck);
  pen.bezierCurveTo(44, flank, 44, -flank, 27, -neck);
  pen.bezierCurveTo(tx + 22, ty, tx + 6, ty - 6, tx + 3, ty - 40);
  pen.lineTo(tx - 3, ty - 40);
  pen.bezierCurveTo(tx - 6, ty - 6, tx - 22, ty, -27, -neck);
  pen.bezierCurveTo(-44, -flank, -44, flank, -27, neck);
  pen.bezierCurveTo(hx - 27, hy + 2, hx - 18, hy + 30, hx, hy + 30);
  pen.fillStyle = palette().skin;
  pen.strokeStyle = palette()['skin-edge'];
  pen.lineWidth = 1;
  pen.fill();
  pen.stroke();
  for (const side of [-9, 9]) disc(pen, [hx + side, hy + 12], 2.3, palette().ink);
}

const SERVOS = [0, 1, 2, 3];

/** Draws a leg's bodies beside and below the plate: foot, leaf and coupler. */
function foot(pen: Pen, scene: Scene, servo: number, slide: number): void {
  const colours = palette();
  const { joints, foot } = scene.legs[servo];
  bar(pen, joints[1], foot, colours.steel, 2.2);
  // A foot that holds is filled; one that slips is a ring.
  disc(pen, foot, FOOT, slide > SLIPS ? colours.card : colours.ink);
  pen.strokeStyle = colours.ink;
  pen.lineWidth = 2;
  pen.stroke();
  bar(pen, joints[0], joints[1], servoColour(servo), 4.2);
}

/** Draws the plate, its arms that carry the legs' pivots, and the servos' cases. */
function chassis(pen: Pen, plate: Plate): void {
  const colours = palette();
  const [wide, long] = plate.half;
  for (const [rim, colour] of [[RIM, colours['frame-edge']], [0, colours.frame]] as const) {
    for (const [from, to] of plate.arms) bar(pen, from, to, colour, 2 * (plate.arm + rim));
    pen.fillStyle = colour;
    pen.beginPath();
    pen.roundRect(-wide - rim, -long - rim, 2 * (wide + rim), 2 * (long + rim), plate.corner + rim);
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
function leg(pen: Pen, scene: Scene, servo: number): void {
  const colours = palette();
  const { pivots, joints, strut, sprung } = scene.legs[servo];
  const colour = servoColour(servo);
  bar(pen, pivots[0], strut[1], colour, 3.2);
  for (const n of [0, 1]) bar(pen, pivots[n], joints[n], colour, 3.2);
  for (const spot of [...pivots, ...joints]) disc(pen, spot, 1.6, colours.card, colours.ink);
  bar(pen, strut[0], strut[1], colours.steel, sprung ? 0.8 : 1.6);
  if (sprung) coil(pen, strut[0], strut[1]);
  disc(pen, strut[1], 1.2, colours.card, colours.ink);
  bar(pen, scene.shafts[servo], strut[0], colour, 3);
}

function slider(pen: Pen, scene: Scene, side: 0 | 1): void {
  const colours = palette();
  const { shafts, tips, tube } = scene.sliders[side];
  bar(pen, tips[0], tips[1], colours.steel, 1.8);
  bar(pen, tips[1], tube, colours.tube, 5);
  const servos = side === 0 ? [0, 3] : [1, 2];
  servos.forEach((servo, n) => {
    pen.globalAlpha = 0.75;
    bar(pen, shafts[n], tips[n], servoColour(servo), 3);
    pen.globalAlpha = 1;
    disc(pen, tips[n], 2, colours.card, colours.ink);
  });
}

function fiveBar(pen: Pen, scene: Scene, end: 0 | 1): void {
  const colours = palette();
  const servos = end === 0 ? [0, 1] : [2, 3];
  const point = scene.points[end];
  for (const servo of servos) bar(pen, scene.tips[servo], point, colours.steel, 3.4);
  for (const servo of servos) {
    bar(pen, scene.shafts[servo], scene.tips[servo], servoColour(servo), 4.6);
    disc(pen, scene.tips[servo], 2.2, colours.card, colours.ink);
    disc(pen, scene.shafts[servo], 3.4, colours.ink);
    disc(pen, scene.shafts[servo], 1.2, colours.card);
  }
  disc(pen, point, 3.2, '#f0e442', '#222222');
}

/** Draws a pose, the lowest bodies first; `slides` is the distance that each foot slid in this frame, mm. */
export function drawLizard(pen: Pen, plate: Plate, scene: Scene, slides: readonly number[]): void {
  skin(pen, scene);
  for (const servo of SERVOS) foot(pen, scene, servo, slides[servo] ?? 0);
  chassis(pen, plate);
  for (const servo of SERVOS) leg(pen, scene, servo);
  slider(pen, scene, 0);
  slider(pen, scene, 1);
  fiveBar(pen, scene, 0);
  fiveBar(pen, scene, 1);
  for (const { strut } of scene.legs) disc(pen, strut[0], 1.2, palette().card, palette().ink);
}
