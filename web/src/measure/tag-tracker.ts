// Tracks the tags in the latest pictures: the tags that are hidden, the robot's place and its path. Lengths are
// measured in the picture, scaled by the floor's tags: precise enough to warn that the robot is about to leave the
// sheet, but not to measure a gait.
import type { Pixel, TagEntry as Tag } from '../../generated/measure';
import type { Detection } from './worker';

/** The names of the tags, by their ids. */
const TAG_NAMES = ['the left tag of strip 1', 'the right tag of strip 1', 'the left tag of strip 2', 'the right tag of strip 2', 'the tag on the deck'];
/** The id of the tag on the robot's deck. */
const DECK_ID = 4;
/** Edge length of a tag on the floor, mm. */
const EDGE_MM = 50;
/** Distance beyond the floor's tags at which the robot is about to leave the sheet, mm. */
const NEAR_MM = 50;
/** Distance from the picture's edge within which the robot is about to leave the picture, mm. */
const PICTURE_MARGIN_MM = 150;
/** Time over which the rate of pictures is averaged, ms. */
const RATE_WINDOW_MS = 2000;
/** Number of consecutive pictures without a tag after which the tag counts as hidden. */
const MAX_MISSED_PICTURES = 3;

const minus = (a: Pixel, b: Pixel): Pixel => [a[0] - b[0], a[1] - b[1]];
const lengthOf = ([x, y]: Pixel) => Math.hypot(x, y);
const mean = (points: Pixel[]): Pixel => [0, 1].map((i) => points.reduce((sum, point) => sum + (point[i] ?? 0), 0) / points.length) as Pixel;

/** The vector from the deck's tag to the middle of the floor's tags, in the robot's frame, mm. */
export interface OffsetToMiddle {
  forward: number;
  left: number;
  /** Distance from the middle beyond which the robot is near the edge of the sheet, mm. */
  reach: number;
  /** True if the robot is beyond `reach`, or near the edge of the picture. */
  isNear: boolean;
}

export class TagTracker {
  /** Width and height of the last picture, px. */
  size: [number, number] = [1, 1];
  /** The tags of the last picture. */
  tags: Tag[] = [];
  /** The middle of the deck's tag in each picture so far that shows it. */
  path: Pixel[] = [];
  /** Time that the search for tags in the last picture took, ms. */
  searchMs = 0;
  /** The tags of the floor as last seen, by their ids. */
  private readonly floorTags: (Tag | undefined)[] = [];
  /** Number of consecutive pictures, up to the last one, that do not show a tag, by the tag's id. */
  private readonly missedPictures = TAG_NAMES.map(() => MAX_MISSED_PICTURES);
  /** Arrival times of the pictures of the last `RATE_WINDOW_MS`, on the page's clock, ms. */
  private readonly arrivalTimes: number[] = [];

  /** Adds the tags that were detected in the next picture. */
  addDetection({ tags, size, searchMs }: Detection): void {
    Object.assign(this, { tags, size, searchMs });
    for (const id of TAG_NAMES.keys()) this.missedPictures[id] = tags.some((tag) => tag.id === id) ? 0 : (this.missedPictures[id] ?? 0) + 1;
    for (const tag of tags) if (tag.id !== DECK_ID) this.floorTags[tag.id] = tag;
    if (this.deck) this.path.push(mean(this.deck.corners));
    this.arrivalTimes.push(performance.now());
    while ((this.arrivalTimes[0] ?? 0) < performance.now() - RATE_WINDOW_MS) this.arrivalTimes.shift();
  }

  /** The rate of the latest pictures, 1/s. */
  get picturesPerSecond(): number {
    const [first, last] = [this.arrivalTimes[0], this.arrivalTimes.at(-1)];
    return first === undefined || last === undefined || last === first ? 0 : (1000 * (this.arrivalTimes.length - 1)) / (last - first);
  }

  /** The deck's tag in the last picture; undefined if the picture does not show it. */
  get deck(): Tag | undefined {
    return this.tags.find(({ id }) => id === DECK_ID);
  }

  /** The vector toward the robot's head in the picture, as long as the deck's tag; null if that tag is not seen. */
  get heading(): Pixel | null {
    if (!this.deck) return null;
    const [a, b, c, d] = this.deck.corners;
    return minus(mean([a, b]), mean([c, d]));
  }

  /** A sentence that names the tags that are not seen; empty if all are seen. */
  get hiddenTagsMessage(): string {
    const hiddenNames = TAG_NAMES.filter((_, id) => (this.missedPictures[id] ?? 0) >= MAX_MISSED_PICTURES);
    if (hiddenNames.length === 0) return '';
    if (hiddenNames.length === TAG_NAMES.length) return 'No tag of the sheet is seen: film from above, near enough and in even light, and not mirrored.';
    const last = hiddenNames.pop() ?? '';
    return `Not seen: ${hiddenNames.length > 0 ? `${hiddenNames.join(', ')} and ${last}` : last}.`;
  }

  /** The vector from the robot to the middle; null if the deck's tag or all tags of the floor are unknown. */
  get offsetToMiddle(): OffsetToMiddle | null {
    const { heading, deck, size } = this;
    const floor = this.floorTags.filter((tag) => tag !== undefined);
    if (!heading || !deck || floor.length === 0) return null;
    const middles = floor.map(({ corners }) => mean(corners));
    const edges = floor.map(({ corners }) => lengthOf(minus(corners[0], corners[1])));
    const scale = EDGE_MM / (edges.reduce((sum, edge) => sum + edge, 0) / edges.length);
    const [deckMiddle, middle] = [mean(deck.corners), mean(middles)];
    const offset = minus(middle, deckMiddle);
    const headingLength = lengthOf(heading);
    const forward = ((offset[0] * heading[0] + offset[1] * heading[1]) / headingLength) * scale;
    const left = ((offset[0] * heading[1] - offset[1] * heading[0]) / headingLength) * scale;
    const reach = Math.max(...middles.map((point) => lengthOf(minus(point, middle)))) * scale + NEAR_MM;
    const edge = Math.min(deckMiddle[0], deckMiddle[1], size[0] - deckMiddle[0], size[1] - deckMiddle[1]) * scale;
    return { forward, left, reach, isNear: Math.hypot(forward, left) > reach || edge < PICTURE_MARGIN_MM };
  }

  /** Clears the path. */
  clear(): void {
    this.path = [];
  }
}
