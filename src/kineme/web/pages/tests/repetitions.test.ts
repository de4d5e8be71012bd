import { expect, it } from "vitest";
import type { Segments } from "../src/messages";
import { listRepetitions } from "../src/segments";
import { segment, createTable } from "./recordings";

it("lists each activity with the durations of its repetitions", () => {
  const found = listRepetitions(
    createTable([
      segment(0, 40, { level: "activity", activity: 0 }),
      segment(40, 50, { level: "activity", activity: 1, kind: "transition" }),
      segment(50, 70, { level: "activity", activity: 2 }),
      segment(0, 5, { activity: 0, kind: "transition" }),
      segment(5, 20, { activity: 0 }),
      segment(20, 40, { activity: 0 }),
      segment(40, 50, { activity: 1, kind: "transition" }),
      segment(50, 70, { activity: 2 }),
    ]),
  );
  expect(found.map(({ activity }) => activity.start_frame)).toEqual([0, 50]);
  expect(found[0]!.durations).toEqual([1.5, 2]);
  expect(found[0]!.mean).toBe(1.75);
  expect(found[0]!.deviation).toBeCloseTo(0.3536, 4);
  expect(found[1]!.deviation).toBeNull();
});

it("counts what people left out, and leaves it out of the mean", () => {
  const walkWithout = (...excluded: number[]): Segments =>
    createTable([
      segment(0, 60, { level: "activity", activity: 0 }),
      ...[0, 20, 40].map((start) =>
        segment(start, start + 20, { activity: 0, excluded: excluded.includes(start) }),
      ),
    ]);
  const [walk] = listRepetitions(walkWithout(20));
  expect(walk!.durations).toHaveLength(3);
  expect(walk!.leftOut).toEqual([false, true, false]);
  expect(walk!.mean).toBe(2);
  expect(listRepetitions(walkWithout(0, 20, 40))[0]!.mean).toBeNull();
});
