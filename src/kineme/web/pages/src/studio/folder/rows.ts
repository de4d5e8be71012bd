/** The rows of the folder's page: what they show, their order, and which are shown. Pure. */
import type { Segments } from "../../messages";
import { countOf } from "../../segments";
import type { Status } from "../recordingList";
import { leastOf, tallyOf, type Tally } from "./briefTables";
import type { Member } from "./folder";

/** What a column shows, and what the rows are ordered by. */
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

/** Titles, widths, and what stands in a tooltip. */
export const COLUMNS: readonly {
  id: Column;
  title: string;
  /** Pixels, and its share of what is left. */
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
const YIELDING: readonly Column[] = [
  "rate",
  "length",
  "notes",
  "status",
  "primitives",
  "activities",
];

/** Columns of these as a grid has them, and the pixels that they need. */
export function gridOf(columns: readonly (typeof COLUMNS)[number][]): [string, number] {
  const widths = columns.map(({ least, share }) =>
    share ? `minmax(${least}px, ${share}fr)` : `${least}px`,
  );
  return [widths.join(" "), columns.reduce((sum, { least }) => sum + least + GAP, GAP)];
}

/** Those of the columns that a width has room for; what says least is left out first. */
export function fitting(
  columns: readonly (typeof COLUMNS)[number][],
  width: number,
): readonly (typeof COLUMNS)[number][] {
  let kept = columns;
  for (const id of YIELDING) {
    if (gridOf(kept)[1] <= width) break;
    kept = kept.filter((each) => each.id !== id);
  }
  return kept;
}

export interface Row extends Member {
  status: Status;
  tally: Tally | null;
  activities: number | null;
  primitives: number | null;
  least: number | null;
}

export function rowOf(member: Member, status: Status): Row {
  const { table } = member;
  return {
    ...member,
    status,
    tally: table && tallyOf(table),
    activities: table && countOf(table, "activity"),
    primitives: table && countOf(table, "primitive"),
    least: table && leastOf(table),
  };
}

/** The rows in the order of a column; those of which nothing is known come last. */
export function ordered(rows: readonly Row[], by: Column, reverse: boolean): Row[] {
  const sign = reverse ? -1 : 1;
  const keys = new Map(rows.map((row) => [row, keyOf(row, by)]));
  return [...rows].sort((a, b) => {
    const [left, right] = [keys.get(a)!, keys.get(b)!];
    if (left === null || right === null) return Number(left === null) - Number(right === null);
    if (typeof left === "string") return sign * left.localeCompare(String(right), "en");
    return sign * (left - Number(right));
  });
}

/** Seconds of a recording. */
export function secondsOf({ n_frames, fps }: Segments): number {
  return n_frames / fps;
}

const STEPS: readonly Status[] = ["new", "corrected", "labelled", "checked"];

function keyOf(row: Row, by: Column): string | number | null {
  const { listing, table, tally } = row;
  switch (by) {
    case "name":
      return listing.name;
    case "status":
      return STEPS.indexOf(row.status);
    case "notes":
      return row.comments || null;
    case "least":
    case "activities":
    case "primitives":
      return row[by];
    case "length":
    case "strip":
      return table && secondsOf(table);
    case "rate":
      return table && table.fps;
    case "checked":
      return tally && tally.checked / Math.max(tally.all, 1);
  }
}
