/** The table a page works on, those before it and those undone, as far as the page has seen them. */
import type { Edit } from "../../messages";
import { foreseen } from "./foreseen/foreseen";
import { idsAfter, type IdentifiedTable } from "./identities";

export interface Story {
  readonly present: IdentifiedTable;
  readonly past: readonly IdentifiedTable[];
  readonly future: readonly IdentifiedTable[];
}

export function storyOf(present: IdentifiedTable): Story {
  return { present, past: [], future: [] };
}

/** The story after an edit that the server has not answered; null where only the server knows. */
export function expected(story: Story, edit: Edit, name: string): Story | null {
  const { present, past, future } = story;
  if (edit.kind === "undo") return past.length ? withPresent(story, edit, past.at(-1)!) : null;
  if (edit.kind === "redo") return future.length ? withPresent(story, edit, future[0]!) : null;
  const segmentation = foreseen(present.segmentation, edit);
  if (segmentation === present.segmentation) return story; // it will be refused
  if (!segmentation) return null;
  return withPresent(story, edit, { segmentation, ids: idsAfter(present, segmentation, name) });
}

/** The story after an edit that made this table. */
export function withPresent(
  { past, present, future }: Story,
  edit: Edit,
  now: IdentifiedTable,
): Story {
  if (edit.kind === "undo")
    return { present: now, past: past.slice(0, -1), future: [present, ...future] };
  if (edit.kind === "redo")
    return { present: now, past: [...past, present], future: future.slice(1) };
  return { present: now, past: [...past, present], future: [] };
}

/** Whether two tables are the same in all that they hold; what they share is looked at no further. */
export function isSame(a: unknown, b: unknown): boolean {
  if (a === b) return true;
  if (typeof a !== "object" || typeof b !== "object" || !a || !b) return false;
  if (Array.isArray(a) && Array.isArray(b))
    return a.length === b.length && a.every((each, i) => isSame(each, b[i]));
  const [one, other] = [Object.entries(a), b as Record<string, unknown>];
  return (
    one.length === Object.keys(b).length && one.every(([name, each]) => isSame(each, other[name]))
  );
}

/** Which of the edits after an edit takes it back; -1: none. */
export function undoneBy(later: readonly Edit[]): number {
  let made = 0; // since then, and not taken back
  for (const [i, { kind }] of later.entries()) {
    if (kind === "undo" && made === 0) return i;
    made += kind === "undo" ? -1 : 1;
  }
  return -1;
}

/** Whether another table takes the place of the present one, which can take a while. */
export function replacesTable({ kind }: Edit): boolean {
  return ["segment", "transfer", "take_labels", "restore"].includes(kind);
}
