import { signal } from "@preact/signals";
import { expect, it } from "vitest";
import type { BriefTable, Segments } from "../../src/messages";
import {
  computeTally,
  getLowestConfidence,
  getStrip,
  unpackTable,
} from "../../src/studio/folder/briefTables";
import { NameOffer, type Folder } from "../../src/studio/folder/folder";
import { COLUMNS, createRow, fitColumns, sortRows } from "../../src/studio/folder/FolderPage";
import { brief, listing } from "./briefs";

it("offers a name for all recordings where another one has the name of before", () => {
  const recording = (names: Record<string, string>) => ({
    id: "a",
    segmentation: { cluster_names: names },
  });
  const confirmed = signal(recording({ "0": "hop", "1": "walk" }));
  const members = ["a", "b"].map((id) => ({ listing: { id }, table: unpackTable(brief(0.9)) }));
  const offer = new NameOffer({
    session: { edited: signal({ confirmed }), state: signal({ of_library: false }) },
    members: signal(members), // each has a segment called “hop”
    isReady: signal(true),
  } as unknown as Folder);
  confirmed.value = recording({ "0": "hop", "1": "run" });
  expect(offer.present.value).toBeNull();
  confirmed.value = recording({ "0": "leap", "1": "run" });
  expect(offer.present.value?.before).toBe("hop");
});

it("tells of a table what its row shows", () => {
  const table = unpackTable(brief(0.3, [0]));
  expect(computeTally(table)).toEqual({ all: 2, checked: 1, doubtful: 1 });
  expect(getLowestConfidence(table)).toBeCloseTo(0.3);
  expect(getStrip(table)).toBe(
    "linear-gradient(to right, #332288 0.00% 40.00%, #DDCC77 40.00% 100.00%)",
  );
});

it("orders recordings by a column; those without a table come last", () => {
  const member = (id: string, table: BriefTable | null) => ({
    listing: listing(id, table),
    table: table && (unpackTable(table) as Segments | null),
    comments: 0,
  });
  const rows = [
    createRow(member("a", brief(0.9)), "corrected"),
    createRow(member("b", null), "new"),
    createRow(member("c", brief(0.2)), "corrected"),
  ];
  expect(rows.map(({ activities, primitives }) => [activities, primitives])).toEqual([
    [2, 0],
    [null, null],
    [2, 0],
  ]);
  const names = (reverse: boolean): string =>
    sortRows(rows, "least", reverse)
      .map(({ listing: { id } }) => id)
      .join("");
  expect([names(false), names(true)]).toEqual(["cab", "acb"]);
});

it("leaves columns out that the width has no room for, never the places of lowest confidence", () => {
  const shown = (width: number) => fitColumns(COLUMNS, width).map(({ id }) => id);
  expect(shown(1100)).toHaveLength(COLUMNS.length);
  expect(shown(830)).toEqual(["name", "strip", "activities", "primitives", "checked", "least"]);
  expect(shown(10)).toEqual(["name", "strip", "checked", "least"]);
});
