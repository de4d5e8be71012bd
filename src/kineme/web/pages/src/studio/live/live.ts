/** Collect the recent events of a live recording. Pure functions. */
import type { LiveEvent, LiveHead, LiveUpdate } from "../../messages";

/** Seconds shown by the timeline and the curves. */
export const TIMELINE_S = 120;
export const CURVES_S = 20;
const MAX_PAST = 200;
/** Seconds without a row after which the page reports it. */
const MAX_SILENCE_S = 2;
/** Number of last repetitions that determine the tempo. */
const TEMPO_REPETITIONS = 5;

/** A part of the timeline; a null stop means that it continues. */
interface Part {
  start_s: number;
  stop_s: number | null;
  cluster: number;
  label: string;
}

/** Activities and repetitions, without gaps. */
interface Parts {
  activities: readonly Part[];
  repetitions: readonly Part[];
}

type LiveMoment = Pick<LiveUpdate, "now_s" | "silent_s" | "has_ended" | "pose">;

export interface Live extends LiveMoment {
  head: LiveHead;
  /** The current activity, if known. */
  current: { name: string; cluster: number; count: number; stops: readonly number[] } | null;
  final: Parts;
  provisional: Parts;
  /** Seconds up to which final parts hold; provisional ones follow. */
  frontier: number;
  gaps: readonly Part[];
  /** Finished activities, latest first. */
  past: readonly LiveEvent[];
  notice: string;
  samples: readonly { seconds: number; values: readonly (number | null)[] }[];
}

const NOTHING: Parts = { activities: [], repetitions: [] };
const NEW: Omit<Live, keyof LiveMoment | "head"> = {
  current: null,
  final: NOTHING,
  provisional: NOTHING,
  frontier: 0,
  gaps: [],
  past: [],
  notice: "",
  samples: [],
};

/** Return the state after an update; null before the first, which has a head. */
export function applyUpdate(before: Live | null, update: LiveUpdate): Live | null {
  const { head, now_s, silent_s, has_ended, events, pose } = update;
  const begun = head ? { ...NEW, head } : before;
  if (!begun) return null;
  const live = events.reduce(applyEvent, { ...begun, now_s, silent_s, has_ended, pose });
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

function applyEvent(live: Live, event: LiveEvent): Live {
  const { start_s, stop_s, cluster, label } = event;
  const whole: Part = { start_s, stop_s, cluster, label };
  if (event.event === "Notice") return { ...live, notice: event.text };
  if (event.event === "Gap") {
    const gap = event.state === "final" ? whole : { ...whole, stop_s: null };
    return { ...live, gaps: [...filterFinished(live.gaps), gap] };
  }
  const parts = live[event.state];
  const isFinal = event.state === "final";
  if (event.event === "Repetition") {
    const repetitions = [...parts.repetitions, whole];
    const next = { ...live, [event.state]: { ...parts, repetitions } };
    if (isFinal) return { ...next, frontier: stop_s };
    const stops = [...(live.current?.stops ?? []), stop_s].slice(-TEMPO_REPETITIONS);
    const name = live.current?.name ?? getPartName(event);
    return { ...next, current: { name, cluster, count: event.number, stops } };
  }
  const hasStarted = event.event === "ActivityStarted";
  const part = hasStarted ? { ...whole, stop_s: null } : whole;
  const activities = [...filterFinished(parts.activities), part];
  const next = { ...live, [event.state]: { ...parts, activities } };
  if (hasStarted) {
    const current = { name: getPartName(event), cluster, count: 0, stops: [] };
    return isFinal ? { ...next, frontier: start_s } : { ...next, current };
  }
  const isOver = !isFinal || stop_s >= event.at_s; // or the recording has ended
  const current = isOver ? null : live.current;
  if (!isFinal) return { ...next, current };
  return { ...next, current, frontier: stop_s, past: [event, ...live.past].slice(0, MAX_PAST) };
}

/** Return the parts that have ended. */
function filterFinished(parts: readonly Part[]): readonly Part[] {
  return parts.filter(({ stop_s }) => stop_s !== null);
}

export function getPartName({ label, cluster }: { label: string; cluster: number }): string {
  return label || `cluster ${cluster}`;
}

/** Return the parts to draw; provisional ones start at the frontier. */
export function listPartsToDraw(
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

/** Return repetitions per minute; null if there are too few. */
export function computeTempo(stops: readonly number[]): number | null {
  const lasted = (stops.at(-1) ?? 0) - (stops[0] ?? 0);
  return lasted > 0 ? (60 * (stops.length - 1)) / lasted : null;
}

/** Describe the state of the source. */
export function describeStatus(live: Live | null, connected: boolean): string {
  if (live?.has_ended) return "The recording has ended.";
  if (!connected) return "kineme does not answer.";
  if (!live) return "Waiting for the first row.";
  if (live.silent_s > MAX_SILENCE_S) return "The source has stopped: no rows come.";
  if (live.gaps.at(-1)?.stop_s === null) return "Gap: rows hold no values.";
  return "Recording.";
}
