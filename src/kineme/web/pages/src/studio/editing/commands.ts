/** Edits at the playhead or of the selected segment; null where there is nothing to do. */
import type { Edit, Level, MoveBorder, Segment } from "../../messages";
import { indexAt, nearestBorder } from "../../segments";

/** What a command looks at: the lane in which one works, and where the playhead is. */
export interface Where {
  lane: readonly Segment[];
  frame: number;
}

/** How edits name a segment. */
export function placeOf({ level, start_frame }: Segment): { level: Level; frame: number } {
  return { level, frame: start_frame };
}

/** A new border at the playhead. */
export function split({ lane, frame }: Where): Edit | null {
  const segment = lane[indexAt(lane, frame)];
  if (!segment || segment.start_frame === frame) return null;
  return { kind: "split", level: segment.level, frame };
}

/** The segment at the playhead and the next one become one. */
export function mergeWithNext({ lane, frame }: Where): Edit | null {
  const at = indexAt(lane, frame);
  const [segment, next] = [lane[at], lane[at + 1]];
  if (!segment || !next) return null;
  const { level, start_frame } = segment;
  return { kind: "merge", level, start_frame, stop_frame: next.stop_frame };
}

/** The border nearest to the playhead goes. */
export function deleteBorder(where: Where): Edit | null {
  const border = nearestBorder(where.lane, where.frame);
  return border === null
    ? null
    : { kind: "delete_border", level: border.level, frame: border.start_frame };
}

/** The border nearest to the playhead goes some frames on, or back, as far as its neighbours let it. */
export function nudgeBorder(where: Where, by: number): MoveBorder | null {
  const after = nearestBorder(where.lane, where.frame);
  if (!after) return null;
  const before = where.lane[where.lane.indexOf(after) - 1]!;
  const frame = after.start_frame;
  const to = Math.min(Math.max(frame + by, before.start_frame + 1), after.stop_frame - 1);
  return to === frame ? null : { kind: "move_border", level: after.level, frame, to };
}

/** The segment at the playhead starts or stops there: its border on that side comes to it. */
export function borderHere({ lane, frame }: Where, side: "start" | "stop"): Edit | null {
  const at = indexAt(lane, frame);
  const segment = lane[at];
  const after = side === "start" ? segment : lane[at + 1];
  if (!segment || !after || (side === "start" && at === 0)) return null;
  if (segment.start_frame === frame) return null;
  return { kind: "move_border", level: segment.level, frame: after.start_frame, to: frame };
}

/** Where a segment starts after an edit; null where it was not the one that moved. */
export function followed(edit: Edit, level: Level, start: number): number | null {
  return edit.kind === "move_border" && edit.level === level && edit.frame === start
    ? edit.to
    : null;
}
