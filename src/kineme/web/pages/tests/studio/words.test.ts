import { expect, it } from "vitest";
import { counted } from "../../src/counted";
import { inWords } from "../../src/studio/editing/words";

it("says edits in words, with seconds", () => {
  const move = { kind: "move_border", level: "primitive", frame: 30, to: 40 } as const;
  expect(inWords(move, 10)).toBe("primitive border from 3.00 s to 4.00 s");
  expect(inWords({ kind: "together", edits: [move, move] }, 10)).toContain("2 edits at once");
  const one = { kind: "check", level: "activity", frames: [0], checked: true } as const;
  expect(inWords({ ...one, frames: [0] }, 10)).toBe("1 activity checked");
});

it("knows one from many", () => {
  expect([0, 1, 2].map((n) => counted(n, "member"))).toEqual([
    "0 members",
    "1 member",
    "2 members",
  ]);
});
