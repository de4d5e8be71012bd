/** Where a result is unsure, the least sure first. Pure functions. */
import type { Level, Segment, Segments } from "../../messages";
import { clock } from "../../view";

/** A segment to look at, and why. */
export interface Doubt {
  segment: Segment;
  /** 0 to 1; null where nobody says. */
  sure: number | null;
  why: string;
}

/** The segments that are not checked: those of known sureness first, then the others in time. */
export function doubtsOf(table: Segments): Doubt[] {
  const checked = new Set(table.checked);
  const counts = new Map<string, number>();
  const key = ({ level, cluster }: Segment): string => `${level} ${cluster}`;
  for (const row of table.segments) counts.set(key(row), (counts.get(key(row)) ?? 0) + 1);
  const doubts = table.segments
    .filter((_, row) => !checked.has(row))
    .map((segment) => doubtOf(segment, counts.get(key(segment)) ?? 0));
  return doubts.sort((a, b) => (a.sure ?? 2) - (b.sure ?? 2) || before(a.segment, b.segment));
}

/** How many segments of a level there are, and how many of them are checked. */
export function progressOf(table: Segments, level: Level): [checked: number, all: number] {
  const checked = table.checked.filter((row) => table.segments[row]?.level === level);
  return [checked.length, table.segments.filter((row) => row.level === level).length];
}

function doubtOf(segment: Segment, members: number): Doubt {
  const { score, border_confidence: border, level, start_s, start_frame } = segment;
  const starts = start_frame > 0 ? border : null;
  if (starts !== null && starts <= (score ?? 1))
    return {
      segment,
      sure: starts,
      why: `It is ${percent(starts)} sure that a segment starts at ${clock(start_s, 2)}.`,
    };
  if (score !== null)
    return {
      segment,
      sure: score,
      why: `The ${level} was found with a score of ${score.toFixed(2)}.`,
    };
  const alone = segment.cluster >= 0 && members === 1;
  return {
    segment,
    sure: null,
    why: alone ? "No other segment is like it." : "Nothing says how sure it is.",
  };
}

function percent(share: number): string {
  return `${Math.round(100 * share)} %`;
}

function before(a: Segment, b: Segment): number {
  return a.start_frame - b.start_frame || a.level.localeCompare(b.level);
}
