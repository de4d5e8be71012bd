import { expect, test } from "vitest";
import { borderNear, laneAt, layOut, roomFor, visible } from "../src/timeline/lanes";
import { segment } from "./recordings";

const primitives = [segment(0, 10), segment(10, 30), segment(30, 40)];
const activities = [segment(0, 40, { level: "activity" })];

test("lanes lie below each other and within the height", () => {
  const table = { schema: "", n_frames: 40, fps: 10, provenance: {}, timings: {} };
  const other = { name: "by hand", segmentation: { ...table, segments: primitives } };
  for (const given of [null, other]) {
    const lanes = layOut({ activities, primitives, other: given }, 160);
    expect(lanes).toHaveLength(given ? 5 : 3);
    lanes.slice(1).forEach((lane, i) => {
      expect(lane.top).toBeGreaterThanOrEqual(lanes[i]!.top + lanes[i]!.height);
    });
    expect(lanes.at(-1)!.top + lanes.at(-1)!.height).toBeLessThanOrEqual(160);
    for (const lane of lanes) expect(laneAt(lanes, lane.top + lane.height / 2)).toBe(lane);
  }
});

test("only what is in view is drawn", () => {
  expect(visible(primitives, 0, 4)).toEqual([0, 3]);
  expect(visible(primitives, 1.5, 2)).toEqual([1, 2]);
  expect(visible(primitives, 9, 10)).toEqual([3, 3]);
});

test("the border under the pointer", () => {
  expect(borderNear(primitives, 1.05, 0.1, 10)).toBe(10);
  expect(borderNear(primitives, 0.95, 0.1, 10)).toBe(10);
  expect(borderNear(primitives, 2, 0.1, 10)).toBeNull();
  expect(borderNear(primitives, 0, 0.1, 10)).toBeNull(); // the recording's start stays
});

test("a border leaves a frame to both of its segments", () => {
  expect(roomFor(primitives, 10)).toEqual([1, 29]);
});
