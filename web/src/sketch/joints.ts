// The bars and joints of a robot in its neutral pose, and the lengths that result from dragging a joint. The servos
// keep their neutral angles; a crank's tip therefore moves along the crank. Points are in mm in the chassis frame.
import type { Edits, Point, Scene } from '../robot';

/** A joint that the user can drag. */
export interface Joint {
  name: string;
  position: Point;
  /**
   * Returns the edits of lengths that move the joint to `to`. If `isSymmetric`, the lengths that must stay equal
   * change, too.
   */
  makeEdits(to: Point, isSymmetric: boolean): Edits;
}

const toLinkKey = (n: number) => `links.l${n}`;
/** Rounds to 0.5 mm. */
const roundToHalf = (mm: number) => Math.round(mm * 2) / 2;
const computeDistance = ([x, y]: Point, [u, v]: Point) => Math.hypot(x - u, y - v);

/**
 * Returns the distance from `from` to the projection of `to` onto the line from `from` through `towards`; negative on
 * the side away from `towards`.
 */
function projectSignedDistance(from: Point, towards: Point, to: Point): number {
  const length = computeDistance(from, towards) || 1;
  return ((towards[0] - from[0]) * (to[0] - from[0]) + (towards[1] - from[1]) * (to[1] - from[1])) / length;
}

/** The front and rear servo of each side, and the numbers of its links in robot.toml. */
const SIDES = [
  { name: 'left', front: 0, rear: 3, chassis: 10, rearArm: 11, rearHalf: 12, frontHalf: 13, frontArm: 14 },
  { name: 'right', front: 1, rear: 2, chassis: 15, rearArm: 16, rearHalf: 17, frontHalf: 18, frontArm: 19 },
] as const;

/** The left and right servo of each five-bar, and the numbers of its links in robot.toml. */
const ENDS = [
  { name: 'head', left: 0, right: 1, base: 0, leftCrank: 1, leftCoupler: 2, rightCoupler: 3, rightCrank: 4 },
  { name: 'tail', left: 3, right: 2, base: 5, leftCrank: 6, leftCoupler: 7, rightCoupler: 8, rightCrank: 9 },
] as const;

/** Makes a bar between two points; `key` is the key of its length in robot.toml. */
const makeBar = (key: string, from: Point, to: Point) => ({ key, from, to });

/** Returns the bars of the robot's loops and legs in the scene's pose. */
export function listBars({ shafts, tips, points, sliders, legs }: Scene) {
  return [
    ...SIDES.flatMap((side, n) => {
      const { tips: [front, rear], tube } = sliders[n];
      return [
        makeBar(toLinkKey(side.chassis), shafts[side.front], shafts[side.rear]),
        makeBar(toLinkKey(side.frontArm), shafts[side.front], front),
        makeBar(toLinkKey(side.rearArm), shafts[side.rear], rear),
        makeBar(toLinkKey(side.rearHalf), rear, tube),
        makeBar(toLinkKey(side.frontHalf), tube, front),
      ];
    }),
    ...ENDS.flatMap((end, n) => [
      makeBar(toLinkKey(end.base), shafts[end.left], shafts[end.right]),
      makeBar(toLinkKey(end.leftCrank), shafts[end.left], tips[end.left]),
      makeBar(toLinkKey(end.rightCrank), shafts[end.right], tips[end.right]),
      makeBar(toLinkKey(end.leftCoupler), tips[end.left], points[n]),
      makeBar(toLinkKey(end.rightCoupler), tips[end.right], points[n]),
    ]),
    ...legs.flatMap(({ pivots, joints }) => [
      makeBar('leg.ground', pivots[0], pivots[1]),
      makeBar('leg.crank', pivots[0], joints[0]),
      makeBar('leg.coupler', joints[0], joints[1]),
      makeBar('leg.follower', pivots[1], joints[1]),
    ]),
  ];
}

