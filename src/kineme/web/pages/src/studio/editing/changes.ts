/** Apply what the server changed to a table (see `web/tables.py`) and to queued edits. */
import { compareLevel, getSegmentKey, findRow } from "../../segments";
import type { Segment, Segments, TableChange, Edit, Level } from "../../messages";

export function applyChange(table: Segments, change: TableChange): Segments {
  const rows = new Map(table.segments.map((row) => [getSegmentKey(row), row]));
  for (const [level, start_frame] of change.removed)
    rows.delete(getSegmentKey({ level, start_frame }));
  for (const row of change.rows) rows.set(getSegmentKey(row), row);
  const segments = numberActivities([...rows.values()].sort(compareLevel));
  return { ...table, cluster_names: change.cluster_names, segments };
}

/** Return the rows with the index of the activity that contains each. */
function numberActivities(rows: readonly Segment[]): Segment[] {
  const starts = rows.filter(({ level }) => level === "activity").map((row) => row.start_frame);
  let activity = -1;
  let level = "";
  return rows.map((row) => {
    if (row.level !== level) [level, activity] = [row.level, -1];
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
