/** Create edits at the playhead, apply and retarget them, and describe them. Pure functions. */
import type { Edit, Level, MoveBorder, Segment, Segments, TableChange } from "../../messages";
import {
  compareLevel,
  findIndexAt,
  findNearestBorder,
  findRow,
  formatCounts,
  getSegmentKey,
} from "../../segments";
import { formatCount } from "../../util";

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

export function applyChange(table: Segments, change: TableChange): Segments {
  const rows = new Map(table.segments.map((row) => [getSegmentKey(row), row]));
  for (const [level, start_frame] of change.removed)
    rows.delete(getSegmentKey({ level, start_frame }));
  for (const row of change.rows) rows.set(getSegmentKey(row), row);
  const segments = numberActivities([...rows.values()].sort(compareLevel));
  return { ...table, cluster_names: change.cluster_names, segments };
}

/** Return rows, sorted by level and start, with the index of the activity that contains each. */
function numberActivities(rows: readonly Segment[]): Segment[] {
  const starts = rows.filter(({ level }) => level === "activity").map((row) => row.start_frame);
  let activity = -1;
  let level = "";
  return rows.map((row) => {
    if (row.level !== level) [level, activity] = [row.level, -1];
    // Past the last activity, the next start is undefined, and the comparison false.
    while (starts[activity + 1]! <= row.start_frame) activity += 1;
    return row.activity === activity ? row : { ...row, activity };
  });
}

/**
 * Return the edit for the same segments of a later table; null if one is gone. Level and start
 * frame identify a segment; a border is the start of the segment after it. A segment whose start
 * moved keeps its stop. Only a split applies to a frame, whichever segment contains it.
 */
export function retargetEdit(edit: Edit, before: Segments, now: Segments): Edit | null {
  let isGone = false;
  const followed = mapFrames(edit, before, (level, frame) => {
    const was = findRow(before, { level, start_frame: frame });
    if (!was || findRow(now, was)) return frame;
    const moved = now.segments.find(
      (row) => row.level === level && row.stop_frame === was.stop_frame && !findRow(before, row),
    );
    isGone ||= !moved;
    return moved?.start_frame ?? frame;
  });
  return isGone ? null : followed;
}

/** Return the edit with every frame that identifies a segment mapped. */
function mapFrames<E extends Edit>(
  edit: E,
  table: Segments,
  mapFrame: (level: Level, frame: number) => number,
): E {
  const mapStarts = (level: Level, { frames }: { frames: number[] }): E => {
    return { ...edit, frames: frames.map((frame) => mapFrame(level, frame)) };
  };
  switch (edit.kind) {
    case "move_border":
    case "delete_border":
    case "name_segment":
    case "set_cluster":
    case "set_kind":
    case "comment":
      return { ...edit, frame: mapFrame(edit.level, edit.frame) };
    case "merge": {
      const { level, start_frame, stop_frame } = edit;
      return {
        ...edit,
        start_frame: mapFrame(level, start_frame),
        stop_frame: mapFrame(level, stop_frame),
      };
    }
    case "check":
      return mapStarts(edit.level, edit);
    case "exclude":
      return mapStarts("primitive", edit);
    case "split_cluster": {
      const members = table.segments.filter((row) => row.cluster === edit.cluster);
      const isOfPrimitives = members.some((row) => row.level === "primitive");
      return mapStarts(isOfPrimitives ? "primitive" : "activity", edit);
    }
    case "together":
      return { ...edit, edits: edit.edits.map((each) => mapFrames(each, table, mapFrame)) };
    default:
      return edit;
  }
}

const LEVELS: Record<Level, [one: string, many: string]> = {
  activity: ["activity", "activities"],
  primitive: ["primitive", "primitives"],
};

/** Return a description of an edit, times in seconds. */
export function describeEdit(edit: Edit, fps: number): string {
  const at = (frame: number) => `${(frame / fps).toFixed(2)} s`;
  switch (edit.kind) {
    case "move_border":
      return `${edit.level} border from ${at(edit.frame)} to ${at(edit.to)}`;
    case "split":
      return `${edit.level} split at ${at(edit.frame)}`;
    case "merge":
      return `${LEVELS[edit.level][1]} merged from ${at(edit.start_frame)} to ${at(edit.stop_frame)}`;
    case "delete_border":
      return `${edit.level} border at ${at(edit.frame)} deleted`;
    case "name_segment":
      return edit.label
        ? `${edit.level} at ${at(edit.frame)} named “${edit.label}”`
        : `own name of the ${edit.level} at ${at(edit.frame)} removed`;
    case "name_cluster":
      return edit.label
        ? `cluster ${edit.cluster} named “${edit.label}”`
        : `name of cluster ${edit.cluster} removed`;
    case "set_cluster":
      return edit.cluster < 0
        ? `${edit.level} at ${at(edit.frame)} removed from its cluster`
        : `${edit.level} at ${at(edit.frame)} put into cluster ${edit.cluster}`;
    case "set_kind":
      return edit.to === "transition"
        ? `${edit.level} at ${at(edit.frame)} made a transition`
        : `transition at ${at(edit.frame)} made ${edit.level === "activity" ? "an" : "a"} ${edit.level}`;
    case "merge_clusters":
      return `cluster ${edit.cluster} merged into ${edit.into}`;
    case "split_cluster":
      return `${formatCount(edit.frames.length, "segment")} of cluster ${edit.cluster} made a cluster of their own`;
    case "order_clusters":
      return "clusters put into another order";
    case "comment":
      return edit.text
        ? `comment on the ${edit.level} at ${at(edit.frame)}`
        : `comment on the ${edit.level} at ${at(edit.frame)} removed`;
    case "check":
      return `${formatCount(edit.frames.length, ...LEVELS[edit.level])} ${edit.checked ? "checked" : "not checked any more"}`;
    case "exclude":
      return `${formatCount(edit.frames.length, "repetition")} ${edit.excluded ? "left out of means" : "in means again"}`;
    case "together":
      return edit.edits.length === 1
        ? describeEdit(edit.edits[0]!, fps)
        : `${edit.edits.length} edits at once: ${edit.edits[0] ? describeEdit(edit.edits[0], fps) : ""}, …`;
    case "segment":
      return `segmented with ${edit.preset}`;
    case "take_labels":
      return `labels of another program taken as the table`;
    case "transfer":
      return `labels from a knowledge base`;
    case "restore":
      return `version ${edit.version} restored`;
    case "undo":
      return "undo";
    case "redo":
      return "redo";
  }
}

/** Return whether an edit replaces the whole table, which can be slow. */
export function replacesTable({ kind }: Edit): boolean {
  return ["segment", "transfer", "take_labels", "restore"].includes(kind);
}

/** Describe what a segmentation found and its duration; without timings it was cancelled. */
export function describeResult(table: Segments): string {
  if (!Object.keys(table.timings).length) return "Not segmented.";
  const seconds = Object.values(table.timings).reduce((sum, each) => sum + each, 0);
  return `${formatCounts(table)}, found in ${seconds.toFixed(2)} s.`;
}

export function isLossNote(note: string): boolean {
  return note.startsWith("not taken over");
}
