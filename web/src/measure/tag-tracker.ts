// Tracks the tags in the latest frames: the hidden tags, the robot's position and its path. Lengths are measured in the
// frame and scaled by the floor tags, which is precise enough for a warning that the robot is about to leave the sheet,
// but not for the measurement of a gait.
import type { Pixel, TagEntry as Tag } from '../../generated/measure';
import type { Detection } from './worker';

/** The names of the tags, indexed by their ids. */
const TAG_NAMES = ['the left tag of strip 1', 'the right tag of strip 1', 'the left tag of strip 2', 'the right tag of strip 2', 'the tag on the deck'];
/** The id of the tag on the robot's deck. */
const DECK_TAG_ID = 4;
/** Edge length of a floor tag, mm. */
const TAG_EDGE_MM = 50;
/** Distance beyond the floor tags at which the robot is about to leave the sheet, mm. */
const SHEET_MARGIN_MM = 50;
/** Distance from the frame's edge at which the robot is about to leave the frame, mm. */
const FRAME_MARGIN_MM = 150;
/** Time over which the frame rate is averaged, ms. */
const FRAME_RATE_WINDOW_MS = 2000;
/** Number of consecutive frames without a tag after which the tag counts as hidden. */
const MAX_MISSED_FRAMES = 3;

const subtract = (a: Pixel, b: Pixel): Pixel => [a[0] - b[0], a[1] - b[1]];
const length = ([x, y]: Pixel) => Math.hypot(x, y);
const mean = (points: Pixel[]): Pixel => [0, 1].map((i) => points.reduce((sum, point) => sum + (point[i] ?? 0), 0) / points.length) as Pixel;

/** The vector from the deck tag to the centre of the floor tags, relative to the robot's heading, mm. */
export interface OffsetToCentre {
  forward: number;
  left: number;
  /** Distance from the centre beyond which the robot is near the edge of the sheet, mm. */
  reach: number;
  /** True if the robot is beyond `reach`, or near the edge of the frame. */
  isNearEdge: boolean;
}

export class TagTracker {
  /** Width and height of the last frame, px. */
  frameSize: [number, number] = [1, 1];
  /** The tags in the last frame. */
  tags: Tag[] = [];
  /** The centre of the deck tag in each frame so far that shows it. */
  path: Pixel[] = [];
  /** Duration of the search for tags in the last frame, ms. */
  searchMs = 0;
  /** The floor tags as they were last detected, indexed by their ids. */
  private readonly floorTags: (Tag | undefined)[] = [];
  /** Number of latest consecutive frames without a tag, indexed by the tag's id. */
  private readonly missedFrames = TAG_NAMES.map(() => MAX_MISSED_FRAMES);
  /** Arrival times of the frames in the last `FRAME_RATE_WINDOW_MS`, on the page's clock, ms. */
  private readonly arrivalTimes: number[] = [];

  /** Adds the tags that were detected in the next frame. */
  addDetection({ tags, frameSize, searchMs }: Detection): void {
    Object.assign(this, { tags, frameSize, searchMs });
    for (const id of TAG_NAMES.keys()) this.missedFrames[id] = tags.some((tag) => tag.id === id) ? 0 : (this.missedFrames[id] ?? 0) + 1;
    for (const tag of tags) if (tag.id !== DECK_TAG_ID) this.floorTags[tag.id] = tag;
    if (this.deckTag) this.path.push(mean(this.deckTag.corners));
    this.arrivalTimes.push(performance.now());
    while ((this.arrivalTimes[0] ?? 0) < performance.now() - FRAME_RATE_WINDOW_MS) this.arrivalTimes.shift();
  }

  /** The rate of the latest frames, 1/s. */
  get framesPerSecond(): number {
    const [first, last] = [this.arrivalTimes[0], this.arrivalTimes.at(-1)];
    return first === undefined || last === undefined || last === first ? 0 : (1000 * (this.arrivalTimes.length - 1)) / (last - first);
  }

  /** The deck tag in the last frame; undefined if the frame does not show it. */
  get deckTag(): Tag | undefined {
    return this.tags.find(({ id }) => id === DECK_TAG_ID);
  }

  /** The vector towards the robot's head in the frame, as long as the deck tag; null if that tag is not visible. */
  get headingVector(): Pixel | null {
    if (!this.deckTag) return null;
    const [a, b, c, d] = this.deckTag.corners;
    return subtract(mean([a, b]), mean([c, d]));
  }

  /** A message that names the hidden tags; empty if all tags are visible. */
  get hiddenTagsMessage(): string {
    const hiddenNames = TAG_NAMES.filter((_, id) => (this.missedFrames[id] ?? 0) >= MAX_MISSED_FRAMES);
    if (hiddenNames.length === 0) return '';
    if (hiddenNames.length === TAG_NAMES.length) return 'No tag of the sheet is visible: record from above and from a short distance, in even light and not mirrored.';
    const last = hiddenNames.pop() ?? '';
    return `Not visible: ${hiddenNames.length > 0 ? `${hiddenNames.join(', ')} and ${last}` : last}.`;
  }

  /** The vector from the robot to the centre; null if the deck tag or all floor tags are unknown. */
  get offsetToCentre(): OffsetToCentre | null {
    const { headingVector: heading, deckTag, frameSize } = this;
    const floorTags = this.floorTags.filter((tag) => tag !== undefined);
    if (!heading || !deckTag || floorTags.length === 0) return null;
    const tagCentres = floorTags.map(({ corners }) => mean(corners));
    const edgeLengths = floorTags.map(({ corners }) => length(subtract(corners[0], corners[1])));
    const scale = TAG_EDGE_MM / (edgeLengths.reduce((sum, edgeLength) => sum + edgeLength, 0) / edgeLengths.length);
    const [deckCentre, centre] = [mean(deckTag.corners), mean(tagCentres)];
    const offset = subtract(centre, deckCentre);
    const headingLength = length(heading);
    const forward = ((offset[0] * heading[0] + offset[1] * heading[1]) / headingLength) * scale;
    const left = ((offset[0] * heading[1] - offset[1] * heading[0]) / headingLength) * scale;
    const reach = Math.max(...tagCentres.map((point) => length(subtract(point, centre)))) * scale + SHEET_MARGIN_MM;
    const edgeDistance = Math.min(deckCentre[0], deckCentre[1], frameSize[0] - deckCentre[0], frameSize[1] - deckCentre[1]) * scale;
    return { forward, left, reach, isNearEdge: Math.hypot(forward, left) > reach || edgeDistance < FRAME_MARGIN_MM };
  }
}
