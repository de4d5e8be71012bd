import { deflateSync } from "node:zlib";
import { expect, test } from "vitest";
import { MARGIN_LEFT, MARGIN_RIGHT, findNearestCurve } from "../src/panels/curveDrawing";
import type { ClusterCurves, CycleCurve, ReportCurves } from "../src/messages";
import { summarizeRanges } from "../src/panels/Curves";
import { EmbeddedData } from "../src/recordingData";

function cycle(start_frame: number, values: (number | null)[]): CycleCurve {
  const [start_s, stop_s] = [start_frame / 10, start_frame / 10 + 1];
  return { start_frame, start_s, stop_s, counts: true, note: "", distance: 0, values };
}

function createCurves(channel: string, cycles: CycleCurve[] = []): ClusterCurves {
  const counts = { n: 1, total: 1, ends: false, left_out: 0, turned: 0 };
  return { channel, unit: "°", ...counts, mean: [1, 2, 3], sd: [0, 0, 0], cycles, beside: null };
}

/** Create the data of a report with these curves. */
function report(cycles: ReportCurves): EmbeddedData {
  const text = deflateSync(JSON.stringify(cycles)).toString("base64");
  const page = {
    getElementById: (id: string) => (id === "kineme-cycles" ? { textContent: text } : null),
  };
  return new EmbeddedData(page as unknown as Document);
}

test("a report has the curves of each table that it shows, the liveliest channel first", async () => {
  const head = { name: "knee_l", unit: "°", group: "angle", opposite: "knee_r" };
  const data = report({
    channels: [head],
    curves: [
      { knee_l: createCurves("knee_l"), knee_r: createCurves("knee_r") },
      { knee_r: createCurves("knee_r") },
    ],
    tables: [{ "0": 0 }, { "0": 0 }, { "0": 1, "3": 0 }],
  });
  expect(await data.loadCycleChannels()).toEqual([head]);
  const asked = async (...of: [number, string, number]) =>
    (await data.loadClusterCurves(...of))?.channel;
  expect(await asked(0, "", 0)).toBe("knee_l");
  expect(await asked(0, "knee_r", 1)).toBe("knee_r");
  expect(await asked(0, "", 2)).toBe("knee_r");
  expect(await asked(3, "", 2)).toBe("knee_l");
  expect(await asked(0, "knee_l", 2)).toBeUndefined();
  expect(await asked(7, "", 0)).toBeUndefined();
  expect(await asked(0, "", 9)).toBeUndefined();
});

test("a click goes to the nearest curve, and to none that was not recorded there", () => {
  const curves = createCurves("knee_l", [cycle(0, [0, 0, 0]), cycle(10, [null, null, 10])]);
  const [width, height] = [MARGIN_LEFT + MARGIN_RIGHT + 100, 100];
  expect(findNearestCurve(curves, null, MARGIN_LEFT + 100, 10, width, height)).toBe(1);
  expect(findNearestCurve(curves, null, MARGIN_LEFT, 10, width, height)).toBe(0);
});

test("ranges are summarized by mean and deviation, without what was not recorded", () => {
  const both = [cycle(0, [10, null, 100, 40]), cycle(0, [5, 99])];
  expect(summarizeRanges(both)).toBe("92 ± 2.83");
  expect(summarizeRanges([...both.slice(0, 1), cycle(0, [null])])).toBe("90");
  expect(summarizeRanges([])).toBe("");
});
