import type { Signal } from "@preact/signals";
import { expect, test } from "vitest";
import type { Recording } from "../src/messages";
import type { Store } from "../src/store";
import { createTable, openStore, recording, segment } from "./recordings";

const activity = segment(0, 40, { level: "activity" });
const last = segment(40, 50, { cluster: -1, kind: "transition" });
const primitives = [segment(0, 10), segment(10, 30, { cluster: 1 }), segment(30, 40), last];

function page(): Store {
  const rows = [activity, { ...last, level: "activity" as const }, ...primitives];
  return openStore(recording(createTable(rows), { n_frames: 50 }));
}

test("what is looked at is zoomed to where it would hardly be seen", () => {
  const store = page();
  const small = segment(20, 21);
  store.showSegment(primitives[1]!);
  expect(store.zoom.value).toBeNull();
  store.showSegment(small);
  const { start_s, stop_s } = store.zoom.value!;
  expect([start_s, stop_s].map((each) => each.toFixed(2))).toEqual(["1.45", "2.65"]);
  store.showSegment(primitives[1]!); // its end is not in there
  expect(store.zoom.value).toBeNull();
});

test("selecting a segment moves the playhead and shows its cluster", () => {
  const store = page();
  store.select(primitives[1]!);
  expect(store.playhead.value).toBe(1);
  expect(store.selected.value).toEqual(primitives[1]);
  expect(store.shownCluster.value?.id).toBe(1);
});

test("steps go frame by frame and segment by segment, and stop at the ends", () => {
  const store = page();
  store.step(1);
  expect(store.frame.value).toBe(1);
  store.stepSegment(1);
  expect(store.frame.value).toBe(10);
  store.step(-100);
  expect(store.frame.value).toBe(0);
  store.seek(1e9);
  expect([store.playhead.value, store.frame.value]).toEqual([5, 49]);
});

test("a loop is that of the segment under the playhead, and follows the selection", () => {
  const store = page();
  store.seek(3.5);
  store.toggleLoop();
  expect(store.loop.value).toEqual({ start_s: 3, stop_s: 4 });
  expect(store.playhead.value).toBe(3.5);
  store.select(primitives[0]!);
  expect(store.loop.value).toEqual({ start_s: 0, stop_s: 1 });
  store.toggleLoop();
  expect(store.loop.value).toBeNull();
});

test("a cluster is shown at its next member", () => {
  const store = page();
  store.seek(1.5);
  store.selectCluster(0);
  expect(store.selected.value).toEqual(primitives[2]);
  store.seek(4.5);
  store.selectCluster(0);
  expect(store.selected.value).toEqual(primitives[0]);
});

test("the view follows the playhead, and all of it is shown again at the end of zooming out", () => {
  const store = page();
  store.zoomBy(0.2, 0.5);
  store.seek(4);
  expect(store.range.value.start_s).toBeLessThanOrEqual(4);
  expect(store.range.value.stop_s).toBeGreaterThanOrEqual(4);
  store.zoomBy(100);
  expect(store.zoom.value).toBeNull();
});

test("a selection that an edit took away is none", () => {
  const store = page();
  store.select(primitives[1]!);
  const opened = store.active.value!.recording as Signal<Recording>;
  const { segmentation } = opened.value;
  const segments = segmentation.segments.filter((each) => each.start_frame !== 10);
  opened.value = { ...opened.value, segmentation: { ...segmentation, segments } };
  expect(store.selected.value).toBeUndefined();
});

test("edits are for the segment at the playhead: a selection is left with it", () => {
  const store = page();
  store.select(primitives[1]!);
  store.step(5);
  expect(store.selected.value).toEqual(primitives[1]);
  store.seek(3.2);
  expect(store.selected.value).toBeUndefined();
  expect(store.target.value).toEqual(primitives[2]);
  expect(store.border.value?.start_frame).toBe(30);
  store.toggleLevel();
  expect(store.target.value?.level).toBe("activity");
});

test("what is off the screen is brought there, and only then", () => {
  const store = page();
  store.zoom.value = { start_s: 0, stop_s: 1 };
  expect(store.reveal(0.5)).toBe(false);
  expect(store.reveal(4)).toBe(true);
  expect(store.range.value.start_s).toBeLessThanOrEqual(4);
  expect(store.reveal(4)).toBe(false);
});

test("marks are set, taken away, looped and zoomed to", () => {
  const store = page();
  store.seek(1.5);
  store.toggleMark("start_s");
  store.seek(2.5);
  store.toggleMark("stop_s");
  expect(store.getMarkedSpan()).toEqual({ start_s: 1.5, stop_s: 2.5 });
  store.toggleLoop();
  expect(store.loop.value).toEqual({ start_s: 1.5, stop_s: 2.5 });
  store.zoomToTarget();
  expect(store.range.value.start_s).toBeCloseTo(1.4);
  expect(store.range.value.stop_s).toBeCloseTo(2.6);
  store.toggleMark("stop_s");
  expect(store.getMarkedSpan()).toEqual({ start_s: 1.5, stop_s: 5 });
  store.seek(1);
  store.toggleMark("stop_s"); // before the start, which goes
  expect(store.getMarkedSpan()).toEqual({ start_s: 0, stop_s: 1 });
});
