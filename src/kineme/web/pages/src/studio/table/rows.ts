/** Filter and sort the rows of the segment table. Pure functions. */
import type { Level, Segment, Segments } from "../../messages";
import { compareLevel, compareTime, getDuration, getSegmentName } from "../../segments";
import { Confidence } from "../../confidence";

/** Sortable columns. */
export type Order = "start" | "duration" | "name" | "confidence";

export interface Filter {
  level: Level | "";
  kind: "" | "movement" | "transition";
  checked: "yes" | "no" | "";
  /** Part of a label, or "cluster 3". */
  text: string;
  /** Seconds. */
  shortest: number;
  longest: number;
  /** Upper limit of the confidence, 0 to 1. */
  confidenceBelow: number;
}

export const NO_FILTER: Filter = {
  level: "",
  kind: "",
  checked: "",
  text: "",
  shortest: 0,
  longest: Infinity,
  confidenceBelow: Infinity,
};

/** A segment, its row number in the table and its confidence. */
export interface Row {
  segment: Segment;
  number: number;
  confidence: Confidence;
}

export function listRows(table: Segments, filter: Filter, order: Order, down: boolean): Row[] {
  const rows = table.segments
    .map((segment, number) => ({ segment, number, confidence: new Confidence(table, segment) }))
    .filter((row) => matchesFilter(row, filter));
  const sign = down ? -1 : 1;
  const compare = COMPARE[order];
  return rows.sort((a, b) => sign * compare(a, b) || compareTime(a.segment, b.segment));
}

/** Return the rows between two indices, in either order. */
export function sliceRows(rows: readonly Row[], from: number, to: number): Row[] {
  return rows.slice(Math.min(from, to), Math.max(from, to) + 1);
}

/** Return the spans of at least two adjacent rows on the same level. */
export function findSpansToMerge(
  rows: readonly Row[],
): { level: Level; start: number; stop: number }[] {
  const spans: { level: Level; start: number; stop: number; n: number }[] = [];
  const inOrder = rows.map(({ segment }) => segment).sort(compareLevel);
  for (const { level, start_frame, stop_frame } of inOrder) {
    const last = spans.at(-1);
    if (last?.level === level && last.stop === start_frame) {
      last.stop = stop_frame;
      last.n += 1;
    } else spans.push({ level, start: start_frame, stop: stop_frame, n: 1 });
  }
  return spans.filter(({ n }) => n > 1).map(({ level, start, stop }) => ({ level, start, stop }));
}

function matchesFilter({ segment, confidence }: Row, filter: Filter): boolean {
  const { level, kind, text, shortest, longest, confidenceBelow } = filter;
  const duration = getDuration(segment);
  return (
    (!level || segment.level === level) &&
    (!kind || (segment.kind === "transition") === (kind === "transition")) &&
    (!filter.checked || Boolean(segment.checked) === (filter.checked === "yes")) &&
    matchesText(segment, text.trim().toLowerCase()) &&
    duration >= shortest &&
    duration <= longest &&
    (confidenceBelow === Infinity || (confidence.value ?? Infinity) < confidenceBelow)
  );
}

/** Match a name or cluster; "cluster 1" matches only that cluster, not 10 to 19. */
function matchesText(segment: Segment, text: string): boolean {
  const number = /^cluster (\d+)$/.exec(text)?.[1];
  if (number !== undefined && segment.cluster === Number(number)) return true;
  const cluster = segment.cluster >= 0 && number === undefined ? ` cluster ${segment.cluster}` : "";
  return `${number === undefined ? getSegmentName(segment) : segment.label}${cluster}`
    .toLowerCase()
    .includes(text);
}

const COMPARE: Record<Order, (a: Row, b: Row) => number> = {
  start: (a, b) => compareTime(a.segment, b.segment),
  duration: (a, b) => getDuration(a.segment) - getDuration(b.segment),
  name: (a, b) => getSegmentName(a.segment).localeCompare(getSegmentName(b.segment)),
  confidence: (a, b) => (a.confidence.value ?? 2) - (b.confidence.value ?? 2),
};
