/** Query segment tables. */
import { formatCount, groupBy, memoize, type Mean, computeMean } from "./util";
import type { Level, Segment, Segments } from "./messages";

/** A cluster with its members and durations. */
export interface Cluster {
  id: number;
  label: string;
  members: Segment[];
  /** Total duration of all members, seconds. */
  total_s: number;
  mean_s: number;
}

/** Count a table's activities or primitives without transitions. */
export function countSegments({ segments }: Segments, level: Level): number {
  return segments.filter((each) => each.level === level && each.kind !== "transition").length;
}

/** Count the segments that people checked. */
export function countChecked({ segments }: Segments): number {
  return segments.filter(({ checked }) => checked).length;
}

/** Return counts as text, such as "1 activity, 18 primitives". */
export function formatCounts(table: Segments): string {
  const activities = formatCount(countSegments(table, "activity"), "activity", "activities");
  return `${activities}, ${formatCount(countSegments(table, "primitive"), "primitive")}`;
}

/** Return the segments of a level in time order; they tile the recording. */
export function getLane(table: Segments | undefined, level: Level): Segment[] {
  const rows = table?.segments.filter((segment) => segment.level === level) ?? [];
  return rows.sort((a, b) => a.start_frame - b.start_frame);
}

/** Return the row with the same level and start frame. */
export function findRow(
  { segments }: Segments,
  { level, start_frame }: SegmentId,
): Segment | undefined {
  return segments.find((row) => row.level === level && row.start_frame === start_frame);
}

/** Identifies a segment by level and start frame. */
export type SegmentId = Pick<Segment, "level" | "start_frame">;

/** Order activities before primitives, then by time. */
export function compareLevel(a: SegmentId, b: SegmentId): number {
  return a.level.localeCompare(b.level) || a.start_frame - b.start_frame;
}

/** Order by time, activities before primitives. */
export function compareTime(a: SegmentId, b: SegmentId): number {
  return a.start_frame - b.start_frame || a.level.localeCompare(b.level);
}

/** Return a key by level and start, which stays when the end changes. */
export function getSegmentKey({ level, start_frame }: SegmentId): string {
  return `${level} ${start_frame}`;
}

/** Return the segment at a frame; the nearest one for frames outside. */
export function findSegmentAt(lane: readonly Segment[], frame: number): Segment | undefined {
  return lane[findIndexAt(lane, frame)];
}

const getPrimitives = memoize((table: Segments) => getLane(table, "primitive"));

/** Return the primitive at a time (seconds). The sorted lane is cached, as each pose needs it. */
export function findPrimitiveAt(table: Segments, seconds: number): Segment | undefined {
  return findSegmentAt(getPrimitives(table), Math.floor(seconds * table.fps + 1e-6));
}

/** Return the index of the segment at a frame; -1 in an empty lane. */
export function findIndexAt(lane: readonly Segment[], frame: number): number {
  return lane.length ? bisect(lane, (each) => each.start_frame <= frame, 1) - 1 : -1;
}

/** Return the index of the first segment from `low` on for which `isBefore` is false. */
export function bisect(
  lane: readonly Segment[],
  isBefore: (segment: Segment) => boolean,
  low = 0,
): number {
  let high = lane.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (isBefore(lane[middle]!)) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** Return the segment after the border nearest to a frame; the recording's start is no border. */
export function findNearestBorder(lane: readonly Segment[], frame: number): Segment | null {
  const at = findIndexAt(lane, frame);
  const candidates = [lane[at], lane[at + 1]].filter(
    (segment): segment is Segment => segment !== undefined && segment.start_frame > 0,
  );
  const distance = (segment: Segment) => Math.abs(segment.start_frame - frame);
  return candidates.sort((a, b) => distance(a) - distance(b))[0] ?? null;
}

/** Group primitives by cluster, in order of cluster numbers. */
export function groupClusters(
  primitives: readonly Segment[],
  names: Readonly<Record<string, string>> = {},
): Cluster[] {
  return [...groupBy(primitives, ({ cluster }) => cluster)]
    .filter(([id]) => id >= 0)
    .sort(([a], [b]) => a - b)
    .map(([id, members]) => {
      const total_s = sumDurations(members);
      return { id, label: names[id] ?? "", members, total_s, mean_s: total_s / members.length };
    });
}

export function getDuration(segment: Segment): number {
  return segment.stop_s - segment.start_s;
}

function sumDurations(segments: readonly Segment[]): number {
  return segments.reduce((sum, segment) => sum + getDuration(segment), 0);
}

/** Return a segment's display name: its label, else its cluster, else its kind. */
export function getSegmentName(segment: Segment): string {
  if (segment.label) return segment.label;
  if (segment.cluster >= 0) return `cluster ${segment.cluster}`;
  return segment.kind === "transition" ? "transition" : "no cluster";
}

/**
 * Return spans with one label each: the primitive's, else its activity's. Neighbours with the same
 * label are joined; unlabelled segments are omitted.
 */
export function joinLabels(
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

/** A label, how often it occurs and its total duration. */
interface LabelCount {
  label: string;
  count: number;
  total_s: number;
}

/** Count the labels of a lane, longest total duration first. */
export function countLabels(lane: readonly Segment[]): LabelCount[] {
  return [...groupBy(lane, ({ label }) => label)]
    .filter(([label]) => label)
    .map(([label, all]) => ({ label, count: all.length, total_s: sumDurations(all) }))
    .sort((a, b) => b.total_s - a.total_s);
}

/** An activity with its repetitions and the mean duration of those not excluded. */
interface RepeatedActivity extends Mean {
  activity: Segment;
  /** Seconds of each repetition, in time order, and whether it is excluded. */
  durations: number[];
  leftOut: boolean[];
}

/** Return the activities that have repetitions, in time order. */
export function listRepetitions(table: Segments): RepeatedActivity[] {
  const repetitions = getLane(table, "primitive").filter(({ kind }) => kind === "primitive");
  const inside = groupBy(repetitions, ({ activity }) => activity);
  return getLane(table, "activity").flatMap((activity, number) => {
    const rows = inside.get(number) ?? [];
    if (activity.kind === "transition" || !rows.length) return [];
    const durations = rows.map(getDuration);
    const leftOut = rows.map((row) => row.excluded ?? false);
    const counted = durations.filter((_, i) => !leftOut[i]);
    return [{ activity, durations, leftOut, ...computeMean(counted) }];
  });
}
