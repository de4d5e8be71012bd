/** Moves the playhead while the page plays, in step with a video where one is seen. */
import { effect } from "@preact/signals";
import type { Store } from "./store";
import type { Span } from "./view";
import { ticker } from "./ticker";

const PATIENCE = 2; // seconds that a page waits for the picture of a video, then it goes on

/** Starts the clock of a page; call the result to stop it. */
export function startPlayer(store: Store): () => void {
  let waited = 0; // seconds, for the video
  const stopClock = ticker.add((seconds) => {
    if (!store.playing.value) return;
    const { value: playhead } = store.playhead;
    const pace = store.film.value?.seconds() ?? null;
    waited = pace === "waits" ? waited + seconds : 0;
    const waits = pace === "waits" && waited < PATIENCE;
    const on = waits || typeof pace === "number" ? 0 : seconds * store.speed.value;
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

/** Starts or pauses; from the end it starts anew. */
export function togglePlay(store: Store): void {
  const atEnd = store.playhead.value >= store.duration.value - 0.5 / store.fps.value;
  if (!store.playing.value && atEnd && !store.loop.value) store.seek(0);
  store.playing.value = !store.playing.value;
}

/** The playhead some seconds on; inside a loop it comes back to the loop's start. */
export function advance(playhead: number, seconds: number, loop: Span | null): number {
  const next = playhead + seconds;
  if (!loop || loop.stop_s <= loop.start_s) return next;
  if (next < loop.start_s) return loop.start_s;
  if (next < loop.stop_s) return next;
  return loop.start_s + ((next - loop.start_s) % (loop.stop_s - loop.start_s));
}
