import { expect, test } from "vitest";
import {
  groupClusters,
  formatCounts,
  findIndexAt,
  countLabels,
  joinLabels,
  getLane,
  getSegmentName,
  findSegmentAt,
} from "../src/segments";
import { segment, createTable } from "./recordings";

const lane = [segment(0, 10), segment(10, 30, { cluster: 1 }), segment(30, 40)];

test("the segment that holds a frame", () => {
  expect([0, 9, 10, 29, 30, 99].map((frame) => findIndexAt(lane, frame))).toEqual([
    0, 0, 1, 1, 2, 2,
  ]);
  expect(findSegmentAt([], 3)).toBeUndefined();
});

test("a lane has one level, in time order", () => {
  const activity = segment(0, 40, { level: "activity" });
  const segments = [lane[2]!, activity, lane[0]!, lane[1]!];
  const table = createTable(segments);
  expect(getLane(table, "primitive")).toEqual(lane);
  expect(getLane(table, "activity")).toEqual([activity]);
});

test("clusters are counted and timed; what is in none is left out", () => {
  const clusters = groupClusters([...lane, segment(40, 50, { cluster: -1, kind: "transition" })]);
  expect(clusters.map(({ id, members }) => [id, members.length])).toEqual([
    [0, 2],
    [1, 1],
  ]);
  expect(clusters[0]!.total_s).toBeCloseTo(2);
  expect(clusters[0]!.mean_s).toBeCloseTo(1);
});

test("neighbours of one label are one stretch", () => {
  const named = [
    segment(0, 10, { label: "walk" }),
    segment(10, 20, { label: "walk" }),
    segment(20, 30),
    segment(30, 40, { label: "walk" }),
  ];
  expect(joinLabels([], named).map((s) => [s.start_frame, s.stop_frame, s.label])).toEqual([
    [0, 20, "walk"],
    [30, 40, "walk"],
  ]);
  expect(joinLabels([segment(0, 40, { label: "all" })], lane).map((s) => s.label)).toEqual(["all"]);
});

test("names", () => {
  expect(getSegmentName(segment(0, 1, { label: "jump" }))).toBe("jump");
  expect(getSegmentName(segment(0, 1, { cluster: 3 }))).toBe("cluster 3");
  expect(getSegmentName(segment(0, 1, { cluster: -1, kind: "transition" }))).toBe("transition");
});

test("naming a primitive leaves the names of activities in the lane of labels", () => {
  const activities = [segment(0, 20, { level: "activity", label: "walk" })];
  const rows = [segment(0, 10), segment(10, 20, { label: "limp" })];
  expect(joinLabels(activities, rows).map((s) => [s.start_frame, s.label])).toEqual([
    [0, "walk"],
    [10, "limp"],
  ]);
});

test("labels are counted where there are no clusters", () => {
  const rows = [
    segment(0, 10, { cluster: -1, label: "hop" }),
    segment(10, 40, { cluster: -1, label: "walk" }),
    segment(40, 50, { cluster: -1, label: "hop" }),
    segment(50, 60, { cluster: -1 }),
  ];
  expect(countLabels(rows).map(({ label, count }) => [label, count])).toEqual([
    ["walk", 1],
    ["hop", 2],
  ]);
});

test("what a table has is counted, transitions not, one as one", () => {
  const rest = segment(30, 40, { cluster: -1, kind: "transition" });
  const activity = segment(0, 40, { level: "activity", kind: "activity" });
  expect(formatCounts(createTable([...lane.slice(0, 2), rest, activity]))).toBe(
    "1 activity, 2 primitives",
  );
});
