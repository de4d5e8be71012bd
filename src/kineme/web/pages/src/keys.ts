/** Define the keys of every page. */
import { listen, toggleFullScreen } from "./util";
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
function getPageCommand(
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

const ARROWS = ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"];
const NAVIGATION_KEYS = [...ARROWS, "Home", "End", "PageUp", "PageDown"];
const ACTIVATION_KEYS = [" ", "Enter"];
const NON_TEXT_TYPES = ["range", "checkbox", "radio", "button", "submit", "file", "color"];

let isPointerFocus = false;
let clickedElement: Element | null = null;

/** Track whether the focus came from a pointer or the Tab key; return a function that stops. */
export function watchFocus(): () => void {
  const onPointer = (): void => void (isPointerFocus = true);
  const onKey = (event: KeyboardEvent): void => {
    if (event.key === "Tab") isPointerFocus = false;
  };
  const onFocus = (event: FocusEvent): void => {
    clickedElement = isPointerFocus && event.target instanceof Element ? event.target : null;
  };
  // The wheel would change a focused number field.
  const onWheel = (event: WheelEvent): void => {
    const field = event.target;
    if (field instanceof HTMLInputElement && field.type === "number") field.blur();
  };
  const listeners = { pointerdown: onPointer, keydown: onKey, focusin: onFocus, wheel: onWheel };
  return listen(window, listeners, { capture: true, passive: true });
}

/**
 * Return whether the player may handle a key press. Text fields get all keys. A clicked control
 * gets none. A control focused with Tab keeps the keys that operate it.
 */
export function isPlayerKey(event: KeyboardEvent): boolean {
  const target = event.target instanceof HTMLElement ? event.target : null;
  if (event.defaultPrevented || target?.closest("dialog[open]")) return false;
  if (!target || target === document.body) return true;
  if (isTextField(target)) return false;
  if (event.altKey || event.ctrlKey || event.metaKey) return true; // no control uses these
  return target === clickedElement || !getControlKeys(target).includes(event.key);
}

/** Remove the focus from a clicked control after the player handled a key. */
function blurClicked(): void {
  if (clickedElement instanceof HTMLElement && clickedElement === document.activeElement)
    clickedElement.blur();
}

function isTextField(element: HTMLElement): boolean {
  if (element instanceof HTMLInputElement) return !NON_TEXT_TYPES.includes(element.type);
  return element instanceof HTMLTextAreaElement || element.isContentEditable;
}

/** Return the keys that operate a control. */
function getControlKeys(element: HTMLElement): readonly string[] {
  if (element instanceof HTMLInputElement)
    return element.type === "range" ? NAVIGATION_KEYS : ACTIVATION_KEYS;
  if (element instanceof HTMLSelectElement || element.closest("[role=tab], [role=separator]"))
    return [...NAVIGATION_KEYS, ...ACTIVATION_KEYS];
  return element.closest("button, summary, a, label") ? ACTIVATION_KEYS : [];
}
