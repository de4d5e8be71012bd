/** The rows after an edit, of those that the server says it changed; see `web/table_changes.py`. */
import type { Segment, TableChange } from "../../messages";

export function changedBy(
  { removed, at, added }: TableChange,
  before: readonly Segment[],
): Segment[] {
  const gone = new Set(removed);
  const left = before.filter((_, row) => !gone.has(row));
  const places = new Map(at.map((row, i) => [row, added[i]!]));
  let next = 0;
  return Array.from(
    { length: left.length + added.length },
    (_, row) => places.get(row) ?? left[next++]!,
  );
}
