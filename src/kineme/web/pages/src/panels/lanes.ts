/** Compute the timeline's lanes and their layout. Pure functions. */
import type { Level, Segment, Segments } from "../messages";
import { bisect, findIndexAt, getDuration, getLane } from "../segments";
import { toPixel, type Span } from "../view";

export interface Lane {
  id: string;
  title: string;
  top: number;
  height: number;
  segments: readonly Segment[];
  /** Level whose borders can be dragged here; null for none. */
  level: Level | null;
  /** Frames of borders that the other result lacks. */
  differences: ReadonlySet<number>;
  /** Index of another person's recording among the open ones; null for the active one. */
  person: number | null;
  /** Whether its title is the name of the active person. */
  isActive: boolean;
}

/** A person of the file, with the table unless it is the active one. */
interface PersonLanes {
  name: string;
  /** Index among the open recordings. */
  index: number;
  segmentation: Segments | null;
}

export const RULER_HEIGHT = 22;
export const GUTTER_WIDTH = 78;
const GAP = 4;
const PEOPLE_GAP = 7; // people

interface LaneInput {
  activities: readonly Segment[];
  primitives: readonly Segment[];
  labels: readonly Segment[];
  others: readonly { name: string; segmentation: Segments; marked?: boolean }[];
  /** Open people of the file from top to bottom, if several. */
  people?: readonly PersonLanes[];
}

type LaneRow = Omit<Lane, "top" | "height"> & { share: number; above: number };

const BORDER_TOLERANCE = 0.1; // seconds between borders that count as equal
const NO_FRAMES: ReadonlySet<number> = new Set();
const DEFAULT_ROW = {
  level: null,
  differences: NO_FRAMES,
  person: null,
  isActive: false,
  above: 0,
};

/** Return the lanes from top to bottom, sharing the height in pixels. */
export function layOutLanes(given: LaneInput, height: number): Lane[] {
  const { people = [] } = given;
  const rows = people.length
    ? people.flatMap((person, i) => createPersonLanes(person, given, i ? PEOPLE_GAP : 0))
    : createActiveLanes(given);
  const total = rows.reduce((sum, row) => sum + row.share, 0);
  const gaps = rows.reduce((sum, row) => sum + GAP + row.above, 0);
  const available = Math.max(height - RULER_HEIGHT - gaps, 0);
  let top = RULER_HEIGHT;
  return rows.map(({ share, above, ...row }) => {
    top += above;
    const lane = { ...row, top, height: Math.min((available * share) / total, 44 * share) };
    top += lane.height + GAP;
    return lane;
  });
}

/** Return a person's lanes: all of the active one, the segments of others. */
function createPersonLanes(person: PersonLanes, given: LaneInput, above: number): LaneRow[] {
  const { name, index, segmentation } = person;
  if (!segmentation)
    return createActiveLanes(given).map((row, i) =>
      i ? row : { ...row, title: name, isActive: true, above },
    );
  const levels = (["activity", "primitive"] as const).map((level) => ({
    ...DEFAULT_ROW,
    person: index,
    id: `person-${index}-${level}`,
    title: "",
    segments: getLane(segmentation, level),
    share: 0.8,
  }));
  return levels
    .filter(({ segments }, i) => !i || segments.length)
    .map((row, i) => (i ? row : { ...row, title: name, above }));
}

