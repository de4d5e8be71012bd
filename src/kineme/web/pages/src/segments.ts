/** Questions about a segment table. */
import { counted } from "./counted";
import type { Level, Segment, Segments } from "./messages";

/** What the list of clusters says of one. */
export interface Cluster {
  id: number;
  label: string;
  members: Segment[];
  /** Seconds of all members together. */
  total_s: number;
  mean_s: number;
}

/** How many activities or primitives a table has; transitions are neither. */
export function countOf({ segments }: Segments, level: Level): number {
  return segments.filter((each) => each.level === level && each.kind !== "transition").length;
}

/** How many segments of a table people checked. */
export function checkedIn({ segments }: Segments): number {
  return segments.filter(({ checked }) => checked).length;
}

/** "1 activity, 18 primitives". */
export function countsOf(table: Segments): string {
  const activities = counted(countOf(table, "activity"), "activity", "activities");
  return `${activities}, ${counted(countOf(table, "primitive"), "primitive")}`;
}

/** The segments of a level in time order; they tile the recording. */
export function laneOf(table: Segments, level: Level): Segment[] {
  return table.segments
    .filter((segment) => segment.level === level)
    .sort((a, b) => a.start_frame - b.start_frame);
}

/** The row of the segment that starts where another one does, on the same level. */
export function findRow(
  { segments }: Segments,
  { level, start_frame }: Pick<Segment, "level" | "start_frame">,
): Segment | undefined {
  return segments.find((row) => row.level === level && row.start_frame === start_frame);
}

/** The segment of a lane that holds a frame; the nearest one for frames outside. */
export function segmentAt(lane: readonly Segment[], frame: number): Segment | undefined {
  return lane[indexAt(lane, frame)];
}

const primitives = new WeakMap<Segments, readonly Segment[]>();

/** The primitive of a table at a time; each pose asks for it. */
export function primitiveAt(table: Segments, seconds: number): Segment | undefined {
  const lane = primitives.get(table) ?? laneOf(table, "primitive");
  primitives.set(table, lane);
  return segmentAt(lane, Math.floor(seconds * table.fps + 1e-6));
}

/** Position in the lane of the segment that holds a frame; -1 in an empty lane. */
export function indexAt(lane: readonly Segment[], frame: number): number {
  let low = 0;
  let high = lane.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (lane[middle]!.start_frame <= frame) low = middle;
    else high = middle - 1;
  }
  return high < 0 ? -1 : low;
}

/** The segment that starts at the border nearest to a frame; the recording's start is none. */
export function nearestBorder(lane: readonly Segment[], frame: number): Segment | null {
  const at = indexAt(lane, frame);
  const candidates = [lane[at], lane[at + 1]].filter(
    (segment): segment is Segment => segment !== undefined && segment.start_frame > 0,
  );
  const distance = (segment: Segment) => Math.abs(segment.start_frame - frame);
  return candidates.sort((a, b) => distance(a) - distance(b))[0] ?? null;
}

/** The clusters of a lane of primitives, by number. */
export function clustersOf(
  primitives: readonly Segment[],
  names: Readonly<Record<string, string>> = {},
): Cluster[] {
  const members = new Map<number, Segment[]>();
  for (const segment of primitives) {
    if (segment.cluster < 0) continue;
    const others = members.get(segment.cluster);
    if (others) others.push(segment);
    else members.set(segment.cluster, [segment]);
  }
  return [...members.entries()]
    .sort(([a], [b]) => a - b)
    .map(([id, all]) => {
      const total_s = all.reduce((sum, segment) => sum + durationOf(segment), 0);
      const label = names[id] ?? "";
      return { id, label, members: all, total_s, mean_s: total_s / all.length };
    });
}

export function durationOf(segment: Segment): number {
  return segment.stop_s - segment.start_s;
}

/** What people call a segment: its label, else its cluster's number, else its kind. */
export function nameOf(segment: Segment): string {
  if (segment.label) return segment.label;
  if (segment.cluster >= 0) return `cluster ${segment.cluster}`;
  return segment.kind === "transition" ? "transition" : "no cluster";
}

/**
 * What is called how, when: the label of the primitive, else that of its activity. Neighbours of
 * one label are joined; where there is no label, there is nothing.
 */
export function labelSpans(
  activities: readonly Segment[],
  primitives: readonly Segment[],
): Segment[] {
  const named = primitives.length
    ? primitives.map((row) =>
        row.label ? row : { ...row, label: activities[row.activity]?.label ?? "" },
      )
    : activities;
  const spans: Segment[] = [];
  for (const segment of named) {
    const last = spans.at(-1);
    if (!segment.label) continue;
    if (last && last.label === segment.label && last.stop_frame === segment.start_frame)
      spans[spans.length - 1] = { ...last, stop_frame: segment.stop_frame, stop_s: segment.stop_s };
    else spans.push(segment);
  }
  return spans;
}

/** A label of a table without clusters, and how often it occurs. */
export interface LabelCount {
  label: string;
  count: number;
  total_s: number;
}

/** The labels of a lane, the one with most time first. */
export function labelsOf(lane: readonly Segment[]): LabelCount[] {
  const counts = new Map<string, LabelCount>();
  for (const segment of lane) {
    const { label } = segment;
    if (!label) continue;
    const total = counts.get(label) ?? { label, count: 0, total_s: 0 };
    total.count += 1;
    total.total_s += durationOf(segment);
    counts.set(label, total);
  }
  return [...counts.values()].sort((a, b) => b.total_s - a.total_s);
}
