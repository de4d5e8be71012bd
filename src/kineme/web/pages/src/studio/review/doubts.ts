/** Where a result is unsure, the least sure first. Pure functions. */
import type { Level, Segment, Segments } from "../../messages";
import { nameOf } from "../../segments";
import { clock } from "../../view";

/** A segment to look at, and why. */
export interface Doubt {
  segment: Segment;
  /** How probable it is that all of it is right; null where nobody says. */
  sure: number | null;
  /** What is least sure of it, in a sentence. */
  why: string;
}

/** Something that can be wrong with a segment. */
interface Part {
  sure: number;
  why: string;
}

/**
 * The segments that are not checked: those of known sureness first, then the others in time.
 *
 * Of an activity can be wrong where it starts, what it is, and how often it is repeated: one look
 * settles all three, so they are one entry, as sure as all of them together. What is left to its
 * repetitions is where each begins.
 */
export function doubtsOf(table: Segments): Doubt[] {
  const checked = new Set(table.checked);
  const known = new Known(table);
  return table.segments
    .filter((_, row) => !checked.has(row))
    .map((segment) => doubtOf(segment, known))
    .sort((a, b) => (a.sure ?? 2) - (b.sure ?? 2) || before(a.segment, b.segment));
}

/** How many segments of a level there are, and how many of them are checked. */
export function progressOf(table: Segments, level: Level): [checked: number, all: number] {
  const checked = table.checked.filter((row) => table.segments[row]?.level === level);
  return [checked.length, table.segments.filter((row) => row.level === level).length];
}

/** What a segment is judged by besides its own row. */
class Known {
  readonly members = new Map<string, number>();
  /** Of each activity: the scores of its repetitions. */
  readonly repetitions = new Map<number, number[]>();
  /** Frames at which activities start. */
  readonly starts = new Set<number>();
  /** Whether scores are probabilities, as they are where those of borders are known. */
  readonly probable: boolean;

  constructor({ segments }: Segments) {
    this.probable = segments.some((row) => row.border_confidence !== null);
    for (const row of segments) {
      const key = clusterOf(row);
      this.members.set(key, (this.members.get(key) ?? 0) + 1);
      if (row.level === "activity") this.starts.add(row.start_frame);
      else if (row.score !== null)
        this.repetitions.set(row.activity, [
          ...(this.repetitions.get(row.activity) ?? []),
          row.score,
        ]);
    }
  }
}

function doubtOf(segment: Segment, known: Known): Doubt {
  const parts = partsOf(segment, known);
  if (parts.length) {
    const worst = parts.reduce((least, part) => (part.sure < least.sure ? part : least));
    return { segment, sure: parts.reduce((all, { sure }) => all * sure, 1), why: worst.why };
  }
  if (segment.level === "primitive" && segment.score !== null)
    return { segment, sure: null, why: "It is looked at with its activity." };
  const alone = segment.cluster >= 0 && known.members.get(clusterOf(segment)) === 1;
  const why = alone ? "No other segment is like it." : "Nothing says how sure it is.";
  return { segment, sure: null, why };
}

function partsOf(segment: Segment, known: Known): Part[] {
  const { level, start_frame, start_s, score, border_confidence: border } = segment;
  const apart = level === "primitive" && known.starts.size > 0;
  const parts: Part[] = [];
  if (start_frame > 0 && border !== null && !(apart && known.starts.has(start_frame)))
    parts.push({
      sure: border,
      why: `It is ${percent(border)} sure that a segment starts at ${clock(start_s, 2)}.`,
    });
  if (score !== null && !apart)
    parts.push({
      sure: score,
      why: known.probable
        ? `It is ${percent(score)} sure that this is ${nameOf(segment)}.`
        : `The ${level} was found with a score of ${score.toFixed(2)}.`,
    });
  const counted = level === "activity" && known.repetitions.get(segment.activity);
  if (counted) {
    const sure = Math.min(...counted);
    const times = counted.length === 1 ? "once" : `${counted.length} times`;
    parts.push({ sure, why: `It is ${percent(sure)} sure that this is done ${times}.` });
  }
  return parts;
}

function clusterOf({ level, cluster }: Segment): string {
  return `${level} ${cluster}`;
}

function percent(share: number): string {
  return `${Math.round(100 * share)} %`;
}

function before(a: Segment, b: Segment): number {
  return a.start_frame - b.start_frame || a.level.localeCompare(b.level);
}
