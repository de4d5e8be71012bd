/**
 * Combine a segment's confidences into one number and explain it; list what to review first. Pure
 * functions. An activity's confidence is the product of those of its start and its cluster. A
 * primitive's confidence is that of its start.
 */
import type { Segment, Segments, Level } from "./messages";
import { memoize } from "./util";
import { compareTime, getSegmentName } from "./segments";
import { formatTime } from "./view";

export interface Confidence {
  /** Probability that everything about the segment is right; null if unknown. */
  value: number | null;
  /** Percentage; empty if unknown. */
  short: string;
  /** "confidence" and the percentage; empty if unknown. */
  text: string;
  /** Explanation of the value, in sentences. */
  why: string;
}

/** One property of a segment and the confidence that it is right. */
interface Part {
  value: number;
  of: "start" | "cluster";
}

/** Return the confidence of a table's segment. */
export function getConfidence(table: Segments, segment: Segment): Confidence {
  return new SegmentConfidence(segment, getStatistics(table));
}

const getStatistics = memoize((table: Segments) => new TableStatistics(table));

/** Counts over the whole table that a segment's confidence depends on. */
class TableStatistics {
  readonly members = new Map<string, number>();
  /** Start frames of activities. */
  readonly starts = new Set<number>();
  /** Whether confidences are shares: published methods give one to primitives, none to borders. */
  readonly isShare: boolean;

  constructor({ segments }: Segments) {
    this.isShare =
      segments.some((row) => row.level === "primitive" && row.confidence !== null) &&
      segments.every((row) => row.border_confidence === null);
    for (const row of segments) {
      const key = getClusterKey(row);
      this.members.set(key, (this.members.get(key) ?? 0) + 1);
      if (row.level === "activity") this.starts.add(row.start_frame);
    }
  }
}

/** Texts are created lazily: a folder has thousands of segments and shows few of them. */
class SegmentConfidence implements Confidence {
  readonly value: number | null;
  private readonly parts: readonly Part[];

  constructor(
    private readonly segment: Segment,
    private readonly statistics: TableStatistics,
  ) {
    this.parts = listParts(segment, statistics);
    this.value = this.parts.length ? this.parts.reduce((all, part) => all * part.value, 1) : null;
  }

  get short(): string {
    if (this.value === null) return "";
    return `${Math.round(100 * this.value)} %`;
  }

  get text(): string {
    return this.value === null ? "" : `confidence ${this.short}`;
  }

  get why(): string {
    const { segment, statistics, parts, short } = this;
    if (!parts.length) return explainMissing(segment, statistics);
    if (statistics.isShare) return `Its confidence is ${short}, a share and no probability.`;
    const least = parts.reduce((least, part) => (part.value < least.value ? part : least));
    const that = describePart(least, segment);
    return parts.length === 1
      ? `The confidence ${that} is ${short}.`
      : `The confidence that all of this is right is ${short}; the lowest is ${that}.`;
  }
}

/** Return a clause that follows "the confidence". */
function describePart({ of }: Part, segment: Segment): string {
  if (of === "start") return `that a segment starts at ${formatTime(segment.start_s, 2)}`;
  return `that this is ${getSegmentName(segment)}`;
}

function listParts(segment: Segment, around: TableStatistics): Part[] {
  const { level, start_frame, confidence, border_confidence: border } = segment;
  const apart = level === "primitive" && around.starts.size > 0;
  const parts: Part[] = [];
  if (start_frame > 0 && border !== null && !(apart && around.starts.has(start_frame)))
    parts.push({ value: border, of: "start" });
  if (confidence !== null) parts.push({ value: confidence, of: "cluster" });
  return parts;
}

function explainMissing(segment: Segment, around: TableStatistics): string {
  if (segment.level === "primitive" && around.starts.has(segment.start_frame))
    return "Its confidence is that of its activity, with which it is looked at.";
  const alone = segment.cluster >= 0 && around.members.get(getClusterKey(segment)) === 1;
  return alone ? "No other segment is like it." : "Nothing tells its confidence.";
}

function getClusterKey({ level, cluster }: Segment): string {
  return `${level} ${cluster}`;
}

/** A segment to review and its confidence. */
export interface Doubt {
  segment: Segment;
  confidence: Confidence;
}

/** Return the unchecked segments, lowest confidence first, unknown ones last. */
export function listDoubts(table: Segments): Doubt[] {
  return table.segments
    .filter(({ checked }) => !checked)
    .map((segment) => ({ segment, confidence: getConfidence(table, segment) }))
    .sort(
      (a, b) =>
        (a.confidence.value ?? 2) - (b.confidence.value ?? 2) || compareTime(a.segment, b.segment),
    );
}

/** Count the checked and all segments of a level. */
export function countProgress(table: Segments, level: Level): [checked: number, all: number] {
  const rows = table.segments.filter((row) => row.level === level);
  return [rows.filter(({ checked }) => checked).length, rows.length];
}
