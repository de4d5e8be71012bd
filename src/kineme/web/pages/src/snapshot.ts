/** Expose the state as read-only `window.kineme`, for tests. */
import type { Store } from "./store";
import { ticker } from "./ticker";

/** Expose the state; `more` returns further properties. */
export function exposeSnapshot(store: Store, more = (): object => ({})): void {
  const get = (): object => Object.freeze({ ...createSnapshot(store), ...more() });
  Object.defineProperty(window, "kineme", { get });
}

function createSnapshot(store: Store): object {
  const recording = store.recording.value;
  return {
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
    /** Frames drawn within the last second, and in total. */
    rate: ticker.measureRate(),
    drawn: ticker.drawn,
  };
}
