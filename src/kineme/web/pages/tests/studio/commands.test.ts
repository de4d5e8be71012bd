import { expect, it } from "vitest";
import * as commands from "../../src/studio/editing/commands";
import { laneOf } from "../../src/segments";
import { table } from "./tables";

const lane = laneOf(table(), "primitive");
const at = (frame: number) => ({ lane, frame });

it("splits at the playhead, not at a border", () => {
  expect(commands.split(at(35))).toEqual({ kind: "split", level: "primitive", frame: 35 });
  expect(commands.split(at(30))).toBeNull();
});

it("merges with the next segment, where there is one", () => {
  const merge = { kind: "merge", level: "primitive", start_frame: 30, stop_frame: 100 };
  expect(commands.mergeWithNext(at(35))).toEqual(merge);
  expect(commands.mergeWithNext(at(70))).toBeNull();
});

it.each([
  [0, 30],
  [29, 30],
  [44, 30],
  [46, 60],
  [99, 60],
])("finds the border nearest to frame %i at %i", (frame, border) => {
  expect(commands.deleteBorder(at(frame))).toMatchObject({ frame: border });
});

it("finds no border in a recording that is one segment", () => {
  expect(commands.deleteBorder({ lane: lane.slice(0, 1), frame: 5 })).toBeNull();
  expect(commands.deleteBorder({ lane: [], frame: 0 })).toBeNull();
});

it("moves a border no farther than its neighbours let it", () => {
  expect(commands.nudgeBorder(at(30), 1)).toMatchObject({ frame: 30, to: 31 });
  expect(commands.nudgeBorder(at(30), 100)).toMatchObject({ frame: 30, to: 59 });
  expect(commands.nudgeBorder(at(30), -100)).toMatchObject({ frame: 30, to: 1 });
});

it("brings the border before the playhead to it, or the one after", () => {
  expect(commands.borderHere(at(45), "start")).toMatchObject({ frame: 30, to: 45 });
  expect(commands.borderHere(at(45), "stop")).toMatchObject({ frame: 60, to: 45 });
  expect(commands.borderHere(at(10), "start")).toBeNull(); // the recording starts with it
  expect(commands.borderHere(at(99), "stop")).toBeNull(); // and ends with it
  expect(commands.borderHere(at(30), "stop")).toBeNull(); // nothing would be left of it
});

it("knows where a segment starts after its border moved", () => {
  const edit = { kind: "move_border", level: "primitive", frame: 30, to: 33 } as const;
  expect(commands.followed(edit, "primitive", 30)).toBe(33);
  expect(commands.followed(edit, "primitive", 60)).toBeNull();
  expect(commands.followed(edit, "activity", 30)).toBeNull();
});
