import { expect, test } from "vitest";
import { summarizeRanges } from "../src/panels/Curves";
import type { CycleCurve } from "../src/messages";

function createCycle(values: (number | null)[]): CycleCurve {
  return { start_frame: 0, start_s: 0, stop_s: 1, counts: true, note: "", distance: null, values };
}

test("ranges are summarized by mean and deviation, without what was not recorded", () => {
  const both = [createCycle([10, null, 100, 40]), createCycle([5, 99])];
  expect(summarizeRanges(both)).toBe("92 ± 2.83");
  expect(summarizeRanges([...both.slice(0, 1), createCycle([null])])).toBe("90");
  expect(summarizeRanges([])).toBe("");
});
