/** What a stream has told so far, as long as it is shown. Pure functions. */
import type { LiveEvent, LiveHead, LiveUpdate } from "../../messages";

/** Seconds that the timeline and the curves show. */
export const TIMELINE_S = 120;
export const CURVES_S = 20;
const MOST_PAST = 200;
/** Seconds without a row after which the page says so. */
const SILENT_S = 2;
/** Repetitions from which the tempo is taken, the last ones. */
const TEMPO_OF = 5;

/** A part of the timeline; what has no end yet goes on. */
export interface Part {
  start_s: number;
  stop_s: number | null;
  cluster: number;
  label: string;
}

/** Activities and repetitions; gaps are in neither. */
interface Parts {
  activities: readonly Part[];
  repetitions: readonly Part[];
}

type Now = Pick<LiveUpdate, "now_s" | "silent_s" | "has_ended" | "pose">;

export interface Live extends Now {
  head: LiveHead;
  /** The activity that goes on, as far as is known. */
  current: { name: string; cluster: number; count: number; stops: readonly number[] } | null;
  final: Parts;
  provisional: Parts;
  /** Up to here the final parts hold, beyond it the provisional ones. */
  frontier: number;
  gaps: readonly Part[];
  /** Activities that are over, the last one first. */
  past: readonly LiveEvent[];
  notice: string;
  samples: readonly { seconds: number; values: readonly (number | null)[] }[];
}

const NOTHING: Parts = { activities: [], repetitions: [] };
const NEW: Omit<Live, keyof Now | "head"> = {
  current: null,
  final: NOTHING,
  provisional: NOTHING,
  frontier: 0,
  gaps: [],
  past: [],
  notice: "",
  samples: [],
};

/** The state after an update; null before the first one, which has a head. */
export function updated(before: Live | null, update: LiveUpdate): Live | null {
  const { head, now_s, silent_s, has_ended, events, pose } = update;
  const begun = head ? { ...NEW, head } : before;
  if (!begun) return null;
  const live = events.reduce(follow, { ...begun, now_s, silent_s, has_ended, pose });
  const fresh = update.samples.map((values, i) => ({
    seconds: update.first_s + i / live.head.sample_fps,
    values,
  }));
  const isRecent = (part: Part): boolean => (part.stop_s ?? now_s) > now_s - TIMELINE_S;
  const recent = (parts: Parts): Parts => ({
    activities: parts.activities.filter(isRecent),
    repetitions: parts.repetitions.filter(isRecent),
  });
  return {
    ...live,
    final: recent(live.final),
    provisional: recent(live.provisional),
    gaps: live.gaps.filter(isRecent),
    samples: [...live.samples, ...fresh].filter(({ seconds }) => seconds > now_s - CURVES_S),
  };
}

function follow(live: Live, event: LiveEvent): Live {
  const { start_s, stop_s, cluster, label } = event;
  const whole: Part = { start_s, stop_s, cluster, label };
  if (event.event === "Notice") return { ...live, notice: event.text };
  if (event.event === "Gap") {
    const gap = event.state === "final" ? whole : { ...whole, stop_s: null };
    return { ...live, gaps: [...closed(live.gaps), gap] };
  }
  const parts = live[event.state];
  const isFinal = event.state === "final";
  if (event.event === "Repetition") {
    const repetitions = [...parts.repetitions, whole];
    const next = { ...live, [event.state]: { ...parts, repetitions } };
    if (isFinal) return { ...next, frontier: stop_s };
    const stops = [...(live.current?.stops ?? []), stop_s].slice(-TEMPO_OF);
    const name = live.current?.name ?? nameOf(event);
    return { ...next, current: { name, cluster, count: event.number, stops } };
  }
  const hasStarted = event.event === "ActivityStarted";
  const part = hasStarted ? { ...whole, stop_s: null } : whole;
  const activities = [...closed(parts.activities), part];
  const next = { ...live, [event.state]: { ...parts, activities } };
  if (hasStarted) {
    const current = { name: nameOf(event), cluster, count: 0, stops: [] };
    return isFinal ? { ...next, frontier: start_s } : { ...next, current };
  }
  const isOver = !isFinal || stop_s >= event.at_s; // or the recording has ended
  const current = isOver ? null : live.current;
  if (!isFinal) return { ...next, current };
  return { ...next, current, frontier: stop_s, past: [event, ...live.past].slice(0, MOST_PAST) };
}

/** Parts without the one that goes on. */
function closed(parts: readonly Part[]): readonly Part[] {
  return parts.filter(({ stop_s }) => stop_s !== null);
}

export function nameOf({ label, cluster }: { label: string; cluster: number }): string {
  return label || `cluster ${cluster}`;
}

/** The parts to draw up to now, provisional ones from the frontier on only. */
export function partsToDraw(
  { now_s, frontier, ...live }: Live,
  level: keyof Parts,
): (Part & { stop_s: number; isFinal: boolean })[] {
  const parts = [
    ...live.final[level].map((part) => {
      return { ...part, stop_s: part.stop_s ?? frontier, isFinal: true };
    }),
    ...live.provisional[level].map((part) => {
      const start_s = Math.max(part.start_s, frontier);
      return { ...part, start_s, stop_s: part.stop_s ?? now_s, isFinal: false };
    }),
  ];
  return parts.filter(({ start_s, stop_s }) => stop_s > start_s);
}

/** Repetitions a minute; null where there are too few. */
export function tempoOf(stops: readonly number[]): number | null {
  const lasted = (stops.at(-1) ?? 0) - (stops[0] ?? 0);
  return lasted > 0 ? (60 * (stops.length - 1)) / lasted : null;
}

/** What is to be said of the source. */
export function statusOf(live: Live | null, connected: boolean): string {
  if (live?.has_ended) return "The recording has ended.";
  if (!connected) return "kineme does not answer.";
  if (!live) return "Waiting for the first row.";
  if (live.silent_s > SILENT_S) return "The source has stopped: no rows come.";
  if (live.gaps.at(-1)?.stop_s === null) return "Gap: rows hold no values.";
  return "Recording.";
}
