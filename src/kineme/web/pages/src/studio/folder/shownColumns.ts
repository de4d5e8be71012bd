/** Store which columns the folder page shows. */
import { signal } from "@preact/signals";
import { readStored } from "../../layout/browser";
import { COLUMNS, type Column } from "./rows";

const STORAGE_KEY = "kineme.folder.columns";
const ALL = COLUMNS.map(({ id }) => id);

export const shownColumns = signal<readonly Column[]>(loadColumns());

/** Show or hide a column; the name is always shown. */
export function showColumn(column: Column, shown: boolean): void {
  const others = new Set(shownColumns.value.filter((id) => id !== column));
  shownColumns.value = ALL.filter((id) => (id === column ? shown : others.has(id)));
  localStorage.setItem(STORAGE_KEY, JSON.stringify(shownColumns.value));
}

function loadColumns(): readonly Column[] {
  const found = readStored(STORAGE_KEY);
  if (!Array.isArray(found)) return ALL;
  const before: Partial<Record<Column, string>> = {
    activities: "segments",
    primitives: "segments",
  };
  return ALL.filter((id) => id === "name" || found.includes(id) || found.includes(before[id]));
}
