/** Which lanes the timeline has, and where; pure functions. */
import type { Level, Segment, Segments } from "../messages";
import { indexAt, labelSpans, laneOf } from "../segments";

export interface Lane {
  id: string;
  title: string;
  top: number;
  height: number;
  segments: readonly Segment[];
  /** Which level's borders can be dragged here; null: none. */
  level: Level | null;
}

export const RULER = 22;
export const GUTTER = 78;
const GAP = 4;

interface Given {
  activities: readonly Segment[];
  primitives: readonly Segment[];
  other: { name: string; segmentation: Segments } | null;
}

/** The lanes from top to bottom, sharing what height there is. */
export function layOut({ activities, primitives, other }: Given, height: number): Lane[] {
  const rows: (Omit<Lane, "top" | "height"> & { share: number })[] = [
    { id: "activity", title: "Activities", segments: activities, level: "activity", share: 1 },
    { id: "primitive", title: "Primitives", segments: primitives, level: "primitive", share: 1.2 },
    {
      id: "label",
      title: "Labels",
      segments: labelSpans(activities, primitives),
      level: null,
      share: 0.7,
    },
  ];
  if (other) {
    const second = { level: null, share: 0.8 };
    const lane = (level: Level): Segment[] => laneOf(other.segmentation, level);
    rows.push({ id: "other-activity", title: other.name, segments: lane("activity"), ...second });
    rows.push({ id: "other-primitive", title: "", segments: lane("primitive"), ...second });
  }
  const total = rows.reduce((sum, row) => sum + row.share, 0);
  const room = Math.max(height - RULER - GAP * rows.length, 0);
  let top = RULER;
  return rows.map(({ share, ...row }) => {
    const lane = { ...row, top, height: Math.min((room * share) / total, 44 * share) };
    top += lane.height + GAP;
    return lane;
  });
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

/** The frame of the border nearest to a time, if it is less than `reach` seconds away. */
export function borderNear(
  segments: readonly Segment[],
  seconds: number,
  reach: number,
  fps: number,
): number | null {
  const i = indexAt(segments, Math.floor(seconds * fps));
  const near = [segments[i], segments[i + 1]]
    .filter((segment) => segment !== undefined && segment.start_frame > 0)
    .map((segment) => ({ frame: segment!.start_frame, far: Math.abs(segment!.start_s - seconds) }))
    .sort((a, b) => a.far - b.far)[0];
  return near && near.far < reach ? near.frame : null;
}

/** Where a border may go: at least a frame is left of its two segments each. */
export function roomFor(segments: readonly Segment[], border: number): [number, number] {
  const i = indexAt(segments, border);
  return [(segments[i - 1]?.start_frame ?? -1) + 1, (segments[i]?.stop_frame ?? border + 1) - 1];
}
