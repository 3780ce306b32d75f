// The bars and joints of a robot in its neutral pose, and the lengths that result when a joint is dragged. The servos
// keep their neutral angles, so the tip of a crank moves along the crank. Points are in mm of the chassis frame.
import type { Edits, Point, Scene } from '../robot';

/** A bar between two points, with the key of its length in robot.toml. */
export interface Bar {
  key: string;
  from: Point;
  to: Point;
}

/** A joint that can be dragged. */
export interface Joint {
  name: string;
  position: Point;
  /** Returns the edits of lengths that move the joint to `to`. If `isSymmetric`, the mirrored lengths change, too. */
  editsFor(to: Point, isSymmetric: boolean): Edits;
}

const linkKey = (n: number) => `links.l${n}`;
/** Rounds to 0.5 mm. */
const round = (mm: number) => Math.round(mm * 2) / 2;
const distance = ([x, y]: Point, [u, v]: Point) => Math.hypot(x - u, y - v);

/** Returns the distance from `from` to the projection of `to` on the line from `from` through `towards`. */
function distanceAlong(from: Point, towards: Point, to: Point): number {
  const length = distance(from, towards) || 1;
  return ((towards[0] - from[0]) * (to[0] - from[0]) + (towards[1] - from[1]) * (to[1] - from[1])) / length;
}

/** The front and rear servo of each side, and the numbers of its links in robot.toml. */
const SIDES = [
  { name: 'left', front: 0, rear: 3, chassis: 10, rearArm: 11, rearHalf: 12, frontHalf: 13, frontArm: 14 },
  { name: 'right', front: 1, rear: 2, chassis: 15, rearArm: 16, rearHalf: 17, frontHalf: 18, frontArm: 19 },
] as const;

/** The left and right servo of each five-bar (head, tail), and the numbers of its links in robot.toml. */
const ENDS = [
  { name: 'head', left: 0, right: 1, base: 0, leftCrank: 1, leftCoupler: 2, rightCoupler: 3, rightCrank: 4 },
  { name: 'tail', left: 3, right: 2, base: 5, leftCrank: 6, leftCoupler: 7, rightCoupler: 8, rightCrank: 9 },
] as const;

/** Returns the bars of the robot's loops and legs in the scene's pose. */
export function bars({ shafts, tips, points, sliders, legs }: Scene): Bar[] {
  const barOf = (key: string, from: Point, to: Point): Bar => ({ key, from, to });
  return [
    ...SIDES.flatMap((side, n) => {
      const { tips: [front, rear], tube } = sliders[n];
      return [
        barOf(linkKey(side.chassis), shafts[side.front], shafts[side.rear]),
        barOf(linkKey(side.frontArm), shafts[side.front], front),
        barOf(linkKey(side.rearArm), shafts[side.rear], rear),
        barOf(linkKey(side.rearHalf), rear, tube),
        barOf(linkKey(side.frontHalf), tube, front),
      ];
    }),
    ...ENDS.flatMap((end, n) => [
      barOf(linkKey(end.base), shafts[end.left], shafts[end.right]),
      barOf(linkKey(end.leftCrank), shafts[end.left], tips[end.left]),
      barOf(linkKey(end.rightCrank), shafts[end.right], tips[end.right]),
      barOf(linkKey(end.leftCoupler), tips[end.left], points[n]),
      barOf(linkKey(end.rightCoupler), tips[end.right], points[n]),
    ]),
    ...legs.flatMap(({ pivots, joints }) => [
      barOf('leg.ground', pivots[0], pivots[1]),
      barOf('leg.crank', pivots[0], joints[0]),
      barOf('leg.coupler', joints[0], joints[1]),
      barOf('leg.follower', pivots[1], joints[1]),
    ]),
  ];
}

