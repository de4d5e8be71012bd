/** Expose the state as read-only `window.kineme`, for tests. */
import type { Selection } from "./state";
import type { Store } from "./store";
import type { Span } from "./view";
import { ticker } from "./ticker";

export interface Snapshot {
  readonly name: string;
  readonly playhead: number;
  readonly frame: number;
  readonly duration: number;
  readonly playing: boolean;
  readonly speed: number;
  readonly loop: Span | null;
  readonly selection: Selection | null;
  readonly cluster: number | null;
  readonly inStep: boolean;
  readonly range: Span;
  readonly revision: number;
  readonly saved: string;
  readonly n_segments: number;
  readonly finding: boolean;
  readonly hasMotion: boolean;
  readonly other: string | null;
  readonly others: readonly string[];
  /** Frames drawn within the last second, and in total. */
  readonly rate: number;
  readonly drawn: number;
}

declare global {
  interface Window {
    readonly kineme: Snapshot;
  }
}

export function exposeSnapshot(store: Store): void {
  Object.defineProperty(window, "kineme", { get: () => createSnapshot(store), configurable: true });
}

/** Return the current state of the page. */
export function createSnapshot(store: Store): Snapshot {
  const recording = store.recording.value;
  return Object.freeze({
    name: recording?.name ?? "",
    playhead: store.playhead.value,
    frame: store.frame.value,
    duration: store.duration.value,
    playing: store.playing.value,
    speed: store.speed.value,
    loop: store.loop.value,
    selection: store.selection.value,
    cluster: store.cluster.value,
    inStep: store.inStep.value,
    range: store.range.value,
    revision: recording?.revision ?? 0,
    saved: recording?.saved ?? "",
    n_segments: store.table.value?.segments.length ?? 0,
    finding: recording?.finding ?? false,
    hasMotion: Boolean(store.active.value?.motion.value),
    other: store.others.value[0]?.name ?? null,
    others: store.others.value.map(({ name }) => name),
    rate: ticker.measureRate(),
    drawn: ticker.drawn,
  });
}
