/** Judge hits with Y and N and move between them with arrow keys. */
import { listen } from "../../layout/browser";
import { isPlayerKey } from "../../focus";
import type { LibraryPage } from "./libraryPage";

/** Listen to the keyboard and return a function that stops; `cards` contains the hits. */
export function listenToHitKeys(page: LibraryPage, cards: () => HTMLElement | null): () => void {
  const onKey = (event: KeyboardEvent): void => {
    if (event.ctrlKey || event.altKey || event.metaKey || !isPlayerKey(event)) return;
    const at = page.frontIndex.peek();
    const hit = page.hits.peek()[at];
    const key = event.key.toLowerCase();
    if (!hit) return;
    if (key === "y" || key === "n") {
      page.judge(hit, key === "y");
      bringToFront(at + 1);
    } else {
      const by = getStep(key, cards()?.contains(event.target as Node) ?? false);
      if (!by) return;
      bringToFront(at + by);
    }
    event.preventDefault();
  };
  const bringToFront = (at: number): void => {
    const next = cards()?.children[at];
    if (next instanceof HTMLElement) next.focus(); // the focus handler makes it the current hit
  };
  return listen(window, { keydown: onKey });
}

/** Return the step of a key; up and down scroll the page unless a card has the focus. */
function getStep(key: string, onCard: boolean): number {
  const sideways: Record<string, number> = { arrowright: 1, arrowleft: -1 };
  const across: Record<string, number> = { arrowdown: 1, arrowup: -1 };
  return sideways[key] ?? (onCard ? across[key] : undefined) ?? 0;
}
