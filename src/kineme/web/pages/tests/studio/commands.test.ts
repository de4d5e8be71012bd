import { expect, it } from "vitest";
import * as commands from "../../src/studio/editing/edits";
import { getLane } from "../../src/segments";
import { table } from "./tables";

const lane = getLane(table(), "primitive");
const at = (frame: number) => ({ lane, frame });

it("splits at the playhead, not at a border", () => {
  expect(commands.createSplit(at(35))).toEqual({ kind: "split", level: "primitive", frame: 35 });
  expect(commands.createSplit(at(30))).toBeNull();
});

it("merges with the next segment, where there is one", () => {
  const merge = { kind: "merge", level: "primitive", start_frame: 30, stop_frame: 100 };
  expect(commands.createMerge(at(35))).toEqual(merge);
  expect(commands.createMerge(at(70))).toBeNull();
});

it.each([
  [0, 30],
  [29, 30],
  [44, 30],
  [46, 60],
  [99, 60],
])("finds the border nearest to frame %i at %i", (frame, border) => {
  expect(commands.createDeletion(at(frame))).toMatchObject({ frame: border });
});

it("finds no border in a recording that is one segment", () => {
  expect(commands.createDeletion({ lane: lane.slice(0, 1), frame: 5 })).toBeNull();
  expect(commands.createDeletion({ lane: [], frame: 0 })).toBeNull();
});

it("moves a border no farther than its neighbours let it", () => {
  expect(commands.createNudge(at(30), 1)).toMatchObject({ frame: 30, to: 31 });
  expect(commands.createNudge(at(30), 100)).toMatchObject({ frame: 30, to: 59 });
  expect(commands.createNudge(at(30), -100)).toMatchObject({ frame: 30, to: 1 });
});

it("brings the border before the playhead to it, or the one after", () => {
  expect(commands.createBorderMove(at(45), "start")).toMatchObject({ frame: 30, to: 45 });
  expect(commands.createBorderMove(at(45), "stop")).toMatchObject({ frame: 60, to: 45 });
  expect(commands.createBorderMove(at(10), "start")).toBeNull(); // the recording starts with it
  expect(commands.createBorderMove(at(99), "stop")).toBeNull(); // and ends with it
  expect(commands.createBorderMove(at(30), "stop")).toBeNull(); // nothing would be left of it
});

it("knows where a segment starts after its border moved", () => {
  const edit = { kind: "move_border", level: "primitive", frame: 30, to: 33 } as const;
  expect(commands.getMovedStart(edit, "primitive", 30)).toBe(33);
  expect(commands.getMovedStart(edit, "primitive", 60)).toBeNull();
  expect(commands.getMovedStart(edit, "activity", 30)).toBeNull();
});
