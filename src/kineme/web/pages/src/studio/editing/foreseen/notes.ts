/** What people vouch for and say of segments, as `annotating.py` has it. */
import type { Annotation, Level, Segment } from "../../../messages";
import { allRows, starting, type Draft } from "./rows";

type Mark = "by_hand" | "checked";
type Span = Annotation[Mark][number];
type Comment = Annotation["comments"][number];

export function check(
  draft: Draft,
  level: Level,
  frames: readonly number[],
  checked: boolean,
): Draft {
  const chosen = frames.map((frame) => keyOf(starting(draft, level, frame)));
  const before = [...markedIn(draft, "checked")];
  const keys = checked ? [...before, ...chosen] : before.filter((each) => !chosen.includes(each));
  return withAnnotation(draft, "checked", new Set(keys));
}

export function comment(draft: Draft, level: Level, frame: number, text: string): Draft {
  const row = starting(draft, level, frame);
  const kept = commentsIn(draft).filter(([of, at]) => of !== row.level || !holds(row, at));
  const comments: Comment[] = text ? [...kept, [level, middleOf(row), text]] : kept;
  return { ...draft, annotation: { ...draft.annotation, comments } };
}

export function exclude(draft: Draft, frames: readonly number[], excluded: boolean): Draft {
  const rows = frames.map((frame) => starting(draft, "primitive", frame));
  const others = draft.annotation.excluded.filter((at) => !rows.some((row) => holds(row, at)));
  const all = new Set(excluded ? [...others, ...rows.map(middleOf)] : others);
  const sorted = [...all].sort((a, b) => a - b);
  return { ...draft, annotation: { ...draft.annotation, excluded: sorted } };
}

/** The table with what an edit made of it marked as made by hand, and the edit counted. */
export function noted(before: Draft, after: Draft): Draft {
  const rowKey = (row: Segment): string => `${keyOf(row)} ${row.kind} ${row.cluster}`;
  const earlier = new Set(allRows(before).map(rowKey));
  const made = allRows(after).filter((row) => !earlier.has(rowKey(row)));
  const keys = new Set([...made.map(keyOf), ...markedIn(after, "by_hand")]);
  const now = withAnnotation(after, "by_hand", keys);
  const corrections = before.annotation.corrections + 1;
  return { ...now, annotation: { ...now.annotation, corrections } };
}

/** The segments that carry a mark: those that have exactly the frames that were marked. */
export function markedIn(draft: Draft, mark: Mark): Set<string> {
  const keys = new Set(draft.annotation[mark].map((each) => each.join(" ")));
  return new Set(
    allRows(draft)
      .map(keyOf)
      .filter((each) => keys.has(each)),
  );
}

export function commentsIn(draft: Draft): Comment[] {
  return [...draft.annotation.comments].sort(
    ([a, at], [b, frame]) => at - frame || (a < b ? -1 : a > b ? 1 : 0),
  );
}

export function keyOf({ level, start_frame, stop_frame }: Segment): string {
  return `${level} ${start_frame} ${stop_frame}`;
}

function withAnnotation(draft: Draft, mark: Mark, keys: ReadonlySet<string>): Draft {
  const spans = [...keys].map((each): Span => {
    const [level, start, stop] = each.split(" ");
    return [level as Level, Number(start), Number(stop)];
  });
  return { ...draft, annotation: { ...draft.annotation, [mark]: spans } };
}

function middleOf({ start_frame, stop_frame }: Segment): number {
  return Math.floor((start_frame + stop_frame) / 2);
}

function holds({ start_frame, stop_frame }: Segment, frame: number): boolean {
  return start_frame <= frame && frame < stop_frame;
}
