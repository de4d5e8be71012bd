import { expect, it } from "vitest";
import { listDoubts, countProgress, Confidence } from "../../src/confidence";
import { sliceRows, NO_FILTER, listRows, findSpansToMerge } from "../../src/studio/table/rows";
import { segment, createTable } from "../recordings";

const rows = [
  segment(0, 10, { confidence: 0.9 }),
  segment(10, 30, { confidence: 0.8, border_confidence: 0.3, label: "hop" }),
  segment(30, 40, { cluster: 1, confidence: 0.4, border_confidence: 0.9 }),
  segment(40, 50, { cluster: -1, kind: "transition" }),
];
const table = createTable(rows);

it("shows first where confidence is lowest, and says why", () => {
  const doubts = listDoubts(table);
  expect(doubts.map(({ segment }) => segment.start_frame)).toEqual([10, 30, 0, 40]);
  expect(doubts[0]!.confidence.why).toBe(
    "The confidence that all of this is right is 24 %; the lowest is that a segment starts at 0:01.00.",
  );
  expect(doubts[1]!.confidence.why).toContain("the lowest is that this is cluster 1.");
  expect(doubts[2]!.confidence.why).toBe("The confidence that this is cluster 0 is 90 %.");
  expect(doubts[3]!.confidence.value).toBeNull();
});

it("asks once about a start that an activity and its first repetition share", () => {
  const activity = { level: "activity" as const, confidence: 0.9, border_confidence: 0.8 };
  const found = createTable([
    segment(0, 20, { ...activity, activity: 0 }),
    segment(20, 50, { ...activity, activity: 1 }),
    segment(0, 20, { activity: 0, confidence: null }),
    segment(20, 30, { activity: 1, confidence: null, border_confidence: 0.8 }),
    segment(30, 50, { activity: 1, confidence: null, border_confidence: 0.7 }),
  ]);
  const doubts = listDoubts(found);
  expect(doubts.map(({ segment }) => [segment.level, segment.start_frame])).toEqual([
    ["primitive", 30],
    ["activity", 20],
    ["activity", 0],
    ["primitive", 0],
    ["primitive", 20],
  ]);
  expect(doubts[0]!.confidence.value).toBe(0.7);
  expect(doubts[1]!.confidence.value).toBeCloseTo(0.8 * 0.9);
  expect(doubts[3]!.confidence.value).toBeNull();
});

it("has one number for a segment, wherever that is shown", () => {
  const found = createTable([
    segment(0, 40, { level: "activity", confidence: 0.19, border_confidence: null }),
    segment(0, 40, { confidence: null }),
    segment(40, 50, { level: "activity", activity: 1, confidence: 0.9, border_confidence: 0.9 }),
  ]);
  const [doubt] = listDoubts(found);
  const [first] = listRows(found, NO_FILTER, "confidence", false);
  const { short, text, why } = new Confidence(found, found.segments[0]!);
  expect([short, text]).toEqual(["19 %", "confidence 19 %"]);
  expect([doubt!.segment, doubt!.confidence.short]).toEqual([found.segments[0], short]);
  expect([first!.segment, first!.confidence.short]).toEqual([found.segments[0], short]);
  expect(why.match(/\d+ %/g)).toEqual([short]);
});

it("says of a confidence that it is no probability", () => {
  const found = createTable([
    segment(0, 10, { level: "activity", confidence: 0.4 }),
    segment(0, 10, { confidence: 0.6 }),
  ]);
  expect(listDoubts(found)[0]!.confidence.why).toBe(
    "Its confidence is 40 %, a share and no probability.",
  );
  expect(listDoubts(found)[0]!.confidence.text).toBe("confidence 40 %");
});

it("leaves out what is checked, and counts it", () => {
  const some = createTable(rows.map((row, i) => ({ ...row, checked: i === 1 || i === 2 })));
  expect(listDoubts(some).map(({ segment }) => segment.start_frame)).toEqual([0, 40]);
  expect(countProgress(some, "primitive")).toEqual([2, 4]);
  expect(countProgress(some, "activity")).toEqual([0, 0]);
});

it("orders and filters the table", () => {
  const starts = (...given: Parameters<typeof listRows>): number[] =>
    listRows(...given).map((row) => row.segment.start_frame);
  expect(starts(table, NO_FILTER, "start", false)).toEqual([0, 10, 30, 40]);
  expect(starts(table, NO_FILTER, "duration", true)).toEqual([10, 0, 30, 40]);
  expect(starts(table, NO_FILTER, "confidence", false)).toEqual([10, 30, 0, 40]);
  expect(starts(table, { ...NO_FILTER, text: "Hop" }, "start", false)).toEqual([10]);
  expect(starts(table, { ...NO_FILTER, text: "cluster 1" }, "start", false)).toEqual([30]);
  const tens = createTable([10, 1, 15].map((cluster, i) => segment(i, i + 1, { cluster })));
  expect(starts(tens, { ...NO_FILTER, text: "Cluster 1" }, "start", false)).toEqual([1]);
  expect(starts(tens, { ...NO_FILTER, text: "cluster" }, "start", false)).toEqual([0, 1, 2]);
  expect(starts(table, { ...NO_FILTER, kind: "transition" }, "start", false)).toEqual([40]);
  expect(starts(table, { ...NO_FILTER, shortest: 1.5 }, "start", false)).toEqual([10]);
  expect(starts(table, { ...NO_FILTER, confidenceBelow: 0.5 }, "start", false)).toEqual([10, 30]);
  const checked = createTable(rows.map((row, i) => ({ ...row, checked: i === 3 })));
  expect(starts(checked, { ...NO_FILTER, checked: "yes" }, "start", false)).toEqual([40]);
});

it("merges neighbours among the chosen rows, and only those", () => {
  const all = listRows(table, NO_FILTER, "start", true);
  const chosen = all.filter(({ segment }) => segment.start_frame !== 30);
  expect(findSpansToMerge(chosen)).toEqual([{ level: "primitive", start: 0, stop: 30 }]);
  expect(sliceRows(all, 2, 1)).toEqual([all[1], all[2]]);
});
