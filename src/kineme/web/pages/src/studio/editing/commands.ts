/** Create edits at the playhead; null if there is nothing to do. */
import type { Edit, Level, MoveBorder, Segment } from "../../messages";
import { findIndexAt, findNearestBorder } from "../../segments";

/** The edited lane and the playhead's frame. */
export interface EditContext {
  lane: readonly Segment[];
  frame: number;
}

/** Return the level and frame by which edits identify a segment. */
export function getTarget({ level, start_frame }: Segment): { level: Level; frame: number } {
  return { level, frame: start_frame };
}

/** Split the segment at the playhead. */
export function createSplit({ lane, frame }: EditContext): Edit | null {
  const segment = lane[findIndexAt(lane, frame)];
  if (!segment || segment.start_frame === frame) return null;
  return { kind: "split", level: segment.level, frame };
}

/** Merge the segment at the playhead with the next one. */
export function createMerge({ lane, frame }: EditContext): Edit | null {
  const at = findIndexAt(lane, frame);
  const [segment, next] = [lane[at], lane[at + 1]];
  if (!segment || !next) return null;
  const { level, start_frame } = segment;
  return { kind: "merge", level, start_frame, stop_frame: next.stop_frame };
}

/** Delete the border nearest to the playhead. */
export function createDeletion(where: EditContext): Edit | null {
  const border = findNearestBorder(where.lane, where.frame);
  return border === null
    ? null
    : { kind: "delete_border", level: border.level, frame: border.start_frame };
}

/** Move the border nearest to the playhead by some frames, as far as its neighbours allow. */
export function createNudge(where: EditContext, by: number): MoveBorder | null {
  const after = findNearestBorder(where.lane, where.frame);
  if (!after) return null;
  const before = where.lane[where.lane.indexOf(after) - 1]!;
  const frame = after.start_frame;
  const to = Math.min(Math.max(frame + by, before.start_frame + 1), after.stop_frame - 1);
  return to === frame ? null : { kind: "move_border", level: after.level, frame, to };
}

/** Move the start or stop of the current segment to the playhead. */
export function createBorderMove(
  { lane, frame }: EditContext,
  side: "start" | "stop",
): Edit | null {
  const at = findIndexAt(lane, frame);
  const segment = lane[at];
  const after = side === "start" ? segment : lane[at + 1];
  if (!segment || !after || (side === "start" && at === 0)) return null;
  if (segment.start_frame === frame) return null;
  return { kind: "move_border", level: segment.level, frame: after.start_frame, to: frame };
}

/** Return a segment's new start frame if the edit moved it, else null. */
export function getMovedStart(edit: Edit, level: Level, start: number): number | null {
  return edit.kind === "move_border" && edit.level === level && edit.frame === start
    ? edit.to
    : null;
}
