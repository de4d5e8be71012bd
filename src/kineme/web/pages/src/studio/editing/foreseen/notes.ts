/** What people vouch for and say of segments, as `annotating.py` has it. */
import type { Annotation, Level, Segment } from "../../../messages";
import { allRows, starting, startingAt, type Draft } from "./rows";

type Mark = "by_hand" | "checked";
type Span = Annotation[Mark][number];
type Comment = Annotation["comments"][number];

export function check(
  draft: Draft,
  level: Level,
  frames: readonly number[],
  checked: boolean,
): Draft {
  const marked = markedIn(draft, "checked");
  for (const row of frames.map((frame) => starting(draft, level, frame)))
    if (checked) marked.add(row);
    else marked.delete(row);
  return withMarked(draft, "checked", marked);
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
  const marked = markedIn(after, "by_hand");
  const earlier = new Set(without(before, after).map(keyOf));
  for (const row of without(after, before)) if (!earlier.has(keyOf(row))) marked.add(row);
  const now = withMarked(after, "by_hand", marked);
  const corrections = before.annotation.corrections + 1;
  return { ...now, annotation: { ...now.annotation, corrections } };
}

/** The segments that carry a mark: those that have exactly the frames that were marked. */
export function markedIn(draft: Draft, mark: Mark): Set<Segment> {
  const found = new Set<Segment>();
  for (const [level, start, stop] of draft.annotation[mark]) {
    const row = startingAt(draft[level], start);
    if (row?.stop_frame === stop) found.add(row);
  }
  return found;
}

export function commentsIn(draft: Draft): Comment[] {
  return [...draft.annotation.comments].sort(
    ([a, at], [b, frame]) => at - frame || (a < b ? -1 : a > b ? 1 : 0),
  );
}

/** The rows of one that are none of the other: edits leave what they do not touch. */
function without(draft: Draft, other: Draft): Segment[] {
  const others = new Set(allRows(other));
  return allRows(draft).filter((row) => !others.has(row));
}

function keyOf({ level, start_frame, stop_frame, kind, cluster }: Segment): string {
  return `${level} ${start_frame} ${stop_frame} ${kind} ${cluster}`;
}

function withMarked(draft: Draft, mark: Mark, marked: ReadonlySet<Segment>): Draft {
  const spans = allRows(draft)
    .filter((row) => marked.has(row))
    .map(({ level, start_frame, stop_frame }): Span => [level, start_frame, stop_frame]);
  return { ...draft, annotation: { ...draft.annotation, [mark]: spans } };
}

function middleOf({ start_frame, stop_frame }: Segment): number {
  return Math.floor((start_frame + stop_frame) / 2);
}

function holds({ start_frame, stop_frame }: Segment, frame: number): boolean {
  return start_frame <= frame && frame < stop_frame;
}
