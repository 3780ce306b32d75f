// The lizard from above, drawn in mm of its own frame: x to the right, y ahead.
import type { Scene, Spot } from '../robot';
import { palette, servoColour } from './palette';

/** An SG-90's body seen from above, and how far its shaft is from its end, mm. */
const SERVO_WIDTH = 12.2;
const SERVO_LENGTH = 22.8;
const SERVO_SHAFT = 6;
/** A foot that moves farther than this over the floor in a frame slips, mm. */
const SLIPS = 0.3;

type Pen = CanvasRenderingContext2D;

function bar(pen: Pen, [x1, y1]: Spot, [x2, y2]: Spot, colour: string, mm: number): void {
  pen.strokeStyle = colour;
  pen.lineWidth = mm;
  pen.lineCap = 'round';
  pen.beginPath();
  pen.moveTo(x1, y1);
  pen.lineTo(x2, y2);
  pen.stroke();
}

function disc(pen: Pen, [x, y]: Spot, mm: number, fill: string, edge?: string): void {
  pen.fillStyle = fill;
  pen.beginPath();
  pen.arc(x, y, mm, 0, 2 * Math.PI);
  pen.fill();
  if (edge === undefined) return;
  pen.strokeStyle = edge;
  pen.lineWidth = 0.8;
  pen.stroke();
}

/** Turns of a spring, and how far they are to either side, mm. */
const TURNS = 5;
const COIL = 2.4;

/** A spring between two hooks. */
function coil(pen: Pen, [x1, y1]: Spot, [x2, y2]: Spot): void {
  const length = Math.hypot(x2 - x1, y2 - y1);
  if (length < 1) return;
  const [along, across] = [[(x2 - x1) / length, (y2 - y1) / length], [(y1 - y2) / length, (x2 - x1) / length]];
  const at = (share: number, side: number): Spot => [
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

/** An outline in the shape of an animal, between the head's point and the tail's. */
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

function chassis(pen: Pen, scene: Scene): void {
  const colours = palette();
  const half = Math.max(...scene.shafts.map(([x]) => Math.abs(x))) + 9;
  const top = scene.shafts[0][1] + 8;
  pen.fillStyle = colours.frame;
  pen.strokeStyle = colours['frame-edge'];
  pen.lineWidth = 0.8;
  pen.beginPath();
  pen.roundRect(-half, -top, 2 * half, 2 * top, 5);
  pen.fill();
  pen.stroke();
  scene.shafts.forEach(([x, y], servo) => {
    const outward = Math.sign(y);
    const near = y + outward * SERVO_SHAFT;
    const far = y - outward * (SERVO_LENGTH - SERVO_SHAFT);
    pen.globalAlpha = 0.35;
    pen.fillStyle = servoColour(servo);
    pen.beginPath();
    pen.roundRect(x - SERVO_WIDTH / 2, Math.min(near, far), SERVO_WIDTH, SERVO_LENGTH, 1.5);
    pen.fill();
    pen.globalAlpha = 1;
  });
}

function leg(pen: Pen, scene: Scene, servo: number, slide: number): void {
  const colours = palette();
  const { pivots, joints, foot, spring } = scene.legs[servo];
  const colour = servoColour(servo);
  bar(pen, pivots[0], pivots[1], colours['frame-edge'], 5);
  for (const n of [0, 1]) bar(pen, pivots[n], joints[n], colour, 3.2);
  bar(pen, joints[0], joints[1], colour, 4.2);
  if (spring) coil(pen, spring[0], spring[1]);
  for (const spot of [...pivots, ...joints]) disc(pen, spot, 1.6, colours.card, colours.ink);
  // A foot that holds is filled, one that slips is a ring.
  disc(pen, foot, 5, slide > SLIPS ? colours.card : colours.ink);
  pen.strokeStyle = colours.ink;
  pen.lineWidth = 2;
  pen.stroke();
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

/** Draws a pose; `slides` is how far each foot slid in this frame, mm. */
export function drawLizard(pen: Pen, scene: Scene, slides: readonly number[]): void {
  skin(pen, scene);
  for (const servo of [0, 1, 2, 3]) leg(pen, scene, servo, slides[servo] ?? 0);
  chassis(pen, scene);
  slider(pen, scene, 0);
  slider(pen, scene, 1);
  fiveBar(pen, scene, 0);
  fiveBar(pen, scene, 1);
}
