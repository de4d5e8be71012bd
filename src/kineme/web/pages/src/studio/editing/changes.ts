/** Apply the rows that the server changed to a table; see `web/tables.py`. */
import { getSegmentKey } from "../../segments";
import type { Segment, Segments, TableChange } from "../../messages";

export function applyChange(table: Segments, change: TableChange): Segments {
  const rows = new Map(table.segments.map((row) => [getSegmentKey(row), row]));
  for (const [level, start_frame] of change.removed)
    rows.delete(getSegmentKey({ level, start_frame }));
  for (const row of change.rows) rows.set(getSegmentKey(row), row);
  const { cluster_names } = change;
  return {
    ...table,
    cluster_names,
    segments: numberActivities([...rows.values()].sort(compareRows)),
  };
}

/** Return the rows with the index of the activity that contains each. */
function numberActivities(rows: readonly Segment[]): Segment[] {
  const starts = rows.filter(({ level }) => level === "activity").map((row) => row.start_frame);
  let activity = -1;
  let level = "";
  return rows.map((row) => {
    if (row.level !== level) [level, activity] = [row.level, -1];
    while (starts[activity + 1]! <= row.start_frame) activity += 1;
    return row.activity === activity ? row : { ...row, activity };
  });
}

/** Order activities before primitives, then by time. */
function compareRows(a: Segment, b: Segment): number {
  return a.level.localeCompare(b.level) || a.start_frame - b.start_frame;
}
