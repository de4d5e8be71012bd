/** The keys of every page. */
import { togglePlay } from "./player";
import type { Store } from "./store";

/** Keys and what they do, as a help shows them. */
export const PAGE_KEYS: readonly (readonly [string, string])[] = [
  ["Space", "Play or pause"],
  ["← →", "One frame back or on"],
  ["Shift + ← →", "The segment before or after"],
  ["L", "Loop the segment, or stop looping"],
  ["+ −", "Zoom in or out"],
  ["Home, End", "To the start or the end"],
  ["0", "Show all of the recording"],
];

/** What a key does; undefined where it does nothing. */
export function pageCommandOf(
  event: Pick<KeyboardEvent, "key" | "ctrlKey" | "metaKey" | "shiftKey" | "altKey">,
  store: Store,
): (() => void) | undefined {
  if (event.ctrlKey || event.metaKey || event.altKey) return undefined;
  const step = (by: 1 | -1) => (): void =>
    event.shiftKey ? store.stepSegment(by) : store.step(by);
  const commands: Record<string, () => void> = {
    " ": () => togglePlay(store),
    ArrowLeft: step(-1),
    ArrowRight: step(1),
    l: () => store.toggleLoop(),
    L: () => store.toggleLoop(),
    "+": () => store.zoomBy(0.7),
    "=": () => store.zoomBy(0.7),
    "-": () => store.zoomBy(1 / 0.7),
    "0": () => void (store.zoom.value = null),
    Home: () => store.seek(0),
    End: () => store.seek(store.duration.value),
  };
  return commands[event.key];
}

/** Listens to the keyboard; fields, sliders and dialogs keep their keys, buttons keep the space bar. */
export function startKeys(store: Store): () => void {
  const onKey = (event: KeyboardEvent): void => {
    const target = event.target instanceof Element ? event.target : null;
    if (event.defaultPrevented || target?.closest("input, select, textarea, dialog")) return;
    if (event.key === " " && target?.closest("button, summary, a")) return;
    const command = pageCommandOf(event, store);
    if (!command) return;
    event.preventDefault();
    command();
  };
  addEventListener("keydown", onKey);
  return () => removeEventListener("keydown", onKey);
}
