/** What people vouch for and say of segments, as `marks.py` and `comments.py` have it. */
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
  const middle = Math.floor((row.start_frame + row.stop_frame) / 2);
  const comments: Comment[] = text ? [...kept, [level, middle, text]] : kept;
  return { ...draft, annotation: { ...draft.annotation, comments } };
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

function holds({ start_frame, stop_frame }: Segment, frame: number): boolean {
  return start_frame <= frame && frame < stop_frame;
}
