/**
 * Edits that wait while the edits before them move the segments that they name. A segment is known
 * by its level and first frame, and a border is the start of the segment after it. A segment whose
 * start was moved still stops where it did. Only a new border is made at a frame, whatever segment
 * that lies in.
 */
import type { Edit, Level, Segments } from "../../messages";
import { findRow } from "../../segments";

/** The edit on the same segments of a later table; null where one of them is gone. */
export function follow(edit: Edit, before: Segments, now: Segments): Edit | null {
  let isGone = false;
  const followed = withFrames(edit, before, (level, frame) => {
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

/** The edit with other frames at the places that it names. */
function withFrames<E extends Edit>(
  edit: E,
  table: Segments,
  frameOf: (level: Level, frame: number) => number,
): E {
  const starts = (level: Level, { frames }: { frames: number[] }): E => {
    return { ...edit, frames: frames.map((frame) => frameOf(level, frame)) };
  };
  switch (edit.kind) {
    case "move_border":
    case "delete_border":
    case "name_segment":
    case "set_cluster":
    case "set_kind":
    case "comment":
      return { ...edit, frame: frameOf(edit.level, edit.frame) };
    case "merge": {
      const { level, start_frame, stop_frame } = edit;
      return {
        ...edit,
        start_frame: frameOf(level, start_frame),
        stop_frame: frameOf(level, stop_frame),
      };
    }
    case "check":
      return starts(edit.level, edit);
    case "exclude":
      return starts("primitive", edit);
    case "split_cluster": {
      const members = table.segments.filter((row) => row.cluster === edit.cluster);
      const isOfPrimitives = members.some((row) => row.level === "primitive");
      return starts(isOfPrimitives ? "primitive" : "activity", edit);
    }
    case "together":
      return { ...edit, edits: edit.edits.map((each) => withFrames(each, table, frameOf)) };
    default:
      return edit;
  }
}
