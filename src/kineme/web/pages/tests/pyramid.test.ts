import { expect, test } from "vitest";
import {
  chooseLevel,
  chooseRows,
  findStoredTile,
  getParent,
  listTiles,
} from "../src/panels/matrixDrawing";

const head = { fps: 10, tile: 256, sizes: [1000, 500, 250] };

test("cells are about as large as pixels", () => {
  expect(chooseLevel(head, 0.1)).toBe(0);
  expect(chooseLevel(head, 0.2)).toBe(1);
  expect(chooseLevel(head, 100)).toBe(2);
  expect(chooseLevel(head, 0.001)).toBe(0);
});

test("the tiles of a view, and no others", () => {
  const whole = { start_s: 0, stop_s: 100 };
  expect(listTiles(head, 2, whole, whole)).toEqual([{ level: 2, row: 0, column: 0 }]);
  expect(listTiles(head, 0, whole, whole)).toHaveLength(16);
  const part = listTiles(head, 0, { start_s: 0, stop_s: 10 }, { start_s: 30, stop_s: 60 });
  expect(part.map((place) => [place.row, place.column])).toEqual([
    [0, 1],
    [0, 2],
  ]);
});

test("tiles above the diagonal are mirror images", () => {
  expect(findStoredTile({ level: 0, row: 1, column: 3 })).toEqual({
    place: { level: 0, row: 3, column: 1 },
    mirrored: true,
  });
  expect(findStoredTile({ level: 0, row: 3, column: 1 }).mirrored).toBe(false);
});

test("a coarser tile stands in for a missing one", () => {
  expect(getParent({ level: 0, row: 3, column: 2 })).toEqual({ level: 1, row: 1, column: 1 });
});

test("rows follow the columns, until they were moved alone", () => {
  const columns = { start_s: 10, stop_s: 20 };
  expect(chooseRows(null, columns)).toBe(columns);
  const moved = { start_s: 40, stop_s: 50 };
  expect(chooseRows(moved, columns)).toBe(moved);
  expect(chooseRows(moved, { start_s: 10, stop_s: 15 })).toEqual({ start_s: 10, stop_s: 15 });
});
