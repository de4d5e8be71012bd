/** Build, sort and lay out the rows of the folder page. Pure functions. */
import type { Segments } from "../../messages";
import { countSegments } from "../../segments";
import { STATUS_ORDER, type Status } from "../recordingList";
import { getLowestConfidence, computeTally, type Tally } from "./briefTables";
import type { FolderMember } from "./folder";
import { signal } from "@preact/signals";
import { readStored } from "../../util";

/** Columns of the folder table. */
export type Column =
  | "name"
  | "strip"
  | "length"
  | "rate"
  | "activities"
  | "primitives"
  | "checked"
  | "least"
  | "notes"
  | "status";

/** Titles, widths and tooltips. */
export const COLUMNS: readonly {
  id: Column;
  title: string;
  /** Minimum width in pixels; `share` is its fraction of the remaining width. */
  least: number;
  share?: number;
  help: string;
}[] = [
  { id: "name", title: "Recording", least: 170, share: 1.4, help: "Its file" },
  {
    id: "strip",
    title: "Segments in time",
    least: 120,
    share: 3,
    help: "Its activities, in the colours of their clusters",
  },
  { id: "length", title: "Length", least: 64, help: "Minutes and seconds" },
  { id: "rate", title: "Rate", least: 64, help: "Frames per second" },
  { id: "activities", title: "Activities", least: 66, help: "How many it has" },
  { id: "primitives", title: "Primitives", least: 68, help: "Repetitions, and what else recurs" },
  {
    id: "checked",
    title: "Checked",
    least: 92,
    help: "How much of its table somebody checked, activities, primitives and transitions",
  },
  {
    id: "least",
    title: "Lowest confidence",
    least: 212,
    help: "The places of lowest confidence that nobody has checked",
  },
  { id: "notes", title: "Notes", least: 54, help: "Comments on its segments" },
  { id: "status", title: "Status", least: 78, help: "New, corrected, labelled or checked" },
];

const GAP = 10; // pixels between columns
const OPTIONAL_COLUMNS: readonly Column[] = [
  "rate",
  "length",
  "notes",
  "status",
  "primitives",
  "activities",
];

/** Return CSS grid columns and their minimum width in pixels. */
export function getGrid(columns: readonly (typeof COLUMNS)[number][]): [string, number] {
  const widths = columns.map(({ least, share }) =>
    share ? `minmax(${least}px, ${share}fr)` : `${least}px`,
  );
  return [widths.join(" "), columns.reduce((sum, { least }) => sum + least + GAP, GAP)];
}

/** Return the columns that fit a width; the least important are dropped first. */
export function fitColumns(
  columns: readonly (typeof COLUMNS)[number][],
  width: number,
): readonly (typeof COLUMNS)[number][] {
  let kept = columns;
  for (const id of OPTIONAL_COLUMNS) {
    if (getGrid(kept)[1] <= width) break;
    kept = kept.filter((each) => each.id !== id);
  }
  return kept;
}

export interface Row extends FolderMember {
  status: Status;
  tally: Tally | null;
  activities: number | null;
  primitives: number | null;
  least: number | null;
}

export function createRow(member: FolderMember, status: Status): Row {
  const { table } = member;
  return {
    ...member,
    status,
    tally: table && computeTally(table),
    activities: table && countSegments(table, "activity"),
    primitives: table && countSegments(table, "primitive"),
    least: table && getLowestConfidence(table),
  };
}

/** Sort rows by a column; unknown values come last. */
export function sortRows(rows: readonly Row[], by: Column, reverse: boolean): Row[] {
  const sign = reverse ? -1 : 1;
  const keys = new Map(rows.map((row) => [row, getSortKey(row, by)]));
  return [...rows].sort((a, b) => {
    const [left, right] = [keys.get(a)!, keys.get(b)!];
    if (left === null || right === null) return Number(left === null) - Number(right === null);
    if (typeof left === "string") return sign * left.localeCompare(String(right), "en");
    return sign * (left - Number(right));
  });
}

/** Return a recording's duration in seconds. */
export function getLength({ n_frames, fps }: Segments): number {
  return n_frames / fps;
}

function getSortKey(row: Row, by: Column): string | number | null {
  const { listing, table, tally } = row;
  switch (by) {
    case "name":
      return listing.name;
    case "status":
      return STATUS_ORDER.indexOf(row.status);
    case "notes":
      return row.comments || null;
    case "least":
    case "activities":
    case "primitives":
      return row[by];
    case "length":
    case "strip":
      return table && getLength(table);
    case "rate":
      return table && table.fps;
    case "checked":
      return tally && tally.checked / Math.max(tally.all, 1);
  }
}

const STORAGE_KEY = "kineme.folder.columns";
const ALL = COLUMNS.map(({ id }) => id);

/** Store which columns the folder page shows. */
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
