/**
 * Decide whether a key press is meant for the player. Text fields get all keys. A clicked control
 * gets none. A control focused with Tab keeps the keys that operate it.
 */

import { listen } from "./layout/browser";

const NAVIGATION_KEYS = [
  "ArrowLeft",
  "ArrowRight",
  "ArrowUp",
  "ArrowDown",
  "Home",
  "End",
  "PageUp",
  "PageDown",
];
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

/** Return whether the player may handle a key press. */
export function isPlayerKey(event: KeyboardEvent): boolean {
  const target = event.target instanceof HTMLElement ? event.target : null;
  if (event.defaultPrevented || target?.closest("dialog[open]")) return false;
  if (!target || target === document.body) return true;
  if (isTextField(target)) return false;
  if (event.altKey || event.ctrlKey || event.metaKey) return true; // no control uses these
  return target === clickedElement || !getControlKeys(target).includes(event.key);
}

/** Remove the focus from a clicked control after the player handled a key. */
export function blurClicked(): void {
  if (clickedElement instanceof HTMLElement && clickedElement === document.activeElement)
    clickedElement.blur();
}

function isTextField(element: HTMLElement): boolean {
  if (element instanceof HTMLInputElement) return !NON_TEXT_TYPES.includes(element.type);
  return element instanceof HTMLTextAreaElement || element.isContentEditable;
}

/** Return the keys that operate a control. */
function getControlKeys(element: HTMLElement): readonly string[] {
  if (element instanceof HTMLSelectElement) return [...NAVIGATION_KEYS, ...ACTIVATION_KEYS];
  if (element instanceof HTMLInputElement)
    return element.type === "range" ? NAVIGATION_KEYS : ACTIVATION_KEYS;
  if (element.closest("[role=tab], [role=separator]"))
    return [...NAVIGATION_KEYS, ...ACTIVATION_KEYS];
  return element.closest("button, summary, a, label") ? ACTIVATION_KEYS : [];
}
