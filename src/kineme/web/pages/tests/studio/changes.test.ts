import { describe, expect, it } from "vitest";
import type { Edit, Segment, Segments } from "../../src/messages";
import { applyChange, retargetEdit } from "../../src/studio/editing/edits";
import { row, table } from "./tables";

const starts = ({ segments }: Segments): [string, number, number][] =>
  segments.map((each) => [each.level, each.start_frame, each.activity]);

/** Return the table with other primitives. */
function replacePrimitives(...primitives: Segment[]): Segments {
  return { ...table(), segments: [table().segments[0]!, ...primitives] };
}

describe("a change of the table", () => {
  it("takes rows away, adds rows in their place, and replaces those that are there", () => {
    const named = row("primitive", 0, 30, 0, "hop");
    const change = {
      of: 0,
      removed: [["primitive", 60] as ["primitive", number]],
      rows: [row("primitive", 50, 100), named],
      cluster_names: { 0: "hop" },
    };
    const now = applyChange(table(), change);
    expect(starts(now).map(([, start]) => start)).toEqual([0, 0, 30, 50]);
    expect(now.segments[1]).toEqual(named);
    expect(now.cluster_names).toEqual({ 0: "hop" });
  });

  it("numbers the activities anew that rows lie in", () => {
    const rows = [row("activity", 0, 30), row("activity", 30, 100)];
    const now = applyChange(table(), { of: 0, removed: [], rows, cluster_names: {} });
    expect(starts(now)).toEqual([
      ["activity", 0, 0],
      ["activity", 30, 1],
      ["primitive", 0, 0],
      ["primitive", 30, 1],
      ["primitive", 60, 1],
    ]);
  });
});

describe("an edit that waits", () => {
  const named: Edit = { kind: "name_segment", level: "primitive", frame: 30, label: "hop" };
  const moved = replacePrimitives(
    row("primitive", 0, 40),
    row("primitive", 40, 60),
    row("primitive", 60, 100),
  );
  const joined = replacePrimitives(row("primitive", 0, 60), row("primitive", 60, 100));

  it("follows its segment to where it starts by then, and back", () => {
    expect(retargetEdit(named, table(), moved)).toEqual({ ...named, frame: 40 });
    expect(retargetEdit({ ...named, frame: 40 }, moved, table())).toEqual(named);
  });

  it("is none where its segment has become part of another", () => {
    expect(retargetEdit(named, table(), joined)).toBeNull();
    const both: Edit = { kind: "check", level: "primitive", frames: [0, 30], checked: true };
    expect(retargetEdit(both, table(), joined)).toBeNull();
    expect(retargetEdit({ ...both, frames: [0, 60] }, table(), joined)).not.toBeNull();
  });

  it("joins up to a border that was moved, and to the end of the recording", () => {
    const merge = { kind: "merge", level: "primitive", start_frame: 0, stop_frame: 30 } as const;
    expect(retargetEdit(merge, table(), moved)).toEqual({ ...merge, stop_frame: 40 });
    expect(retargetEdit({ ...merge, stop_frame: 100 }, table(), moved)).toMatchObject({
      stop_frame: 100,
    });
  });

  it("makes a new border at its frame, whatever segment that lies in", () => {
    const split: Edit = { kind: "split", level: "primitive", frame: 30 };
    expect(retargetEdit(split, table(), joined)).toEqual(split);
  });
});
