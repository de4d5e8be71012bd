/** The keys of every page. */
import { isForPlayer, leaveClicked, watchFocus } from "./focus";
import { toggleFullScreen } from "./layout/fullScreen";
import { togglePlay } from "./player";
import type { Store } from "./store";

/** Keys and what they do, as a help shows them. */
export const PAGE_KEYS: readonly (readonly [string, string])[] = [
  ["Space", "Play or pause"],
  ["← →", "One frame back or on"],
  ["Shift + ← →", "The segment before or after"],
  ["L", "Loop what is between the marks, else the segment; or stop looping"],
  ["I, O", "Mark the start or the end of what to loop; once more takes the mark away"],
  ["Z", "Zoom to what is between the marks, else to the segment"],
  [", .", "Look at coarser or finer segments"],
  ["V", "Keep the repetition as a ghost, to lay it over others; once more takes it away"],
  ["G", "Show curves and signals over time, or hide them"],
  ["F", "Full screen, and back"],
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
    i: () => store.mark("start_s"),
    o: () => store.mark("stop_s"),
    z: () => store.zoomToTarget(),
    "+": () => store.zoomBy(0.7),
    "=": () => store.zoomBy(0.7),
    "-": () => store.zoomBy(1 / 0.7),
    v: () => store.toggleGhost(),
    g: () => void (store.curves.value = !store.curves.value),
    f: toggleFullScreen,
    ",": () => store.stepDetail(-1),
    ".": () => store.stepDetail(1),
    "0": () => void (store.zoom.value = null),
    Home: () => store.seek(0),
    End: () => store.seek(store.duration.value),
  };
  return commands[event.key];
}

/** Listens to the keyboard; `more` are the keys of a page that has more of them. */
export function startKeys(
  store: Store,
  more: (event: KeyboardEvent) => (() => void) | undefined = () => undefined,
): () => void {
  const stopWatching = watchFocus();
  const onKey = (event: KeyboardEvent): void => {
    if (!isForPlayer(event)) return;
    const command = pageCommandOf(event, store) ?? more(event);
    if (!command) return;
    event.preventDefault();
    leaveClicked();
    command();
  };
  addEventListener("keydown", onKey);
  return () => {
    stopWatching();
    removeEventListener("keydown", onKey);
  };
}
