/** Move the playhead during playback, in step with a video if there is one. */
import { effect } from "@preact/signals";
import type { Store } from "./store";
import type { Span } from "./view";
import { ticker } from "./ticker";

const MAX_WAIT = 2; // seconds to wait for a video before going on without it

/** Start the page's clock; return a function that stops it. */
export function startPlayer(store: Store): () => void {
  let waited = 0;
  const stopClock = ticker.add((seconds) => {
    if (!store.playing.value) return;
    const { value: playhead } = store.playhead;
    const pace = store.videoTime.value?.getTime() ?? null;
    waited = pace === "waiting" ? waited + seconds : 0;
    const isWaiting = pace === "waiting" && waited < MAX_WAIT;
    const on = isWaiting || typeof pace === "number" ? 0 : seconds * store.speed.value;
    const next = advance(typeof pace === "number" ? pace : playhead, on, store.loop.value);
    if (next >= store.duration.value) store.playing.value = false;
    store.seek(next);
    ticker.request();
  });
  const stopEffect = effect(() => {
    if (store.playing.value) ticker.request();
  });
  return () => {
    stopClock();
    stopEffect();
  };
}

/** Start or pause; at the end, restart. */
export function togglePlay(store: Store): void {
  const atEnd = store.playhead.value >= store.duration.value - 0.5 / store.fps.value;
  if (!store.playing.value && atEnd && !store.loop.value) store.seek(0);
  store.playing.value = !store.playing.value;
}

/** Return the playhead advanced by some seconds; a loop wraps it to its start. */
export function advance(playhead: number, seconds: number, loop: Span | null): number {
  const next = playhead + seconds;
  if (!loop || loop.stop_s <= loop.start_s) return next;
  if (next < loop.start_s) return loop.start_s;
  if (next < loop.stop_s) return next;
  return loop.start_s + ((next - loop.start_s) % (loop.stop_s - loop.start_s));
}
