/** Listen to events and read stored settings. */

/** Add event listeners and return a function that removes them. */
export function listen(
  target: EventTarget,
  listeners: Record<string, (event: never) => void>,
  options: AddEventListenerOptions = {},
): () => void {
  const entries = Object.entries(listeners) as [string, EventListener][];
  for (const [name, listener] of entries) target.addEventListener(name, listener, options);
  return () => {
    for (const [name, listener] of entries) target.removeEventListener(name, listener, options);
  };
}

/** Return a setting from the browser's storage; null if it is missing or unreadable. */
export function readStored(key: string): unknown {
  try {
    return JSON.parse(localStorage.getItem(key) ?? "null");
  } catch {
    return null;
  }
}