/** Returns the joints that can be dragged; `lengthOf` returns a length in robot.toml, mm, by its key. */
export function joints({ shafts, tips, points, sliders, legs }: Scene, lengthOf: (key: string) => number): Joint[] {
  /**
   * Lengthens each half of a slider by half the change of the distance between its arm tips, so that the slider keeps
   * its travel.
   */
  const halfEdits = (side: (typeof SIDES)[number], change: number): Edits => [
    [linkKey(side.rearHalf), round(lengthOf(linkKey(side.rearHalf)) + change / 2)],
    [linkKey(side.frontHalf), round(lengthOf(linkKey(side.frontHalf)) + change / 2)],
  ];
  const cranks = ENDS.flatMap((end): Joint[] =>
    (['left', 'right'] as const).map((side) => {
      const servo = end[side];
      const [ownKey, otherKey] = side === 'left' ? [end.leftCrank, end.rightCrank] : [end.rightCrank, end.leftCrank];
      return {
        name: `end of the ${end.name}'s ${side} crank`,
        position: tips[servo],
        editsFor: (to, isSymmetric) => [ownKey, ...(isSymmetric ? [otherKey] : [])].map((n) => [linkKey(n), round(distanceAlong(shafts[servo], tips[servo], to))]),
      };
    }),
  );
  const ends = ENDS.map((end, n): Joint => ({
    name: `point of the ${end.name}`,
    position: points[n],
    editsFor(to, isSymmetric) {
      const middleX = (tips[end.left][0] + tips[end.right][0]) / 2;
      const point: Point = isSymmetric ? [middleX, to[1]] : to;
      return [[linkKey(end.leftCoupler), round(distance(tips[end.left], point))], [linkKey(end.rightCoupler), round(distance(tips[end.right], point))]];
    },
  }));
  const arms = SIDES.flatMap((side, n): Joint[] =>
    (['front', 'rear'] as const).map((end) => {
      const { tips: [front, rear] } = sliders[n];
      const [shaft, tip, key] = end === 'front' ? [shafts[side.front], front, 'frontArm' as const] : [shafts[side.rear], rear, 'rearArm' as const];
      return {
        name: `end of the ${end} ${side.name} arm`,
        position: tip,
        editsFor(to, isSymmetric) {
          const length = round(distanceAlong(shaft, tip, to));
          const scale = length / distance(shaft, tip);
          const movedTip: Point = [shaft[0] + scale * (tip[0] - shaft[0]), shaft[1] + scale * (tip[1] - shaft[1])];
          const change = end === 'front' ? distance(movedTip, rear) - distance(front, rear) : distance(front, movedTip) - distance(front, rear);
          return (isSymmetric ? SIDES : [side]).flatMap((movedSide): Edits => [[linkKey(movedSide[key]), length], ...halfEdits(movedSide, change)]);
        },
      };
    }),
  );
  const bases = ENDS.flatMap((end, n): Joint[] =>
    (['left', 'right'] as const).map((side) => ({
      name: `the ${end.name}'s ${side} servo`,
      position: shafts[end[side]],
      editsFor(to) {
        const [ownShaft, otherShaft] = [shafts[end[side]], shafts[end[side === 'left' ? 'right' : 'left']]];
        const middleX = (ownShaft[0] + otherShaft[0]) / 2;
        // The head's servos move outward by +y, the tail's by -y.
        const change = round((n === 0 ? 1 : -1) * (to[1] - ownShaft[1]));
        // Both sides change, so that equal sides stay equal: a rectangle or an isosceles trapezium.
        const chassis = SIDES.flatMap((side): Edits => (change === 0 ? [] : [[linkKey(side.chassis), lengthOf(linkKey(side.chassis)) + change], ...halfEdits(side, change)]));
        return [[linkKey(end.base), round(2 * Math.abs(to[0] - middleX))], ...chassis];
      },
    })),
  );
  const knees = legs.map(({ pivots, joints }, n): Joint => ({
    name: `knee of leg ${n + 1}`,
    position: joints[0],
    editsFor: (to, isSymmetric) => ['leg.crank', ...(isSymmetric ? ['leg.follower'] : [])].map((key) => [key, round(distanceAlong(pivots[0], joints[0], to))]),
  }));
  return [...bases, ...arms, ...knees, ...cranks, ...ends];
}
