/** What people vouch for and say of segments, as `marks.py` and `comments.py` have it. */
import type { Level, Segment } from "../../../messages";
import { allRows, starting, type Draft } from "./rows";

type Mark = "by_hand" | "checked";
type Said = [level: Level, start: number, stop: number];
type Comment = [level: Level, frame: number, text: string];

export function check(
  draft: Draft,
  level: Level,
  frames: readonly number[],
  checked: boolean,
): Draft {
  const chosen = frames.map((frame) => keyOf(starting(draft, level, frame)));
  const before = [...markedIn(draft, "checked")];
  const marks = checked ? [...before, ...chosen] : before.filter((each) => !chosen.includes(each));
  return withMarks(draft, "checked", new Set(marks));
}

export function comment(draft: Draft, level: Level, frame: number, text: string): Draft {
  const row = starting(draft, level, frame);
  const kept = commentsIn(draft).filter(([of, at]) => of !== row.level || !holds(row, at));
  const middle = Math.floor((row.start_frame + row.stop_frame) / 2);
  const said: Comment[] = text ? [...kept, [level, middle, text]] : kept;
  const { comments: _, ...provenance } = draft.provenance;
  return { ...draft, provenance: said.length ? { ...provenance, comments: said } : provenance };
}

/** The table with what an edit made of it marked as made by hand, and the edit counted. */
export function noted(before: Draft, after: Draft): Draft {
  const whole = (row: Segment): string => `${keyOf(row)} ${row.kind} ${row.cluster}`;
  const known = new Set(allRows(before).map(whole));
  const made = allRows(after).filter((row) => !known.has(whole(row)));
  const marks = new Set([...made.map(keyOf), ...markedIn(after, "by_hand")]);
  const now = withMarks(after, "by_hand", marks);
  const { corrections } = before.provenance;
  const count = typeof corrections === "number" ? corrections + 1 : 1;
  return { ...now, provenance: { ...now.provenance, corrections: count } };
}

/** The segments that carry a mark: those that have exactly the frames that were marked. */
export function markedIn(draft: Draft, mark: Mark): Set<string> {
  const said = listIn<Said>(draft, mark);
  const wanted = new Set(said.map((each) => each.join(" ")));
  return new Set(
    allRows(draft)
      .map(keyOf)
      .filter((each) => wanted.has(each)),
  );
}

export function commentsIn(draft: Draft): Comment[] {
  return listIn<Comment>(draft, "comments").sort(
    ([a, at], [b, frame]) => at - frame || (a < b ? -1 : a > b ? 1 : 0),
  );
}

export function keyOf({ level, start_frame, stop_frame }: Segment): string {
  return `${level} ${start_frame} ${stop_frame}`;
}

/** A list of triples; anything else that a file may have in its place is none. */
function listIn<Triple extends unknown[]>({ provenance }: Draft, name: string): Triple[] {
  const said: unknown = provenance[name];
  const isTriple = (each: unknown): boolean => Array.isArray(each) && each.length === 3;
  return Array.isArray(said) ? (said.filter(isTriple) as Triple[]) : [];
}

function withMarks(draft: Draft, mark: Mark, marks: ReadonlySet<string>): Draft {
  const { [mark]: _, ...provenance } = draft.provenance;
  const spans = [...marks].map((each): Said => {
    const [level, start, stop] = each.split(" ");
    return [level as Level, Number(start), Number(stop)];
  });
  return { ...draft, provenance: spans.length ? { ...provenance, [mark]: spans } : provenance };
}

function holds({ start_frame, stop_frame }: Segment, frame: number): boolean {
  return start_frame <= frame && frame < stop_frame;
}
