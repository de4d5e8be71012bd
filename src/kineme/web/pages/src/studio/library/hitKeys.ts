/** The keys of a search: Y and N for the hit in front, after which the next is; arrows go on. */
import { isForPlayer } from "../../focus";
import type { LibraryPage } from "./libraryPage";

/** Listens while hits are shown, their cards the children of `cards`; call the result to stop. */
export function startHitKeys(page: LibraryPage, cards: () => HTMLElement | null): () => void {
  const onKey = (event: KeyboardEvent): void => {
    if (event.ctrlKey || event.altKey || event.metaKey || !isForPlayer(event)) return;
    const at = page.inFront.peek();
    const hit = page.hits.peek()[at];
    const key = event.key.toLowerCase();
    if (!hit) return;
    if (key === "y" || key === "n") {
      page.judge(hit, key === "y");
      bringToFront(at + 1);
    } else {
      const by = stepOf(key, cards()?.contains(event.target as Node) ?? false);
      if (!by) return;
      bringToFront(at + by);
    }
    event.preventDefault();
  };
  const bringToFront = (at: number): void => {
    const next = cards()?.children[at];
    if (next instanceof HTMLElement) next.focus(); // which brings it to the front
  };
  addEventListener("keydown", onKey);
  return () => removeEventListener("keydown", onKey);
}

/** Arrows up and down scroll the page, but from card to card. */
function stepOf(key: string, onCard: boolean): number {
  const sideways: Record<string, number> = { arrowright: 1, arrowleft: -1 };
  const across: Record<string, number> = { arrowdown: 1, arrowup: -1 };
  return sideways[key] ?? (onCard ? across[key] : undefined) ?? 0;
}
