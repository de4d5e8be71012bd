/** Which columns the folder's page shows: chosen, and remembered. */
import { signal } from "@preact/signals";
import { COLUMNS, type Column } from "./rows";

const KEY = "kineme.folder.columns";
const ALL = COLUMNS.map(({ id }) => id);

export const shownColumns = signal<readonly Column[]>(remembered());

/** Shows a column, or hides it; the name is always there. */
export function showColumn(column: Column, shown: boolean): void {
  const others = new Set(shownColumns.value.filter((id) => id !== column));
  shownColumns.value = ALL.filter((id) => (id === column ? shown : others.has(id)));
  localStorage.setItem(KEY, JSON.stringify(shownColumns.value));
}

function remembered(): readonly Column[] {
  try {
    const found: unknown = JSON.parse(localStorage.getItem(KEY) ?? "null");
    if (!Array.isArray(found)) return ALL;
    const before: Partial<Record<Column, string>> = {
      activities: "segments",
      primitives: "segments",
    };
    return ALL.filter((id) => id === "name" || found.includes(id) || found.includes(before[id]));
  } catch {
    return ALL;
  }
}
