/** Which segments the table shows, in which order; pure functions. */
import type { Level, Segment, Segments } from "../../messages";
import { durationOf, nameOf } from "../../segments";
import { confidenceOf, type Confidence } from "../../confidence";

/** A column by which rows are ordered. */
export type Order = "start" | "duration" | "name" | "cluster" | "confidence";

export interface Filter {
  level: Level | "";
  kind: "" | "movement" | "transition";
  checked: "yes" | "no" | "";
  /** Part of a label, or "cluster 3". */
  text: string;
  /** Seconds. */
  shortest: number;
  longest: number;
  /** Only those whose confidence is below that, 0 to 1. */
  confidenceBelow: number;
}

export const EVERYTHING: Filter = {
  level: "",
  kind: "",
  checked: "",
  text: "",
  shortest: 0,
  longest: Infinity,
  confidenceBelow: Infinity,
};

/** A segment, the number of its row in the table, and its confidence. */
export interface Row {
  segment: Segment;
  number: number;
  confidence: Confidence;
}

export function rowsOf(table: Segments, filter: Filter, order: Order, down: boolean): Row[] {
  const confidences = confidenceOf(table);
  const rows = table.segments
    .map((segment, number) => ({
      segment,
      number,
      confidence: confidences.get(segment),
    }))
    .filter((row) => passes(row, filter));
  const sign = down ? -1 : 1;
  const compare = COMPARE[order];
  return rows.sort((a, b) => sign * compare(a, b) || inTime(a.segment, b.segment));
}

/** The rows from one to another, whichever comes first. */
export function between(rows: readonly Row[], from: number, to: number): Row[] {
  return rows.slice(Math.min(from, to), Math.max(from, to) + 1);
}

/** The spans of neighbouring rows of a level, to be merged: two rows or more each. */
export function spansToMerge(
  rows: readonly Row[],
): { level: Level; start: number; stop: number }[] {
  const spans: { level: Level; start: number; stop: number; n: number }[] = [];
  const inOrder = rows.map(({ segment }) => segment).sort(byLevel);
  for (const { level, start_frame, stop_frame } of inOrder) {
    const last = spans.at(-1);
    if (last?.level === level && last.stop === start_frame) {
      last.stop = stop_frame;
      last.n += 1;
    } else spans.push({ level, start: start_frame, stop: stop_frame, n: 1 });
  }
  return spans.filter(({ n }) => n > 1).map(({ level, start, stop }) => ({ level, start, stop }));
}

function passes({ segment, confidence }: Row, filter: Filter): boolean {
  const { level, kind, text, shortest, longest, confidenceBelow } = filter;
  const duration = durationOf(segment);
  return (
    (!level || segment.level === level) &&
    (!kind || (segment.kind === "transition") === (kind === "transition")) &&
    (!filter.checked || Boolean(segment.checked) === (filter.checked === "yes")) &&
    isCalled(segment, text.trim().toLowerCase()) &&
    duration >= shortest &&
    duration <= longest &&
    (confidenceBelow === Infinity || (confidence.value ?? Infinity) < confidenceBelow)
  );
}

/** "cluster 1" is that cluster alone, not 10 to 19 as well; any other text is part of a name. */
function isCalled(segment: Segment, text: string): boolean {
  const number = /^cluster (\d+)$/.exec(text)?.[1];
  if (number !== undefined && segment.cluster === Number(number)) return true;
  const cluster = segment.cluster >= 0 && number === undefined ? ` cluster ${segment.cluster}` : "";
  return `${number === undefined ? nameOf(segment) : segment.label}${cluster}`
    .toLowerCase()
    .includes(text);
}

const inTime = (a: Segment, b: Segment): number => a.start_frame - b.start_frame || byLevel(a, b);
const byLevel = (a: Segment, b: Segment): number =>
  a.level.localeCompare(b.level) || a.start_frame - b.start_frame;

const COMPARE: Record<Order, (a: Row, b: Row) => number> = {
  start: (a, b) => inTime(a.segment, b.segment),
  duration: (a, b) => durationOf(a.segment) - durationOf(b.segment),
  name: (a, b) => nameOf(a.segment).localeCompare(nameOf(b.segment)),
  cluster: (a, b) => a.segment.cluster - b.segment.cluster,
  confidence: (a, b) => (a.confidence.value ?? 2) - (b.confidence.value ?? 2),
};
