// The tags of the last pictures: which tags are missing, the robot's place, and its path. Lengths are measured in the
// picture with the floor's tags as the scale: precise enough to warn that the robot is about to leave, not to measure
// a gait.
import type { Pixel, TagEntry as Tag } from '../../generated/measure';
import type { Sight } from './worker';

/** Names of the tags by their ids. */
const NAMES = ['the left tag of strip 1', 'the right tag of strip 1', 'the left tag of strip 2', 'the right tag of strip 2', 'the tag on the deck'];
const DECK = 4;
/** Edge of a tag on the floor, mm. */
const EDGE_MM = 50;
/**
 * Distance beyond the floor's tags, and distance from the picture's edge, from which the robot is about to leave, mm.
 */
const NEAR_MM = 50;
const PICTURE_MARGIN_MM = 150;
/** Time over which the rate of pictures is counted, ms. */
const RECENT_MS = 2000;
/** Number of pictures without a tag after which the tag counts as hidden. */
const MAX_MISSED = 3;

const minus = (a: Pixel, b: Pixel): Pixel => [a[0] - b[0], a[1] - b[1]];
const lengthOf = ([x, y]: Pixel) => Math.hypot(x, y);
const mean = (points: Pixel[]): Pixel => [0, 1].map((i) => points.reduce((sum, point) => sum + (point[i] ?? 0), 0) / points.length) as Pixel;

/**
 * The displacement from the deck's tag to the middle of the floor's tags, mm: ahead, and to the left, of the robot.
 */
export interface Back {
  ahead: number;
  aside: number;
  /** Distance from the middle beyond which the robot is near the edge, mm. */
  reach: number;
  /** True if the robot is beyond `reach`, or near the picture's edge. */
  isNear: boolean;
}

export class TagTracker {
  size: [number, number] = [1, 1];
  /** The tags of the last picture. */
  tags: Tag[] = [];
  /** Middles of the deck's tag in the pictures so far. */
  path: Pixel[] = [];
  /** Time that the search for tags in the last picture took, ms. */
  ms = 0;
  private readonly floor: (Tag | undefined)[] = [];
  private readonly missed = NAMES.map(() => MAX_MISSED);
  private readonly times: number[] = [];

  take({ tags, size, ms }: Sight): void {
    Object.assign(this, { tags, size, ms });
    for (const id of NAMES.keys()) this.missed[id] = tags.some((tag) => tag.id === id) ? 0 : (this.missed[id] ?? 0) + 1;
    for (const tag of tags) if (tag.id !== DECK) this.floor[tag.id] = tag;
    if (this.deck) this.path.push(mean(this.deck.corners));
    this.times.push(performance.now());
    while ((this.times[0] ?? 0) < performance.now() - RECENT_MS) this.times.shift();
  }

  /** Pictures per second. */
  get rate(): number {
    const [first, last] = [this.times[0], this.times.at(-1)];
    return first === undefined || last === undefined || last === first ? 0 : (1000 * (this.times.length - 1)) / (last - first);
  }

  get deck(): Tag | undefined {
    return this.tags.find(({ id }) => id === DECK);
  }

  /** Direction of the robot's head in the picture, as long as the deck's tag; null if that tag is not seen. */
  get heading(): Pixel | null {
    if (!this.deck) return null;
    const [a, b, c, d] = this.deck.corners;
    return minus(mean([a, b]), mean([c, d]));
  }

  /** The tags that are not seen, as a sentence; empty if all are. */
  get trouble(): string {
    const hiddenNames = NAMES.filter((_, id) => (this.missed[id] ?? 0) >= MAX_MISSED);
    if (hiddenNames.length === 0) return '';
    if (hiddenNames.length === NAMES.length) return 'No tag of the sheet is seen: film from above, near enough and in even light, and not mirrored.';
    const last = hiddenNames.pop() ?? '';
    return `Not seen: ${hiddenNames.length > 0 ? `${hiddenNames.join(', ')} and ${last}` : last}.`;
  }

  /** The robot's displacement back to the middle; null if the deck's tag or all tags of the floor are unknown. */
  get back(): Back | null {
    const { heading, deck, size } = this;
    const floor = this.floor.filter((tag) => tag !== undefined);
    if (!heading || !deck || floor.length === 0) return null;
    const middles = floor.map(({ corners }) => mean(corners));
    const edges = floor.map(({ corners }) => lengthOf(minus(corners[0], corners[1])));
    const scale = EDGE_MM / (edges.reduce((sum, edge) => sum + edge, 0) / edges.length);
    const [deckMiddle, middle] = [mean(deck.corners), mean(middles)];
    const offset = minus(middle, deckMiddle);
    const headingLength = lengthOf(heading);
    const ahead = ((offset[0] * heading[0] + offset[1] * heading[1]) / headingLength) * scale;
    const aside = ((offset[0] * heading[1] - offset[1] * heading[0]) / headingLength) * scale;
    const reach = Math.max(...middles.map((point) => lengthOf(minus(point, middle)))) * scale + NEAR_MM;
    const edge = Math.min(deckMiddle[0], deckMiddle[1], size[0] - deckMiddle[0], size[1] - deckMiddle[1]) * scale;
    return { ahead, aside, reach, isNear: Math.hypot(ahead, aside) > reach || edge < PICTURE_MARGIN_MM };
  }

  /** Forgets the path. */
  clear(): void {
    this.path = [];
  }
}
