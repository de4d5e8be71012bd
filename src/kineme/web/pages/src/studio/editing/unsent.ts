/**
 * Edits that the server has not confirmed, stored where they outlive the tab.
 *
 * A tab holds a lock of its own name while it lives, so that another tab can
 * tell the edits of a dead one, which it takes over, from those of a living one.
 */

import type { Edit } from "../../messages";

/** An edit that was not confirmed. */
export interface Unsent {
  name: string;
  edit: Edit;
  /** The revision it was made on; null: that of the one before. */
  base: number | null;
  /** Whether a segment that it names is there no more. */
  isGone?: boolean;
}

const PREFIX = "kineme.unsent";
let tab = sessionStorage.getItem("kineme.tab") ?? crypto.randomUUID();

/** Says to other tabs that this one lives; the copy of a living tab gets a name of its own. */
export async function announceTab(): Promise<void> {
  if (!(await claimed(tab))) {
    tab = crypto.randomUUID();
    await claimed(tab);
  }
  sessionStorage.setItem("kineme.tab", tab);
}

function claimed(name: string): Promise<boolean> {
  return new Promise((answer) => {
    void navigator.locks.request(`${PREFIX}.${name}`, { ifAvailable: true }, (lock) => {
      answer(lock !== null);
      return lock && new Promise(() => undefined); // held as long as the page lives
    });
  });
}

export function store(folder: string, recording: string, unsent: Unsent[]): void {
  const key = `${PREFIX}|${folder}|${recording}|${tab}`;
  if (unsent.length) localStorage.setItem(key, JSON.stringify(unsent));
  else localStorage.removeItem(key);
}

/** The edits of this tab before it was reloaded, or of tabs that died; they are this tab's now. */
export async function takeOver(folder: string, recording: string): Promise<Unsent[]> {
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
