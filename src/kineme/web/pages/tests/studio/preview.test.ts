import { describe, expect, it } from "vitest";
import type { Edit, Segments } from "../../src/messages";
import { fingerprint, inWords, isDone, preview } from "../../src/studio/editing/preview";
import { row, starts, table } from "./tables";

const EDITS: Edit[] = [
  { kind: "move_border", level: "primitive", frame: 30, to: 40 },
  { kind: "split", level: "primitive", frame: 45 },
  { kind: "merge", level: "primitive", start_frame: 0, stop_frame: 60 },
  { kind: "delete_border", level: "primitive", frame: 60 },
  { kind: "name_segment", level: "primitive", frame: 30, label: "squat" },
  { kind: "name_cluster", cluster: 0, label: "jump" },
  { kind: "set_cluster", level: "primitive", frame: 30, cluster: 2 },
  { kind: "set_kind", level: "primitive", frame: 30, to: "transition" },
];

describe("preview", () => {
  it.each(EDITS)("of $kind shows it, and the table it was made from stays", (edit) => {
    const before = table();
    const after = preview(before, [edit]);
    expect(isDone(edit, before)).toBe(false);
    expect(isDone(edit, after)).toBe(true);
    expect(before).toEqual(table());
    expect(fingerprint(after)).not.toBe(fingerprint(before));
  });

  it.each(EDITS)("of $kind leaves a level that covers the recording", (edit) => {
    expectTiled(preview(table(), [edit]));
  });

  it("moves a border with its seconds", () => {
    const { segments } = preview(table(), [EDITS[0]!]);
    expect(segments[1]).toEqual(row("primitive", 0, 40, 0));
    expect(segments[2]).toEqual(row("primitive", 40, 60, 1));
  });

  it("gives a deleted border's span to the longer segment, a merged one's to the first", () => {
    const deleted = preview(table(), [EDITS[3]!]).segments;
    expect(deleted.at(-1)).toEqual(row("primitive", 30, 100, 0));
    const merged = preview(table(), [{ ...EDITS[2]!, start_frame: 30, stop_frame: 100 } as Edit]);
    expect(merged.segments.at(-1)).toEqual(row("primitive", 30, 100, 1));
  });

  it("applies edits in order", () => {
    expect(starts(preview(table(), EDITS.slice(0, 2)))).toEqual([0, 40, 45, 60]);
  });

  it.each<Edit>([
    { kind: "move_border", level: "primitive", frame: 31, to: 40 },
    { kind: "move_border", level: "primitive", frame: 30, to: 60 },
    { kind: "move_border", level: "primitive", frame: 0, to: 10 },
    { kind: "split", level: "primitive", frame: 30 },
    { kind: "merge", level: "primitive", start_frame: 30, stop_frame: 60 },
    { kind: "delete_border", level: "primitive", frame: 0 },
    { kind: "name_segment", level: "primitive", frame: 1, label: "x" },
    { kind: "undo" },
    { kind: "segment", preset: "kineme", parameters: {} },
  ])("shows nothing of $kind where only the server can tell", (edit) => {
    expect(preview(table(), [edit]).segments).toEqual(table().segments);
  });
});

it("says every edit in words, with seconds", () => {
  expect(inWords(EDITS[0]!, 10)).toBe("primitive border from 3.00 s to 4.00 s");
  expect(EDITS.map((edit) => inWords(edit, 10)).every(Boolean)).toBe(true);
});

function expectTiled({ segments, n_frames }: Segments): void {
  const lane = segments.filter((segment) => segment.level === "primitive");
  expect(lane.map((segment) => segment.stop_frame)).toEqual([
    ...lane.slice(1).map((segment) => segment.start_frame),
    n_frames,
  ]);
}