function createActiveLanes({ activities, primitives, labels, others }: LaneInput): LaneRow[] {
  const below = others.map(({ name, segmentation, marked }) => ({
    name,
    marked,
    activity: getLane(segmentation, "activity"),
    primitive: getLane(segmentation, "primitive"),
  }));
  const marked = below.find((each) => each.marked);
  const compare = (mine: readonly Segment[], others?: readonly Segment[]): ReadonlySet<number> =>
    others ? findUnmatchedBorders(mine, others) : NO_FRAMES;
  const createRow = (
    id: string,
    title: string,
    segments: readonly Segment[],
    share: number,
    rest: Partial<LaneRow> = {},
  ): LaneRow => ({ ...DEFAULT_ROW, id, title, segments, share, ...rest });
  const rows = [
    createRow("activity", "Activities", activities, 1, {
      level: "activity",
      differences: compare(activities, marked?.activity),
    }),
    createRow("primitive", "Primitives", primitives, 1.2, {
      level: "primitive",
      differences: compare(primitives, marked?.primitive),
    }),
    createRow("label", "Labels", labels, 0.7),
  ];
  below.forEach(({ name, marked, activity, primitive }, i) => {
    const differences = compare(activity, marked ? activities : undefined);
    rows.push(createRow(`other-activity-${i}`, name, activity, 0.8, { differences }));
    // Leave space for results that have some.
    if (below.length > 1 && !primitive.length) return;
    const unmatched = compare(primitive, marked ? primitives : undefined);
    rows.push(createRow(`other-primitive-${i}`, "", primitive, 0.8, { differences: unmatched }));
  });
  return rows;
}

/** Return the borders of one lane without a counterpart in another. */
function findUnmatchedBorders(
  mine: readonly Segment[],
  others: readonly Segment[],
): ReadonlySet<number> {
  const hasMatch = ({ start_s }: Segment): boolean => {
    const i = bisect(others, (each) => each.start_s < start_s - BORDER_TOLERANCE);
    return i < others.length && others[i]!.start_s <= start_s + BORDER_TOLERANCE;
  };
  return new Set(mine.filter((each) => !hasMatch(each)).map((each) => each.start_frame));
}

/** Return the lane at a vertical position. */
export function findLane(lanes: readonly Lane[], y: number): Lane | undefined {
  return lanes.find((lane) => y >= lane.top && y < lane.top + lane.height);
}

/** Return the index range of the segments within a time span. */
export function findVisible(
  segments: readonly Segment[],
  start_s: number,
  stop_s: number,
): [number, number] {
  const first = bisect(segments, (each) => each.stop_s < start_s);
  return [first, bisect(segments, (each) => each.start_s <= stop_s, first)];
}

/**
 * Call `draw` for the segments within a range, with their left and right edges in pixels. Of
 * segments narrower than half a pixel only some are drawn.
 */
export function forEachVisible(
  segments: readonly Segment[],
  range: Span,
  plotWidth: number,
  draw: (segment: Segment, left: number, right: number) => void,
): void {
  const [from, to] = findVisible(segments, range.start_s, range.stop_s);
  let drawn = -Infinity; // right edge drawn so far, pixels
  for (const segment of segments.slice(from, to)) {
    const left = toPixel(range, plotWidth, segment.start_s);
    const right = toPixel(range, plotWidth, segment.stop_s);
    if (right - drawn < 0.5) continue;
    drawn = right;
    draw(segment, left, right);
  }
}

/**
 * Return the frame of the border nearest to a time, if within `reach` seconds. In a narrow segment
 * the limit is a third of its duration, so that its middle stays clickable.
 */
export function findBorder(
  segments: readonly Segment[],
  seconds: number,
  reach: number,
  fps: number,
): number | null {
  const i = findIndexAt(segments, Math.floor(seconds * fps));
  const share = segments[i] ? getDuration(segments[i]) / 3 : 0;
  const near = [segments[i], segments[i + 1]]
    .filter((segment) => segment !== undefined && segment.start_frame > 0)
    .map((segment) => ({ frame: segment!.start_frame, far: Math.abs(segment!.start_s - seconds) }))
    .sort((a, b) => a.far - b.far)[0];
  return near && near.far < Math.min(reach, share) ? near.frame : null;
}

/** Return a border's limits, which leave both segments `least` frames or their length. */
export function getBorderLimits(
  segments: readonly Segment[],
  border: number,
  least: number,
): [number, number] {
  const i = findIndexAt(segments, border);
  const low = segments[i - 1]?.start_frame ?? 0;
  const high = segments[i]?.stop_frame ?? border;
  return [Math.min(low + least, border), Math.max(high - least, border)];
}
