/**
 * How sure a segment is: one number, the same wherever it is shown, and what it is of. Pure.
 *
 * Of an activity can be wrong where it starts, what it is, and how often it is repeated: it is as
 * sure as all of them together. What is left to its repetitions is where each begins.
 */
import type { Segment, Segments } from "./messages";
import { nameOf } from "./segments";
import { clock } from "./view";

export interface Sureness {
  /** How probable it is that all of it is right; null where nobody says. */
  sure: number | null;
  /** The number as it is shown in a list; empty where there is none. */
  short: string;
  /** The number with its name; empty where there is none. */
  text: string;
  /** What is sure, and what of it is least so, in sentences. */
  why: string;
}

/** Something that can be wrong with a segment: how sure it is that… */
interface Part {
  sure: number;
  that: string;
}

/** The sureness of each segment of a table. */
export function surenessOf(table: Segments): ReadonlyMap<Segment, Sureness> {
  let found = known.get(table);
  if (!found) {
    const around = new Around(table);
    found = new Map(table.segments.map((segment) => [segment, ofOne(segment, around)]));
    known.set(table, found);
  }
  return found;
}

const known = new WeakMap<Segments, ReadonlyMap<Segment, Sureness>>();

/** What a segment is judged by besides its own row. */
class Around {
  readonly members = new Map<string, number>();
  /** Of each activity: how many repetitions are counted, and the least confidence of them. */
  readonly counts = new Map<number, { times: number; sure: number }>();
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
        const { times, sure } = this.counts.get(row.activity) ?? { times: 0, sure: 1 };
        this.counts.set(row.activity, { times: times + 1, sure: Math.min(sure, row.confidence) });
      }
    }
  }
}

function ofOne(segment: Segment, around: Around): Sureness {
  const parts = partsOf(segment, around);
  if (!parts.length) return { sure: null, short: "", text: "", why: reasonOfNone(segment, around) };
  const sure = parts.reduce((all, part) => all * part.sure, 1);
  if (!around.probable) {
    const short = sure.toFixed(2);
    const why = `Its confidence is ${short}, a share and no probability.`;
    return { sure, short, text: `confidence ${short}`, why };
  }
  const short = `${Math.round(100 * sure)} %`;
  const text = `${short} sure`;
  const { that } = parts.reduce((least, part) => (part.sure < least.sure ? part : least));
  const why =
    parts.length === 1
      ? `It is ${text} ${that}.`
      : `It is ${text} that all of this is right. Least sure is ${that}.`;
  return { sure, short, text, why };
}

function partsOf(segment: Segment, around: Around): Part[] {
  const { level, start_frame, start_s, confidence, border_confidence: border } = segment;
  const apart = level === "primitive" && around.starts.size > 0;
  const parts: Part[] = [];
  if (start_frame > 0 && border !== null && !(apart && around.starts.has(start_frame)))
    parts.push({ sure: border, that: `that a segment starts at ${clock(start_s, 2)}` });
  if (confidence !== null && !(apart && around.probable))
    parts.push({ sure: confidence, that: `that this is ${nameOf(segment)}` });
  const counted = level === "activity" && around.probable && around.counts.get(segment.activity);
  if (counted) {
    const { times, sure } = counted;
    parts.push({ sure, that: `that this is done ${times === 1 ? "once" : `${times} times`}` });
  }
  return parts;
}

function reasonOfNone(segment: Segment, around: Around): string {
  if (segment.level === "primitive" && segment.confidence !== null)
    return "It is as sure as its activity, with which it is looked at.";
  const alone = segment.cluster >= 0 && around.members.get(clusterOf(segment)) === 1;
  return alone ? "No other segment is like it." : "Nothing says how sure it is.";
}

function clusterOf({ level, cluster }: Segment): string {
  return `${level} ${cluster}`;
}
