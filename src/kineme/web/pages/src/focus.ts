/**
 * Whom a key belongs to. Text that is being typed has all keys. A control that was clicked has
 * none: what one does next with the keyboard is meant for the player. A control that was
 * reached with the Tab key keeps the keys that work it, and shows that it has the focus.
 */

const ARROWS = [
  "ArrowLeft",
  "ArrowRight",
  "ArrowUp",
  "ArrowDown",
  "Home",
  "End",
  "PageUp",
  "PageDown",
];
const PRESSES = [" ", "Enter"];
const NOT_TYPED = ["range", "checkbox", "radio", "button", "submit", "file", "color"];

let byPointer = false;
let clicked: Element | null = null;

/** Follows what was clicked and what was reached with keys; call the result to stop. */
export function watchFocus(): () => void {
  const onPointer = (): void => void (byPointer = true);
  const onKey = (event: KeyboardEvent): void => {
    if (event.key === "Tab") byPointer = false;
  };
  const onFocus = (event: FocusEvent): void => {
    clicked = byPointer && event.target instanceof Element ? event.target : null;
  };
  // The wheel would change the number in a field that has the focus.
  const onWheel = (event: WheelEvent): void => {
    const field = event.target;
    if (field instanceof HTMLInputElement && field.type === "number") field.blur();
  };
  const listeners = [
    ["pointerdown", onPointer],
    ["keydown", onKey],
    ["focusin", onFocus],
    ["wheel", onWheel],
  ] as const;
  for (const [name, listener] of listeners)
    addEventListener(name, listener as EventListener, { capture: true, passive: true });
  return () => {
    for (const [name, listener] of listeners)
      removeEventListener(name, listener as EventListener, { capture: true });
  };
}

/** Whether a key is the player's, if it has a use for it. */
export function isForPlayer(event: KeyboardEvent): boolean {
  const target = event.target instanceof HTMLElement ? event.target : null;
  if (event.defaultPrevented || target?.closest("dialog[open]")) return false;
  if (!target || target === document.body) return true;
  if (isTyped(target)) return false;
  if (event.altKey || event.ctrlKey || event.metaKey) return true; // these work no control
  return target === clicked || !keysOf(target).includes(event.key);
}

/** The control that was clicked has the focus no longer: a key was meant for the player. */
export function leaveClicked(): void {
  if (clicked instanceof HTMLElement && clicked === document.activeElement) clicked.blur();
}

function isTyped(element: HTMLElement): boolean {
  if (element instanceof HTMLInputElement) return !NOT_TYPED.includes(element.type);
  return element instanceof HTMLTextAreaElement || element.isContentEditable;
}

/** The keys that work a control. */
function keysOf(element: HTMLElement): readonly string[] {
  if (element instanceof HTMLSelectElement) return [...ARROWS, ...PRESSES];
  if (element instanceof HTMLInputElement) return element.type === "range" ? ARROWS : PRESSES;
  if (element.closest("[role=tab], [role=separator]")) return [...ARROWS, ...PRESSES];
  return element.closest("button, summary, a, label") ? PRESSES : [];
}
