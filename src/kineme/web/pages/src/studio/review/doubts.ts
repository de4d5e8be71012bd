/** Where a result is unsure, the least sure first. Pure functions. */
import type { Level, Segment, Segments } from "../../messages";
import { surenessOf, type Sureness } from "../../sureness";

/** A segment to look at, how sure it is, and why. */
export interface Doubt extends Sureness {
  segment: Segment;
}

/** The segments that are not checked: those of known sureness first, then the others in time. */
export function doubtsOf(table: Segments): Doubt[] {
  const checked = new Set(table.checked);
  const sureness = surenessOf(table);
  return table.segments
    .filter((_, row) => !checked.has(row))
    .map((segment) => ({ segment, ...sureness.get(segment)! }))
    .sort((a, b) => (a.sure ?? 2) - (b.sure ?? 2) || before(a.segment, b.segment));
}

/** How many segments of a level there are, and how many of them are checked. */
export function progressOf(table: Segments, level: Level): [checked: number, all: number] {
  const checked = table.checked.filter((row) => table.segments[row]?.level === level);
  return [checked.length, table.segments.filter((row) => row.level === level).length];
}

function before(a: Segment, b: Segment): number {
  return a.start_frame - b.start_frame || a.level.localeCompare(b.level);
}
