/**
 * Combine a segment's confidences into one number and explain it; list what to review first. Pure
 * functions. An activity's confidence is the product of those of its start and its cluster. A
 * primitive's confidence is that of its start.
 */
import type { Segment, Segments, Level } from "./messages";
import { memoize } from "./util";
import { compareTime, getSegmentName } from "./segments";
import { formatTime } from "./view";

/** One property of a segment and the confidence that it is right. */
interface Part {
  value: number;
  /** Return a clause that follows "the confidence". */
  describe: () => string;
}

/**
 * The confidence of a table's segment. Texts are created when they are read: a folder has thousands
 * of segments and shows few of them.
 */
export class Confidence {
  /** Probability that everything about the segment is right; null if unknown. */
  readonly value: number | null;
  private readonly parts: readonly Part[];

  constructor(
    private readonly table: Segments,
    private readonly segment: Segment,
  ) {
    this.parts = listParts(table, segment);
    this.value = this.parts.length ? this.parts.reduce((all, part) => all * part.value, 1) : null;
  }

  /** Percentage; empty if unknown. */
  get short(): string {
    return this.value === null ? "" : `${Math.round(100 * this.value)} %`;
  }

  /** "confidence" and the percentage; empty if unknown. */
  get text(): string {
    return this.short && `confidence ${this.short}`;
  }

  /** Explanation of the value, in sentences. */
  get why(): string {
    const { table, segment, parts, short } = this;
    if (!parts.length) return explainMissing(table, segment);
    if (isShare(table)) return `Its confidence is ${short}, a share and no probability.`;
    const least = parts.reduce((least, part) => (part.value < least.value ? part : least));
    return parts.length === 1
      ? `The confidence ${least.describe()} is ${short}.`
      : `The confidence that all of this is right is ${short}; the lowest is ${least.describe()}.`;
  }
}

/** Return the start frames of a table's activities. */
const getActivityStarts = memoize(
  ({ segments }: Segments) =>
    new Set(segments.filter(({ level }) => level === "activity").map((row) => row.start_frame)),
);

/** Return whether confidences are shares: published methods give one to primitives only. */
function isShare({ segments }: Segments): boolean {
  return (
    segments.some((row) => row.level === "primitive" && row.confidence !== null) &&
    segments.every((row) => row.border_confidence === null)
  );
}

function listParts(table: Segments, segment: Segment): Part[] {
  const { start_frame, start_s, confidence, border_confidence: border } = segment;
  const parts: Part[] = [];
  if (start_frame > 0 && border !== null && !startsWithActivity(table, segment))
    parts.push({
      value: border,
      describe: () => `that a segment starts at ${formatTime(start_s, 2)}`,
    });
  if (confidence !== null)
    parts.push({ value: confidence, describe: () => `that this is ${getSegmentName(segment)}` });
  return parts;
}

/** Return whether a primitive begins an activity, which then has the confidence of the start. */
function startsWithActivity(table: Segments, { level, start_frame }: Segment): boolean {
  return level === "primitive" && getActivityStarts(table).has(start_frame);
}

function explainMissing(table: Segments, segment: Segment): string {
  if (startsWithActivity(table, segment))
    return "Its confidence is that of its activity, with which it is looked at.";
  const { level, cluster } = segment;
  const members = table.segments.filter((row) => row.level === level && row.cluster === cluster);
  const alone = cluster >= 0 && members.length === 1;
  return alone ? "No other segment is like it." : "Nothing tells its confidence.";
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
    .map((segment) => ({ segment, confidence: new Confidence(table, segment) }))
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
