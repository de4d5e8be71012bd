/** The table after an edit, of what the server says is other; see `kineme/web/table_changes.py`. */
import type { Annotation, Segment, SpansChange, TableChange } from "../../messages";
import type { IdentifiedTable } from "./identities";
import { tableOf } from "./foreseen/foreseen";
import { draftOf, withRows } from "./foreseen/rows";

type Span = Annotation["checked"][number];

/** The table that `change` makes of the one that it is a change of. */
export function changedBy(
  change: TableChange,
  { segmentation, ids }: IdentifiedTable,
): IdentifiedTable {
  const removed = new Set(change.removed);
  const isKept = (_: unknown, row: number): boolean => !removed.has(row);
  const rows = segmentation.segments.filter(isKept);
  const who = ids.filter(isKept);
  for (const [i, row] of change.at.entries()) {
    rows.splice(row, 0, change.added[i]!);
    who.splice(row, 0, "");
  }
  for (const { column, value, rows: numbers } of change.cells)
    for (const row of numbers) rows[row] = { ...rows[row], [column]: value } as Segment;
  for (const [row, id] of change.ids) who[row] = id;
  const annotation = annotationAfter(segmentation.annotation, change);
  const draft = draftOf({ ...segmentation, segments: rows, annotation });
  const now = withRows(draft, draft.activity, draft.primitive);
  return { segmentation: tableOf(segmentation, now), ids: who };
}

function annotationAfter(before: Annotation, change: TableChange): Annotation {
  return {
    checked: spansAfter(before.checked, change.checked),
    by_hand: spansAfter(before.by_hand, change.by_hand),
    comments: change.comments ?? before.comments,
    cluster_names: change.cluster_names ?? before.cluster_names,
    corrections: change.corrections,
    excluded: change.excluded ?? before.excluded,
  };
}

/** Spans in the order that they are kept in: by level, then by frames. */
function spansAfter(before: Span[], { added, removed }: SpansChange): Span[] {
  if (!added.length && !removed.length) return before;
  const without = new Set(removed.map(String));
  const kept = before.filter((each) => !without.has(String(each)));
  return [...kept, ...added].sort(
    ([level, start, stop], [other, from, to]) =>
      level.localeCompare(other) || start - from || stop - to,
  );
}
