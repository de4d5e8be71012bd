/** What to look at, lowest confidence first. Pure functions. */
import type { Level, Segment, Segments } from "../../messages";
import { confidenceOf, type Confidence } from "../../confidence";

/** A segment to look at, its confidence, and why. */
export interface Doubt extends Confidence {
  segment: Segment;
}

/** The segments that are not checked: those with a confidence first, then the others in time. */
export function doubtsOf(table: Segments): Doubt[] {
  const confidences = confidenceOf(table);
  return table.segments
    .filter(({ checked }) => !checked)
    .map((segment) => new OfOne(segment, confidences.get(segment)))
    .sort((a, b) => (a.value ?? 2) - (b.value ?? 2) || before(a.segment, b.segment));
}

/** How many segments of a level there are, and how many of them are checked. */
export function progressOf(table: Segments, level: Level): [checked: number, all: number] {
  const rows = table.segments.filter((row) => row.level === level);
  return [rows.filter(({ checked }) => checked).length, rows.length];
}

/** A doubt whose words are those of the confidence, made when they are read. */
class OfOne implements Doubt {
  readonly value: number | null;

  constructor(
    readonly segment: Segment,
    private readonly confidence: Confidence,
  ) {
    this.value = confidence.value;
  }

  get short(): string {
    return this.confidence.short;
  }

  get text(): string {
    return this.confidence.text;
  }

  get why(): string {
    return this.confidence.why;
  }
}

function before(a: Segment, b: Segment): number {
  return a.start_frame - b.start_frame || a.level.localeCompare(b.level);
}
