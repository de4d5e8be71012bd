/**
 * Who an edit is made on. Frames move with the edits that are made before it; the identities of
 * segments, which `kineme/studio/storage/identities.py` hands out, stay. A border is the start of
 * the segment after it. Only a new border is made at a frame, whatever segment that lies in.
 */
import type { Edit, Level, Segments } from "../../messages";

/** A table and who its rows are. */
export interface IdentifiedTable {
  readonly segmentation: Segments;
  readonly ids?: readonly string[];
}

/** Where a segment starts or stops that an edit names. */
interface Place {
  level: Level;
  frame: number;
  end: "start_frame" | "stop_frame";
}

/** Who an edit is made on, in the order of the frames it names; null where there is nobody. */
export function madeOn(edit: Edit, { segmentation, ids = [] }: IdentifiedTable): (string | null)[] {
  const found: (string | null)[] = [];
  withFrames(edit, segmentation, ({ level, frame, end }) => {
    const row = segmentation.segments.findIndex(
      (each) => each.level === level && each[end] === frame,
    );
    found.push(ids[row] ?? null);
    return frame;
  });
  return found;
}

/** The edit as one of another table, on the same segments; null where one of them is gone. */
export function readdressed(
  edit: Edit,
  on: readonly (string | null)[],
  { segmentation, ids = [] }: IdentifiedTable,
): Edit | null {
  const left = [...on];
  let isGone = false;
  const now = withFrames(edit, segmentation, ({ frame, end }) => {
    const id = left.shift() ?? null;
    if (id === null) return frame;
    const row = segmentation.segments[ids.indexOf(id)];
    isGone ||= !row;
    return row ? row[end] : frame;
  });
  return isGone ? null : now;
}

/** The edit with other frames at the places that it names. */
function withFrames<E extends Edit>(
  edit: E,
  table: Segments,
  frameOf: (place: Place) => number,
): E {
  const start = (level: Level, frame: number): number =>
    frameOf({ level, frame, end: "start_frame" });
  const starts = (level: Level, { frames }: { frames: number[] }): E => {
    return { ...edit, frames: frames.map((frame) => start(level, frame)) };
  };
  switch (edit.kind) {
    case "move_border":
    case "delete_border":
    case "name_segment":
    case "set_cluster":
    case "set_kind":
    case "comment":
      return { ...edit, frame: start(edit.level, edit.frame) };
    case "merge": {
      const { level, start_frame, stop_frame: frame } = edit;
      const end = "stop_frame";
      return {
        ...edit,
        start_frame: start(level, start_frame),
        stop_frame: frameOf({ level, frame, end }),
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
