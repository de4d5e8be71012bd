/**
 * Store unconfirmed edits so that they survive the tab. Each tab holds a lock while it is open;
 * this distinguishes edits of closed tabs, which another tab takes over.
 */

import type { Edit } from "../../messages";

/** An unconfirmed edit. */
export interface Unsent {
  name: string;
  edit: Edit;
  /** Revision it was made on; null: the result of the previous edit. */
  base: number | null;
  /** Whether a segment that it names no longer exists. */
  isGone?: boolean;
}

const PREFIX = "kineme.unsent";
let tab = sessionStorage.getItem("kineme.tab") ?? crypto.randomUUID();

/** Lock this tab's id; a duplicated tab gets a new one. */
export async function announceTab(): Promise<void> {
  if (!(await claimTab(tab))) {
    tab = crypto.randomUUID();
    await claimTab(tab);
  }
  sessionStorage.setItem("kineme.tab", tab);
}

function claimTab(name: string): Promise<boolean> {
  return new Promise((answer) => {
    void navigator.locks.request(`${PREFIX}.${name}`, { ifAvailable: true }, (lock) => {
      answer(lock !== null);
      return lock && new Promise(() => undefined); // held until the page closes
    });
  });
}

export function storeUnsent(folder: string, recording: string, unsent: Unsent[]): void {
  const key = `${PREFIX}|${folder}|${recording}|${tab}`;
  if (unsent.length) localStorage.setItem(key, JSON.stringify(unsent));
  else localStorage.removeItem(key);
}

/** Return edits of this tab before a reload and of closed tabs; this tab now owns them. */
export async function takeOverUnsent(folder: string, recording: string): Promise<Unsent[]> {
  const { held: locks = [] } = await navigator.locks.query();
  const living = new Set(locks.map((lock) => lock.name?.slice(PREFIX.length + 1)));
  living.delete(tab);
  const found = Object.keys(localStorage)
    .filter((key) => key.startsWith(`${PREFIX}|${folder}|${recording}|`))
    .filter((key) => !living.has(key.split("|").at(-1)));
  const all = found.flatMap((key) => JSON.parse(localStorage.getItem(key)!) as Unsent[]);
  found.forEach((key) => localStorage.removeItem(key));
  return all;
}
