/** The table after an edit, from the rows that the server says it changed; see `web/tables.py`. */
import type { Segment, Segments, TableChange } from "../../messages";

export function applyChange(table: Segments, change: TableChange): Segments {
  const rows = new Map(table.segments.map((row) => [keyOf(row.level, row.start_frame), row]));
  for (const [level, start] of change.removed) rows.delete(keyOf(level, start));
  for (const row of change.rows) rows.set(keyOf(row.level, row.start_frame), row);
  const { cluster_names } = change;
  return { ...table, cluster_names, segments: numbered([...rows.values()].sort(inOrder)) };
}

/** The rows with the number of the activity that each lies in. */
function numbered(rows: readonly Segment[]): Segment[] {
  const starts = rows.filter(({ level }) => level === "activity").map((row) => row.start_frame);
  let activity = -1;
  let level = "";
  return rows.map((row) => {
    if (row.level !== level) [level, activity] = [row.level, -1];
    while (starts[activity + 1]! <= row.start_frame) activity += 1;
    return row.activity === activity ? row : { ...row, activity };
  });
}

/** Activities come before primitives. */
function inOrder(a: Segment, b: Segment): number {
  return a.level.localeCompare(b.level) || a.start_frame - b.start_frame;
}

function keyOf(level: string, start: number): string {
  return `${level} ${start}`;
}
