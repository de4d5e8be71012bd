/**
 * What an edit is made on, by the identities of segments: their frames move, with the edits that
 * are made before it. A border is the start of the segment after it. Only a new border is made at a
 * frame, whatever segment that lies in.
 *
 * `kineme/studio/storage/identities.py` hands the identities out; `idsAfter` says which they will
 * be after an edit that the server has not answered yet.
 */
import type { ByHand, Edit, Level, Segment, Segments } from "../../messages";
import { levelOf } from "./foreseen/clusters";

/** A table and who its rows are. */
export interface IdentifiedTable {
  readonly segmentation: Segments;
  readonly ids: readonly string[];
}

const LONGEST_ORIGIN = 8;

/** Who the rows of a table are that an edit makes of another. */
export function idsAfter(before: IdentifiedTable, now: Segments, name: string): string[] {
  const rows = before.segmentation.segments;
  const former = {
    activity: formerly(rows, before.ids, now, "activity"),
    primitive: formerly(rows, before.ids, now, "primitive"),
  };
  const made = ({ level, start_frame }: Segment): string =>
    `${level[0]}${name.slice(0, LONGEST_ORIGIN)}:${start_frame}`;
  return now.segments.map((row) => former[row.level].get(row.start_frame) ?? made(row));
}

/** Who the segments of a level were before, by where they start now. */
function formerly(
  rows: readonly Segment[],
  ids: readonly string[],
  now: Segments,
  level: Level,
): Map<number, string> {
  const mine = new Map<number, string>();
  rows.forEach((row, i) => row.level === level && mine.set(row.start_frame, ids[i]!));
  const found = new Map<number, string>();
  for (const [start, was] of descent([...mine.keys()], startsOf(now.segments, level)))
    found.set(start, mine.get(was)!);
  return found;
}

/** Where the segments that start now started before; new ones are left out. */
export function descent(before: readonly number[], now: readonly number[]): Map<number, number> {
  const starts = new Set(before);
  const staying = now.filter((start) => starts.has(start));
  const found = new Map(staying.map((start) => [start, start]));
  let moved = before.filter((start) => !found.has(start));
  let next = 0; // of those that stay, the first after the one that is looked at
  for (const start of now) {
    if (starts.has(start)) {
      next += 1;
      continue;
    }
    const [low, high] = [staying[next - 1] ?? -1, staying[next] ?? Infinity];
    const near = moved.filter((each) => low < each && each < high);
    if (!near.length) continue;
    const far = (each: number): number => Math.abs(each - start);
    const nearest = near.reduce((best, each) => (far(each) < far(best) ? each : best));
    found.set(start, nearest);
    moved = moved.filter((each) => each > nearest);
  }
  return found;
}

/** A place in a table that an edit names: where a segment starts or stops. */
interface Place {
  level: Level;
  frame: number;
  end: "start" | "stop";
}

/** Who an edit is made on, in the order of the frames it names; null where there is nobody. */
export function madeOn(edit: Edit, { segmentation, ids }: IdentifiedTable): (string | null)[] {
  return placesOf(edit, segmentation).map((place) => {
    const row = segmentation.segments.findIndex((each) => isAt(each, place));
    return ids[row] ?? null;
  });
}

/** The edit as one of another table, on the same segments; null where one of them is gone. */
export function readdressed(
  edit: Edit,
  on: readonly (string | null)[],
  { segmentation, ids }: IdentifiedTable,
): Edit | null {
  const frames = placesOf(edit, segmentation).map((place, i): number | null => {
    const id = on[i] ?? null;
    if (id === null) return place.frame;
    const row = segmentation.segments[ids.indexOf(id)];
    if (!row) return null;
    return place.end === "start" ? row.start_frame : row.stop_frame;
  });
  return frames.includes(null) ? null : withFrames(edit, frames as number[]);
}

function placesOf(edit: Edit, table: Segments): Place[] {
  switch (edit.kind) {
    case "move_border":
    case "delete_border":
    case "name_segment":
    case "set_cluster":
    case "set_kind":
    case "comment":
      return [{ level: edit.level, frame: edit.frame, end: "start" }];
    case "merge":
      return [
        { level: edit.level, frame: edit.start_frame, end: "start" },
        { level: edit.level, frame: edit.stop_frame, end: "stop" },
      ];
    case "check":
      return edit.frames.map((frame) => ({ level: edit.level, frame, end: "start" }));
    case "exclude":
      return edit.frames.map((frame) => ({ level: "primitive", frame, end: "start" }));
    case "split_cluster": {
      const level = levelOf(table.segments.filter((row) => row.cluster === edit.cluster));
      return edit.frames.map((frame) => ({ level, frame, end: "start" }));
    }
    case "together":
      return edit.edits.flatMap((each) => placesOf(each, table));
    default:
      return [];
  }
}

/** The edit with other frames, in the order of `placesOf`. */
function withFrames<E extends Edit>(edit: E, frames: readonly number[]): E;
function withFrames(edit: Edit, frames: readonly number[]): Edit {
  const [first = 0, last = 0] = frames;
  switch (edit.kind) {
    case "move_border":
    case "delete_border":
    case "name_segment":
    case "set_cluster":
    case "set_kind":
    case "comment":
      return { ...edit, frame: first };
    case "merge":
      return { ...edit, start_frame: first, stop_frame: last };
    case "check":
    case "exclude":
    case "split_cluster":
      return { ...edit, frames: [...frames] };
    case "together": {
      let rest = frames;
      const edits = edit.edits.map((each) => {
        const count = countOf(each);
        const now = withFrames(each, rest.slice(0, count));
        rest = rest.slice(count);
        return now;
      });
      return { ...edit, edits };
    }
    default:
      return edit;
  }
}

/** How many frames of `placesOf` are those of an edit. */
function countOf(edit: ByHand): number {
  if ("frames" in edit) return edit.frames.length;
  if (edit.kind === "merge") return 2;
  return "level" in edit && edit.kind !== "split" ? 1 : 0;
}

function isAt(row: Segment, { level, frame, end }: Place): boolean {
  return row.level === level && frame === (end === "start" ? row.start_frame : row.stop_frame);
}

function startsOf(rows: readonly Segment[], level: Level): number[] {
  return rows.filter((row) => row.level === level).map((row) => row.start_frame);
}
