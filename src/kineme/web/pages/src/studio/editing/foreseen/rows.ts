/**
 * Rows of one level and what an edit makes of them, as `kineme/segments/editing/rows.py` has it.
 * What the server will say counts; this is what the page shows until then.
 */
import type { Annotation, Kind, Level, Segment, Segments } from "../../../messages";
import { indexAt } from "../../../segments";

export type Rows = readonly Segment[];

/** A table while an edit is made on it. */
export interface Draft {
  readonly fps: number;
  readonly activity: Rows;
  readonly primitive: Rows;
  readonly annotation: Readonly<Annotation>;
}

/** The edit cannot be made; the server will say why. */
export class Impossible extends Error {}

export function draftOf({ fps, segments, annotation }: Segments): Draft {
  const of = (level: Level): Rows => segments.filter((row) => row.level === level);
  return { fps, activity: of("activity"), primitive: of("primitive"), annotation };
}

export function allRows({ activity, primitive }: Draft): Rows {
  return [...activity, ...primitive];
}

/** The same recording with these rows; seconds and parents follow from their frames. */
export function withRows(draft: Draft, activities: Rows, primitives: Rows): Draft {
  const derived = (row: Segment): Segment => {
    const [start_s, stop_s] = [row.start_frame / draft.fps, row.stop_frame / draft.fps];
    const activity = Math.max(indexAt(activities, row.start_frame), 0);
    const action = activities[activity]?.cluster ?? -1;
    const same =
      row.start_s === start_s &&
      row.stop_s === stop_s &&
      row.activity === activity &&
      row.action === action;
    return same ? row : { ...row, start_s, stop_s, activity, action };
  };
  return { ...draft, activity: activities.map(derived), primitive: primitives.map(derived) };
}

/** Each row as `change` makes it. */
export function eachRow(draft: Draft, change: (row: Segment) => Segment): Draft {
  return withRows(draft, draft.activity.map(change), draft.primitive.map(change));
}

export function starting(draft: Draft, level: Level, frame: number): Segment {
  const found = startingAt(draft[level], frame);
  if (!found) throw new Impossible();
  return found;
}

/** The row that starts at a frame, if one does. */
export function startingAt(rows: Rows, frame: number): Segment | undefined {
  const row = rows[indexAt(rows, frame)];
  return row?.start_frame === frame ? row : undefined;
}

/** The border at `frame` stands at `to`. */
export function moved(rows: Rows, frame: number, to: number): Rows {
  return rows.map((row) => {
    if (row.stop_frame === frame) return { ...row, stop_frame: to, confidence: null };
    if (row.start_frame !== frame) return row;
    return { ...row, start_frame: to, confidence: null, border_confidence: null };
  });
}

/** The row that `frame` lies in, if any, as two. */
export function cut(rows: Rows, frame: number): Rows {
  return rows.flatMap((row) =>
    row.start_frame < frame && frame < row.stop_frame
      ? [
          { ...row, stop_frame: frame, confidence: null },
          { ...row, start_frame: frame, confidence: null, border_confidence: null },
        ]
      : [row],
  );
}

/** Rows `first` to `last` as one that is like one of them. */
export function joined(rows: Rows, first: number, last: number, like: number): Rows {
  if (first === last) return rows;
  const { start_frame, border_confidence } = rows[first]!;
  const { stop_frame } = rows[last]!;
  const one = { ...rows[like]!, start_frame, stop_frame, confidence: null, border_confidence };
  return [...rows.slice(0, first), one, ...rows.slice(last + 1)];
}

/** A primitive that lay in one activity and lies in another. */
export function adopted(row: Segment, before: Segment, after: Segment): Segment {
  const same = (row.kind === "transition") === (before.kind === "transition");
  const kind = same ? kindOf(row.level, after.kind === "transition") : row.kind;
  const kept = row.cluster !== before.cluster || before.cluster < 0;
  const cluster = kept ? row.cluster : after.cluster;
  const label = row.label === before.label && before.label !== "" ? after.label : row.label;
  const unchanged = kind === row.kind && cluster === row.cluster;
  return { ...row, kind, cluster, label, confidence: unchanged ? row.confidence : null };
}

/** The kind of a segment of a level that is a transition, or none. */
export function kindOf(level: Level, isTransition: boolean): Kind {
  return isTransition ? "transition" : level;
}

/** The primitives once the border of activities (number, from, to) has moved. */
export function handedOver(
  primitives: Rows,
  before: Rows,
  after: Rows,
  [number, frame, to]: readonly [number, number, number],
): Rows {
  const [low, high] = [Math.min(frame, to), Math.max(frame, to)];
  const borders = cuts(primitives);
  if (!borders.includes(to)) {
    const passed = borders.filter((border) => low <= border && border <= high);
    primitives = moved(primitives, nearest(passed, to)!, to);
  }
  const [gave, took] = to < frame ? [number - 1, number] : [number, number - 1];
  const isInside = (row: Segment): boolean =>
    low <= row.start_frame && row.start_frame < high && row.stop_frame <= high;
  const inside = primitives.flatMap((row, i) => (isInside(row) ? [i] : []));
  primitives = primitives.map((row) =>
    isInside(row) ? adopted(row, before[gave]!, after[took]!) : row,
  );
  if (!inside.length || after[took]!.kind !== "transition") return primitives;
  const kept = to < frame ? inside.at(-1)! + 1 : inside[0]! - 1;
  return joined(primitives, Math.min(kept, inside[0]!), Math.max(kept, inside.at(-1)!), kept);
}

/** Where one row stops and the next starts. */
export function cuts(rows: Rows): number[] {
  return rows.slice(1).map((row) => row.start_frame);
}

/** The number of the segment after the border. */
export function afterBorder(rows: Rows, frame: number): number {
  const found = rows.findIndex((row, i) => i > 0 && row.start_frame === frame);
  if (found < 0) throw new Impossible();
  return found;
}

/** The number nearest to another; the first of two as near. */
function nearest(numbers: readonly number[], to: number): number | undefined {
  const far = (each: number): number => Math.abs(each - to);
  return numbers.reduce<number | undefined>(
    (best, each) => (best === undefined || far(each) < far(best) ? each : best),
    undefined,
  );
}