/** Returns the joints that the user can drag; `getLength` returns a length in robot.toml, mm, by its key. */
export function listJoints({ shafts, tips, points, sliders, legs }: Scene, getLength: (key: string) => number): Joint[] {
  /**
   * Returns the edits that lengthen each half of a slider by half of `change`, the change of the distance between its
   * arm tips in mm, so that the slider keeps its travel.
   */
  const editHalves = (side: (typeof SIDES)[number], change: number): Edits =>
    [toLinkKey(side.rearHalf), toLinkKey(side.frontHalf)]
      .map((key) => [key, roundToHalf(getLength(key) + change / 2)]);
  const cranks = ENDS.flatMap((end): Joint[] =>
    (['left', 'right'] as const).map((side) => {
      const servo = end[side];
      const [ownKey, otherKey] = side === 'left' ? [end.leftCrank, end.rightCrank] : [end.rightCrank, end.leftCrank];
      return {
        name: `end of the ${end.name}'s ${side} crank`,
        position: tips[servo],
        makeEdits: (to, isSymmetric) => [ownKey, ...(isSymmetric ? [otherKey] : [])].map((n) => [toLinkKey(n), roundToHalf(projectSignedDistance(shafts[servo], tips[servo], to))]),
      };
    }),
  );
  const endPoints = ENDS.map((end, n): Joint => ({
    name: `point of the ${end.name}`,
    position: points[n],
    makeEdits(to, isSymmetric) {
      const middleX = (tips[end.left][0] + tips[end.right][0]) / 2;
      const point: Point = isSymmetric ? [middleX, to[1]] : to;
      return [[toLinkKey(end.leftCoupler), roundToHalf(computeDistance(tips[end.left], point))], [toLinkKey(end.rightCoupler), roundToHalf(computeDistance(tips[end.right], point))]];
    },
  }));
  const arms = SIDES.flatMap((side, n): Joint[] =>
    (['front', 'rear'] as const).map((end) => {
      const { tips: [front, rear] } = sliders[n];
      const [shaft, tip, key] = end === 'front' ? [shafts[side.front], front, 'frontArm' as const] : [shafts[side.rear], rear, 'rearArm' as const];
      return {
        name: `end of the ${end} ${side.name} arm`,
        position: tip,
        makeEdits(to, isSymmetric) {
          const length = roundToHalf(projectSignedDistance(shaft, tip, to));
          const scale = length / computeDistance(shaft, tip);
          const movedTip: Point = [shaft[0] + scale * (tip[0] - shaft[0]), shaft[1] + scale * (tip[1] - shaft[1])];
          const change = end === 'front' ? computeDistance(movedTip, rear) - computeDistance(front, rear) : computeDistance(front, movedTip) - computeDistance(front, rear);
          return (isSymmetric ? SIDES : [side]).flatMap((movedSide): Edits => [[toLinkKey(movedSide[key]), length], ...editHalves(movedSide, change)]);
        },
      };
    }),
  );
  const bases = ENDS.flatMap((end, n): Joint[] =>
    (['left', 'right'] as const).map((side) => ({
      name: `the ${end.name}'s ${side} servo`,
      position: shafts[end[side]],
      makeEdits(to) {
        const [ownShaft, otherShaft] = [shafts[end[side]], shafts[end[side === 'left' ? 'right' : 'left']]];
        const middleX = (ownShaft[0] + otherShaft[0]) / 2;
        // The head's servos move outward by +y, the tail's by -y.
        const change = roundToHalf((n === 0 ? 1 : -1) * (to[1] - ownShaft[1]));
        // Both sides change, so that equal sides stay equal.
        const chassis = SIDES.flatMap((changedSide): Edits => (change === 0 ? [] : [[toLinkKey(changedSide.chassis), getLength(toLinkKey(changedSide.chassis)) + change], ...editHalves(changedSide, change)]));
        return [[toLinkKey(end.base), roundToHalf(2 * Math.abs(to[0] - middleX))], ...chassis];
      },
    })),
  );
  const knees = legs.map(({ pivots, joints }, n): Joint => ({
    name: `knee of leg ${n + 1}`,
    position: joints[0],
    makeEdits: (to, isSymmetric) => ['leg.crank', ...(isSymmetric ? ['leg.follower'] : [])].map((key) => [key, roundToHalf(projectSignedDistance(pivots[0], joints[0], to))]),
  }));
  return [...bases, ...arms, ...knees, ...cranks, ...endPoints];
}
