import { expect, test } from "vitest";
import {
  findBorder,
  findLane,
  findVisible,
  getBorderLimits,
  layOutLanes,
} from "../src/panels/lanes";
import { createTable, segment } from "./recordings";

const primitives = [segment(0, 10), segment(10, 30), segment(30, 40)];
const activities = [segment(0, 40, { level: "activity" })];
const shown = { activities, primitives, labels: [] };

test("lanes lie below each other and within the height", () => {
  const other = { name: "by hand", segmentation: createTable(primitives) };
  for (const others of [[], [other], [other, other]]) {
    const lanes = layOutLanes({ ...shown, others }, 160);
    expect(lanes).toHaveLength(3 + 2 * others.length);
    lanes.slice(1).forEach((lane, i) => {
      expect(lane.top).toBeGreaterThanOrEqual(lanes[i]!.top + lanes[i]!.height);
    });
    expect(lanes.at(-1)!.top + lanes.at(-1)!.height).toBeLessThanOrEqual(160);
    for (const lane of lanes) expect(findLane(lanes, lane.top + lane.height / 2)).toBe(lane);
  }
});

test("people have lanes below each other, the one in front those to edit", () => {
  const table = createTable([...activities, ...primitives]);
  const people = [
    { name: "Anna", index: 0, segmentation: table },
    { name: "Bob", index: 1, segmentation: null },
    { name: "Eve", index: 2, segmentation: createTable(activities) },
  ];
  const lanes = layOutLanes({ activities, primitives, labels: [], others: [], people }, 160);
  expect(lanes.map(({ title }) => title)).toEqual([
    "Anna",
    "",
    "Bob",
    "Primitives",
    "Labels",
    "Eve",
  ]);
  expect(lanes.map(({ person }) => person)).toEqual([0, 0, null, null, null, 2]);
  expect(lanes.filter(({ level }) => level).map(({ id }) => id)).toEqual(["activity", "primitive"]);
  expect(lanes.filter(({ isActive }) => isActive).map(({ title }) => title)).toEqual(["Bob"]);
  expect(lanes.at(-1)!.top + lanes.at(-1)!.height).toBeLessThanOrEqual(160);
});

test("only what is in view is drawn", () => {
  expect(findVisible(primitives, 0, 4)).toEqual([0, 3]);
  expect(findVisible(primitives, 1.5, 2)).toEqual([1, 2]);
  expect(findVisible(primitives, 9, 10)).toEqual([3, 3]);
});

test("the border under the pointer", () => {
  expect(findBorder(primitives, 1.05, 0.1, 10)).toBe(10);
  expect(findBorder(primitives, 0.95, 0.1, 10)).toBe(10);
  expect(findBorder(primitives, 2, 0.1, 10)).toBeNull();
  expect(findBorder(primitives, 0, 0.1, 10)).toBeNull(); // the recording's start stays
});

test("a border has at most a third of the segments beside it", () => {
  for (const reach of [0.3, 1, 100]) {
    expect(findBorder(primitives, 0.5, reach, 10)).toBeNull(); // the middle of the first
    expect(findBorder(primitives, 2, reach, 10)).toBeNull();
  }
  expect(findBorder(primitives, 0.7, 100, 10)).toBe(10);
  expect(findBorder(primitives, 1.6, 100, 10)).toBe(10);
  expect(findBorder(primitives, 1.7, 100, 10)).toBeNull();
});

test("a dragged border leaves of both of its segments what can be seen", () => {
  expect(getBorderLimits(primitives, 10, 1)).toEqual([1, 29]);
  expect(getBorderLimits(primitives, 10, 4)).toEqual([4, 26]);
  expect(getBorderLimits(primitives, 10, 15)).toEqual([10, 15]); // the first is shorter already
});

test("borders that only one of two results has are marked, in both", () => {
  const theirs = createTable([segment(0, 12), segment(12, 30), segment(30, 40)]);
  const marks = (marked: boolean) =>
    layOutLanes({ ...shown, others: [{ name: "", segmentation: theirs, marked }] }, 160).map(
      (lane) => [...lane.differences],
    );
  expect(marks(true)).toEqual([[0], [10], [], [], [12]]);
  expect(marks(false).flat()).toEqual([]);
});

test("several people have a lane each, and one more where they have primitives", () => {
  const one = { name: "Anna", segmentation: createTable(activities) };
  const two = { name: "Ben", segmentation: createTable([...activities, ...primitives]) };
  const lanes = layOutLanes({ ...shown, others: [one, two] }, 160);
  expect(lanes.slice(3).map(({ id, title }) => [id, title])).toEqual([
    ["other-activity-0", "Anna"],
    ["other-activity-1", "Ben"],
    ["other-primitive-1", ""],
  ]);
});
