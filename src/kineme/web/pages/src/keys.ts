/** Define the keys of every page. */
import { isPlayerKey, blurClicked, watchFocus } from "./focus";
import { listen } from "./layout/browser";
import { toggleFullScreen } from "./layout/fullScreen";
import { togglePlay } from "./player";
import type { Store } from "./store";

/** Keys and their actions, as the help shows them. */
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

/** Return a key's command, or undefined. */
export function getPageCommand(
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
    i: () => store.toggleMark("start_s"),
    o: () => store.toggleMark("stop_s"),
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

/** Listen to the keyboard and return a function that stops; `more` returns further commands. */
export function listenToKeys(
  store: Store,
  more: (event: KeyboardEvent) => (() => void) | undefined = () => undefined,
): () => void {
  const stopWatching = watchFocus();
  const onKey = (event: KeyboardEvent): void => {
    if (!isPlayerKey(event)) return;
    const command = getPageCommand(event, store) ?? more(event);
    if (!command) return;
    event.preventDefault();
    blurClicked();
    command();
  };
  const stopListening = listen(window, { keydown: onKey });
  return () => {
    stopWatching();
    stopListening();
  };
}
