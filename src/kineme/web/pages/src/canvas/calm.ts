/** A value for the eye to read: while the page plays it changes ten times a second at most. */
import { effect, signal, type ReadonlySignal } from "@preact/signals";
import { useEffect, useMemo } from "preact/hooks";

const PAUSE = 100; // milliseconds

export function useCalm<T>(
  fast: ReadonlySignal<T>,
  playing: ReadonlySignal<boolean>,
): ReadonlySignal<T> {
  const calm = useMemo(() => signal(fast.peek()), [fast]);
  useEffect(() => {
    let last = -Infinity;
    return effect(() => {
      const value = fast.value;
      const now = performance.now();
      if (playing.value && now - last < PAUSE) return;
      last = now;
      calm.value = value;
    });
  }, [fast, playing, calm]);
  return calm;
}
