/**
 * The confidence of a segment: one number, the same wherever it is shown, and what it is of. Pure.
 *
 * Of an activity can be wrong where it starts, what it is, and how often it is repeated: its
 * confidence is that of all of them together. Left to its repetitions is where each begins.
 */
import type { Segment, Segments } from "./messages";
import { nameOf } from "./segments";
import { clock } from "./view";

export interface Confidence {
  /** How probable it is that all of it is right; null where nobody says. */
  value: number | null;
  /** The number as it is shown in a list; empty where there is none. */
  short: string;
  /** The number with its name; empty where there is none. */
  text: string;
  /** What it is of, and what of that it is lowest for, in sentences. */
  why: string;
}

/** Something that can be wrong with a segment, and the confidence that it is right. */
interface Part {
  value: number;
  of: "start" | "cluster" | "count";
}

/** The confidence of each segment of a table. */
export function confidenceOf(table: Segments): Confidences {
  let found = confidences.get(table);
  if (!found) confidences.set(table, (found = new Confidences(table)));
  return found;
}

/** The confidences of the segments of a table, each made when it is asked for. */
class Confidences {
  private readonly around: Around;

  constructor(table: Segments) {
    this.around = new Around(table);
  }

  get(segment: Segment): Confidence {
    return new OfOne(segment, this.around);
  }
}

const confidences = new WeakMap<Segments, Confidences>();

/** What a segment is judged by besides its own row. */
class Around {
  readonly members = new Map<string, number>();
  /** Of each activity: how many repetitions are counted, and the least confidence of them. */
  readonly counts = new Map<number, { times: number; value: number }>();
  /** Frames at which activities start. */
  readonly starts = new Set<number>();
  /** Whether confidences are probabilities, as they are where those of borders are known. */
  readonly probable: boolean;

  constructor({ segments }: Segments) {
    this.probable = segments.some((row) => row.border_confidence !== null);
    for (const row of segments) {
      const key = clusterOf(row);
      this.members.set(key, (this.members.get(key) ?? 0) + 1);
      if (row.level === "activity") this.starts.add(row.start_frame);
      else if (row.confidence !== null) {
        const { times, value } = this.counts.get(row.activity) ?? { times: 0, value: 1 };
        this.counts.set(row.activity, { times: times + 1, value: Math.min(value, row.confidence) });
      }
    }
  }
}

/** Its words are made when they are read: of the thousands of a folder, few are. */
class OfOne implements Confidence {
  readonly value: number | null;
  private readonly parts: readonly Part[];

  constructor(
    private readonly segment: Segment,
    private readonly around: Around,
  ) {
    this.parts = partsOf(segment, around);
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
    const { segment, around, parts, short } = this;
    if (!parts.length) return reasonOfNone(segment, around);
    if (!around.probable) return `Its confidence is ${short}, a share and no probability.`;
    const least = parts.reduce((least, part) => (part.value < least.value ? part : least));
    const that = claimOf(least, segment, around);
    return parts.length === 1
      ? `The confidence ${that} is ${short}.`
      : `The confidence that all of this is right is ${short}; the lowest is ${that}.`;
  }
}

/** What a part says, after "the confidence". */
function claimOf({ of }: Part, segment: Segment, around: Around): string {
  if (of === "start") return `that a segment starts at ${clock(segment.start_s, 2)}`;
  if (of === "cluster") return `that this is ${nameOf(segment)}`;
  const times = around.counts.get(segment.activity)?.times ?? 1;
  return `that this is done ${times === 1 ? "once" : `${times} times`}`;
}

function partsOf(segment: Segment, around: Around): Part[] {
  const { level, start_frame, confidence, border_confidence: border } = segment;
  const apart = level === "primitive" && around.starts.size > 0;
  const parts: Part[] = [];
  if (start_frame > 0 && border !== null && !(apart && around.starts.has(start_frame)))
    parts.push({ value: border, of: "start" });
  if (confidence !== null && !(apart && around.probable))
    parts.push({ value: confidence, of: "cluster" });
  const counted = level === "activity" && around.probable && around.counts.get(segment.activity);
  if (counted) parts.push({ value: counted.value, of: "count" });
  return parts;
}

function reasonOfNone(segment: Segment, around: Around): string {
  if (segment.level === "primitive" && segment.confidence !== null)
    return "Its confidence is that of its activity, with which it is looked at.";
  const alone = segment.cluster >= 0 && around.members.get(clusterOf(segment)) === 1;
  return alone ? "No other segment is like it." : "Nothing tells its confidence.";
}

function clusterOf({ level, cluster }: Segment): string {
  return `${level} ${cluster}`;
}
