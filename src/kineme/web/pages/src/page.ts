/**
 * Start what every page with a recording has: playback, the keyboard, printing, and a snapshot of
 * the state for tests. Decide which keys belong to the focused control.
 */
import { effect } from "@preact/signals";
import { isPrinting, ticker } from "./drawing";
import type { Store } from "./store";
import { listen, toggleFullScreen } from "./util";
import type { Span } from "./view";

const MAX_WAIT = 2; // seconds to wait for a video before going on without it
const ARROWS = ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"];
const NAVIGATION_KEYS = [...ARROWS, "Home", "End", "PageUp", "PageDown"];
const ACTIVATION_KEYS = [" ", "Enter"];
const TEXT_FIELDS = "textarea, input:is([type=text], [type=number], [type=search])";

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

let isPointerFocus = false;
let clickedElement: Element | null = null;

/**
 * Start playback, keys and printing, and expose the state as read-only `window.kineme`.
 *
 * @param getCommand returns further commands of keys
 * @param getState returns further properties of the snapshot
 */
export function startPage(
  store: Store,
  getCommand: (event: KeyboardEvent) => (() => void) | undefined = () => undefined,
  getState = (): object => ({}),
): void {
  startPlayer(store);
  startPrinting();
  watchFocus();
  const onKey = (event: KeyboardEvent): void => {
    if (!isPlayerKey(event)) return;
    const command = getPageCommand(event, store) ?? getCommand(event);
    if (!command) return;
    event.preventDefault();
    blurClicked();
    command();
  };
  listen(window, { keydown: onKey });
  const get = (): object => Object.freeze({ ...createSnapshot(store), ...getState() });
  Object.defineProperty(window, "kineme", { get });
}

/** Move the playhead during playback, in step with a video if there is one. */
function startPlayer(store: Store): void {
  let waited = 0;
  ticker.add((seconds) => {
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
  effect(() => {
    if (store.playing.value) ticker.request();
  });
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

/** Track whether the focus came from a pointer or the Tab key. */
export function watchFocus(): void {
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
  listen(window, listeners, { capture: true, passive: true });
}

/**
 * Return whether the player may handle a key press. Text fields get all keys. A clicked control
 * gets none. A control focused with Tab keeps the keys that operate it.
 */
export function isPlayerKey(event: KeyboardEvent): boolean {
  const target = event.target instanceof HTMLElement ? event.target : null;
  if (event.defaultPrevented || target?.closest("dialog[open]")) return false;
  if (!target || target === document.body) return true;
  if (target.matches(TEXT_FIELDS)) return false;
  if (event.altKey || event.ctrlKey || event.metaKey) return true; // no control uses these
  return target === clickedElement || !getControlKeys(target).includes(event.key);
}

/** Remove the focus from a clicked control after the player handled a key. */
function blurClicked(): void {
  if (clickedElement instanceof HTMLElement && clickedElement === document.activeElement)
    clickedElement.blur();
}

/** Return the keys that operate a control. */
function getControlKeys(element: HTMLElement): readonly string[] {
  if (element.matches("[type=range]")) return NAVIGATION_KEYS;
  if (element.closest("select, [role=tab], [role=separator]"))
    return [...NAVIGATION_KEYS, ...ACTIVATION_KEYS];
  return element.closest("button, input, summary, a, label") ? ACTIVATION_KEYS : [];
}

/**
 * Print pages in light colours. Canvases are redrawn at once, since a printing browser draws no
 * further frames. 3-D canvases would be empty, so images replace them.
 */
function startPrinting(): void {
  const images: HTMLImageElement[] = [];
  addEventListener("beforeprint", () => {
    isPrinting.value = true;
    ticker.drawNow();
    for (const canvas of document.querySelectorAll<HTMLCanvasElement>(".viewer canvas")) {
      const image = new Image();
      image.className = "on-paper";
      image.src = canvas.toDataURL();
      canvas.after(image);
      images.push(image);
    }
  });
  addEventListener("afterprint", () => {
    isPrinting.value = false;
    for (const image of images.splice(0)) image.remove();
  });
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
