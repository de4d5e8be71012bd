/** Borders moved, made and taken away, as `kineme/segments/editing/borders.py` does it. */
import type { Level } from "../../../messages";
import {
  adopted,
  afterBorder,
  cut,
  cuts,
  handedOver,
  Impossible,
  joined,
  moved,
  withRows,
  type Draft,
} from "./rows";

export function moveBorder(draft: Draft, level: Level, frame: number, to: number): Draft {
  const rows = draft[level];
  const after = afterBorder(rows, frame);
  if (to <= rows[after - 1]!.start_frame || to >= rows[after]!.stop_frame) throw new Impossible();
  if (to === frame) return draft;
  const { activity, primitive } = draft;
  if (level === "primitive") {
    const both = cuts(activity).includes(frame);
    const activities = both ? moved(activity, frame, to) : activity;
    return withRows(draft, activities, moved(primitive, frame, to));
  }
  const wider = moved(activity, frame, to);
  const handed = primitive.length
    ? handedOver(primitive, activity, wider, [after, frame, to])
    : primitive;
  return withRows(draft, wider, handed);
}

export function split(draft: Draft, level: Level, frame: number): Draft {
  if (!draft[level].some((row) => row.start_frame < frame && frame < row.stop_frame))
    throw new Impossible();
  const activities = level === "activity" ? cut(draft.activity, frame) : draft.activity;
  return withRows(draft, activities, cut(draft.primitive, frame));
}

export function merge(draft: Draft, level: Level, start: number, stop: number): Draft {
  const rows = draft[level];
  const first = rows.findIndex((row) => row.start_frame === start);
  const last = rows.findIndex((row) => row.stop_frame === stop);
  if (first < 0 || last <= first) throw new Impossible();
  return merged(draft, level, first, last, first);
}

export function deleteBorder(draft: Draft, level: Level, frame: number): Draft {
  const rows = draft[level];
  const after = afterBorder(rows, frame);
  const length = (i: number): number => rows[i]!.stop_frame - rows[i]!.start_frame;
  const longer = length(after) > length(after - 1) ? after : after - 1;
  return merged(draft, level, after - 1, after, longer);
}

function merged(draft: Draft, level: Level, first: number, last: number, like: number): Draft {
  const { activity, primitive } = draft;
  if (level === "primitive") {
    if (primitive[first]!.activity !== primitive[last]!.activity) throw new Impossible();
    return withRows(draft, activity, joined(primitive, first, last, like));
  }
  const activities = joined(activity, first, last, like);
  const into = activities[first]!;
  const isInside = (each: number): boolean => first <= each && each <= last;
  const inside = primitive.flatMap((row, i) => (isInside(row.activity) ? [i] : []));
  let parts = primitive.map((row) =>
    isInside(row.activity) ? adopted(row, activity[row.activity]!, into) : row,
  );
  if (inside.length && into.kind === "transition")
    parts = [...joined(parts, inside[0]!, inside.at(-1)!, inside[0]!)];
  return withRows(draft, activities, parts);
}
