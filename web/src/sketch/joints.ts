// The bars and joints of a robot in its neutral pose, and the lengths that follow when a joint is dragged. Servos
// keep their neutral angles, so the end of a crank moves along its crank.
import type { Edits, Point, Scene } from '../robot';

/** A bar between two points: its key in robot.toml. */
export interface Bar {
  key: string;
  from: Point;
  to: Point;
}

/** A joint that can be dragged. */
export interface Joint {
  name: string;
  at: Point;
  /** The lengths with the joint at a point; `alike` keeps left and right equal. */
  moved(to: Point, alike: boolean): Edits;
}

const links = (n: number) => `links.l${n}`;
/** Lengths are whole halves of a mm. */
const round = (mm: number) => Math.round(mm * 2) / 2;
const distance = ([x, y]: Point, [u, v]: Point) => Math.hypot(x - u, y - v);

/** Distance of a point from another along the direction to a third. */
function along(from: Point, towards: Point, to: Point): number {
  const length = distance(from, towards) || 1;
  return ((towards[0] - from[0]) * (to[0] - from[0]) + (towards[1] - from[1]) * (to[1] - from[1])) / length;
}

/** Each side's front and rear servo and the numbers of its lengths. */
const SIDES = [
  { name: 'left', front: 0, rear: 3, chassis: 10, rearArm: 11, rearHalf: 12, frontHalf: 13, frontArm: 14 },
  { name: 'right', front: 1, rear: 2, chassis: 15, rearArm: 16, rearHalf: 17, frontHalf: 18, frontArm: 19 },
] as const;

/** Each end's left and right servo and the numbers of its lengths. */
const ENDS = [
  { name: 'head', left: 0, right: 1, base: 0, leftCrank: 1, leftCoupler: 2, rightCoupler: 3, rightCrank: 4 },
  { name: 'tail', left: 3, right: 2, base: 5, leftCrank: 6, leftCoupler: 7, rightCoupler: 8, rightCrank: 9 },
] as const;

export function bars({ shafts, tips, points, sliders, legs }: Scene): Bar[] {
  const bar = (key: string, from: Point, to: Point): Bar => ({ key, from, to });
  return [
    ...SIDES.flatMap((side, n) => {
      const { tips: [front, rear], tube } = sliders[n];
      return [
        bar(links(side.chassis), shafts[side.front], shafts[side.rear]),
        bar(links(side.frontArm), shafts[side.front], front),
        bar(links(side.rearArm), shafts[side.rear], rear),
        bar(links(side.rearHalf), rear, tube),
        bar(links(side.frontHalf), tube, front),
      ];
    }),
    ...ENDS.flatMap((end, n) => [
      bar(links(end.base), shafts[end.left], shafts[end.right]),
      bar(links(end.leftCrank), shafts[end.left], tips[end.left]),
      bar(links(end.rightCrank), shafts[end.right], tips[end.right]),
      bar(links(end.leftCoupler), tips[end.left], points[n]),
      bar(links(end.rightCoupler), tips[end.right], points[n]),
    ]),
    ...legs.flatMap(({ pivots, joints }) => [
      bar('leg.ground', pivots[0], pivots[1]),
      bar('leg.crank', pivots[0], joints[0]),
      bar('leg.coupler', joints[0], joints[1]),
      bar('leg.follower', pivots[1], joints[1]),
    ]),
  ];
}

export function joints({ shafts, tips, points, sliders, legs }: Scene, value: (key: string) => number): Joint[] {
  /** Changes both halves of a slider with the distance of its ends, so that its travel is unchanged. */
  const halves = (side: (typeof SIDES)[number], longer: number): Edits => [
    [links(side.rearHalf), round(value(links(side.rearHalf)) + longer / 2)],
    [links(side.frontHalf), round(value(links(side.frontHalf)) + longer / 2)],
  ];
  const cranks = ENDS.flatMap((end): Joint[] =>
    (['left', 'right'] as const).map((hand) => {
      const servo = end[hand];
      const [own, other] = hand === 'left' ? [end.leftCrank, end.rightCrank] : [end.rightCrank, end.leftCrank];
      return {
        name: `end of the ${end.name}'s ${hand} crank`,
        at: tips[servo],
        moved: (to, alike) => [own, ...(alike ? [other] : [])].map((n) => [links(n), round(along(shafts[servo], tips[servo], to))]),
      };
    }),
  );
  const ends = ENDS.map((end, n): Joint => ({
    name: `point of the ${end.name}`,
    at: points[n],
    moved(to, alike) {
      const middle = (tips[end.left][0] + tips[end.right][0]) / 2;
      const at: Point = alike ? [middle, to[1]] : to;
      return [[links(end.leftCoupler), round(distance(tips[end.left], at))], [links(end.rightCoupler), round(distance(tips[end.right], at))]];
    },
  }));
  const arms = SIDES.flatMap((side, n): Joint[] =>
    (['front', 'rear'] as const).map((place, which) => {
      const { tips: [front, rear] } = sliders[n];
      const [shaft, tip, key] = place === 'front' ? [shafts[side.front], front, 'frontArm' as const] : [shafts[side.rear], rear, 'rearArm' as const];
      return {
        name: `end of the ${place} ${side.name} arm`,
        at: [front, rear][which],
        moved(to, alike) {
          const length = round(along(shaft, tip, to));
          const share = length / distance(shaft, tip);
          const moved: Point = [shaft[0] + share * (tip[0] - shaft[0]), shaft[1] + share * (tip[1] - shaft[1])];
          const longer = place === 'front' ? distance(moved, rear) - distance(front, rear) : distance(front, moved) - distance(front, rear);
          return (alike ? SIDES : [side]).flatMap((each): Edits => [[links(each[key]), length], ...halves(each, longer)]);
        },
      };
    }),
  );
  const bases = ENDS.flatMap((end, n): Joint[] =>
    (['left', 'right'] as const).map((hand) => ({
      name: `the ${end.name}'s ${hand} servo`,
      at: shafts[end[hand]],
      moved(to) {
        const [own, other] = [shafts[end[hand]], shafts[end[hand === 'left' ? 'right' : 'left']]];
        const middle = (own[0] + other[0]) / 2;
        const longer = round((n === 0 ? 1 : -1) * (to[1] - own[1]));
        // Both sides, so that the chassis stays a rectangle or a trapezium.
        const chassis = SIDES.flatMap((side): Edits => (longer === 0 ? [] : [[links(side.chassis), value(links(side.chassis)) + longer], ...halves(side, longer)]));
        return [[links(end.base), round(2 * Math.abs(to[0] - middle))], ...chassis];
      },
    })),
  );
  const knees = legs.map(({ pivots, joints }, n): Joint => ({
    name: `knee of leg ${n + 1}`,
    at: joints[0],
    moved: (to, alike) => ['leg.crank', ...(alike ? ['leg.follower'] : [])].map((key) => [key, round(along(pivots[0], joints[0], to))]),
  }));
  return [...bases, ...arms, ...knees, ...cranks, ...ends];
}
