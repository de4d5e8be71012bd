/** Which lanes the timeline has, and where; pure functions. */
import type { Level, Segment, Segments } from "../messages";
import { durationOf, indexAt, laneOf } from "../segments";

export interface Lane {
  id: string;
  title: string;
  top: number;
  height: number;
  segments: readonly Segment[];
  /** Which level's borders can be dragged here; null: none. */
  level: Level | null;
  /** Frames of borders to point out: those that the other result has not. */
  differences: ReadonlySet<number>;
  /** Of another person of the same file: their place among what is open; null: of the one in front. */
  person: number | null;
  /** Whether its title is the name of the person in front. */
  front: boolean;
}

/** A person of the file, and the table; null for the one in front. */
export interface PersonLanes {
  name: string;
  /** Place among what is open. */
  index: number;
  segmentation: Segments | null;
}

export const RULER = 22;
export const GUTTER = 78;
const GAP = 4;
const BETWEEN = 7; // people

interface Given {
  activities: readonly Segment[];
  primitives: readonly Segment[];
  labels: readonly Segment[];
  others: readonly { name: string; segmentation: Segments; marked?: boolean }[];
  /** Those of the file who are open, where they are several, from top to bottom. */
  people?: readonly PersonLanes[];
}

type Row = Omit<Lane, "top" | "height"> & { share: number; above: number };

const SAME = 0.1; // seconds from a border to one that counts as the same
const NONE: ReadonlySet<number> = new Set();

/** The lanes from top to bottom, sharing what height there is. */
export function layOut(given: Given, height: number): Lane[] {
  const { people = [] } = given;
  const rows = people.length
    ? people.flatMap((person, i) => lanesOfPerson(person, given, i ? BETWEEN : 0))
    : lanesInFront(given);
  const total = rows.reduce((sum, row) => sum + row.share, 0);
  const gaps = rows.reduce((sum, row) => sum + GAP + row.above, 0);
  const room = Math.max(height - RULER - gaps, 0);
  let top = RULER;
  return rows.map(({ share, above, ...row }) => {
    top += above;
    const lane = { ...row, top, height: Math.min((room * share) / total, 44 * share) };
    top += lane.height + GAP;
    return lane;
  });
}

/** What is seen of a person: all of the one in front, the segments of the others. */
function lanesOfPerson(person: PersonLanes, given: Given, above: number): Row[] {
  const { name, index, segmentation } = person;
  if (!segmentation)
    return lanesInFront(given).map((row, i) =>
      i ? row : { ...row, title: name, front: true, above },
    );
  const shared = { level: null, differences: NONE, person: index, front: false };
  const levels = (["activity", "primitive"] as const).map((level) => ({
    ...shared,
    id: `person-${index}-${level}`,
    title: "",
    segments: laneOf(segmentation, level),
    share: 0.8,
    above: 0,
  }));
  return levels
    .filter(({ segments }, i) => !i || segments.length)
    .map((row, i) => (i ? row : { ...row, title: name, above }));
}

function lanesInFront({ activities, primitives, labels, others }: Given): Row[] {
  const below = others.map(({ name, segmentation, marked }) => ({
    name,
    marked,
    activity: laneOf(segmentation, "activity"),
    primitive: laneOf(segmentation, "primitive"),
  }));
  const marked = below.find((each) => each.marked);
  const only = (mine: readonly Segment[], counterpart?: readonly Segment[]): ReadonlySet<number> =>
    marked && counterpart ? without(mine, counterpart) : NONE;
  const shared = { person: null, front: false, above: 0 };
  const rows: Row[] = [
    {
      ...shared,
      id: "activity",
      title: "Activities",
      segments: activities,
      level: "activity",
      share: 1,
      differences: only(activities, marked?.activity),
    },
    {
      ...shared,
      id: "primitive",
      title: "Primitives",
      segments: primitives,
      level: "primitive",
      share: 1.2,
      differences: only(primitives, marked?.primitive),
    },
    {
      ...shared,
      id: "label",
      title: "Labels",
      segments: labels,
      level: null,
      share: 0.7,
      differences: NONE,
    },
  ];
  below.forEach((other, i) => {
    rows.push({
      ...shared,
      id: `other-activity-${i}`,
      title: other.name,
      segments: other.activity,
      level: null,
      share: 0.8,
      differences: other.marked ? without(other.activity, activities) : NONE,
    });
    if (below.length > 1 && !other.primitive.length) return; // room for those who have some
    rows.push({
      ...shared,
      id: `other-primitive-${i}`,
      title: "",
      segments: other.primitive,
      level: null,
      share: 0.8,
      differences: other.marked ? without(other.primitive, primitives) : NONE,
    });
  });
  return rows;
}

/** The borders that one lane has, and another has none as near as the eye takes for the same. */
function without(mine: readonly Segment[], others: readonly Segment[]): ReadonlySet<number> {
  const near = ({ start_s }: Segment): boolean => {
    let [low, high] = [0, others.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (others[middle]!.start_s < start_s - SAME) low = middle + 1;
      else high = middle;
    }
    return low < others.length && others[low]!.start_s <= start_s + SAME;
  };
  return new Set(mine.filter((each) => !near(each)).map((each) => each.start_frame));
}

/** The lane at a height of the canvas. */
export function laneAt(lanes: readonly Lane[], y: number): Lane | undefined {
  return lanes.find((lane) => y >= lane.top && y < lane.top + lane.height);
}

/** The segments of a lane that a span of time shows: from the first to behind the last. */
export function visible(
  segments: readonly Segment[],
  start_s: number,
  stop_s: number,
): [number, number] {
  let low = 0;
  let high = segments.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (segments[middle]!.stop_s < start_s) low = middle + 1;
    else high = middle;
  }
  let end = low;
  while (end < segments.length && segments[end]!.start_s <= stop_s) end++;
  return [low, end];
}

/**
 * The frame of the border nearest to a time, if it is less than `reach` seconds away; in a segment
 * that is not much wider less than a third of it, so that its middle is the segment's own.
 */
export function borderNear(
  segments: readonly Segment[],
  seconds: number,
  reach: number,
  fps: number,
): number | null {
  const i = indexAt(segments, Math.floor(seconds * fps));
  const share = segments[i] ? durationOf(segments[i]) / 3 : 0;
  const near = [segments[i], segments[i + 1]]
    .filter((segment) => segment !== undefined && segment.start_frame > 0)
    .map((segment) => ({ frame: segment!.start_frame, far: Math.abs(segment!.start_s - seconds) }))
    .sort((a, b) => a.far - b.far)[0];
  return near && near.far < Math.min(reach, share) ? near.frame : null;
}

/**
 * Where a border may go: so many frames are left of its two segments each that both can still be
 * seen, or as many as they have if that is fewer.
 */
export function roomFor(
  segments: readonly Segment[],
  border: number,
  least: number,
): [number, number] {
  const i = indexAt(segments, border);
  const low = segments[i - 1]?.start_frame ?? 0;
  const high = segments[i]?.stop_frame ?? border;
  return [Math.min(low + least, border), Math.max(high - least, border)];
}
