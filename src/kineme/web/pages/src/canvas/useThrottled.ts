/** Return a copy of a signal that changes at most ten times a second during playback. */
import { effect, signal, type ReadonlySignal } from "@preact/signals";
import { useEffect, useMemo } from "preact/hooks";

const INTERVAL = 100; // milliseconds

export function useThrottled<T>(
  fast: ReadonlySignal<T>,
  playing: ReadonlySignal<boolean>,
): ReadonlySignal<T> {
  const calm = useMemo(() => signal(fast.peek()), [fast]);
  useEffect(() => {
    let last = -Infinity;
    return effect(() => {
      const value = fast.value;
      const now = performance.now();
      if (playing.value && now - last < INTERVAL) return;
      last = now;
      calm.value = value;
    });
  }, [fast, playing, calm]);
  return calm;
}
