/** List what to review, lowest confidence first. Pure functions. */
import type { Level, Segment, Segments } from "../../messages";
import { getConfidences, type Confidence } from "../../confidence";

/** A segment to review and its confidence. */
export interface Doubt {
  segment: Segment;
  confidence: Confidence;
}

/** Return the unchecked segments, lowest confidence first, unknown ones last. */
export function listDoubts(table: Segments): Doubt[] {
  const confidences = getConfidences(table);
  return table.segments
    .filter(({ checked }) => !checked)
    .map((segment) => ({ segment, confidence: confidences.get(segment) }))
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

function compareTime(a: Segment, b: Segment): number {
  return a.start_frame - b.start_frame || a.level.localeCompare(b.level);
}
