import { expect, it } from "vitest";
import { formatCount } from "../../src/util";
import { describeEdit } from "../../src/studio/editing/edits";

it("says edits in words, with seconds", () => {
  const move = { kind: "move_border", level: "primitive", frame: 30, to: 40 } as const;
  expect(describeEdit(move, 10)).toBe("primitive border from 3.00 s to 4.00 s");
  expect(describeEdit({ kind: "together", edits: [move, move] }, 10)).toContain("2 edits at once");
  const one = { kind: "check", level: "activity", frames: [0], checked: true } as const;
  expect(describeEdit({ ...one, frames: [0] }, 10)).toBe("1 activity checked");
});

it("knows one from many", () => {
  expect([0, 1, 2].map((n) => formatCount(n, "member"))).toEqual([
    "0 members",
    "1 member",
    "2 members",
  ]);
});
