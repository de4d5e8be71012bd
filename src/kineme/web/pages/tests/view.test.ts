import { expect, test } from "vitest";
import {
  formatTime,
  revealTime,
  panRange,
  computeTicks,
  toPixel,
  toSeconds,
  zoomRange,
} from "../src/view";

const range = { start_s: 10, stop_s: 20 };

test("time to pixels and back", () => {
  expect(toPixel(range, 500, 12)).toBe(100);
  expect(toSeconds(range, 500, toPixel(range, 500, 17.3))).toBeCloseTo(17.3);
});

test("zooming keeps the time under the pointer where it is", () => {
  const closer = zoomRange(range, 0.5, 12, 60);
  expect(closer.stop_s - closer.start_s).toBeCloseTo(5);
  expect(toPixel(closer, 500, 12)).toBeCloseTo(toPixel(range, 500, 12));
});

test("no view leaves the recording", () => {
  expect(zoomRange(range, 100, 12, 60)).toEqual({ start_s: 0, stop_s: 60 });
  expect(panRange(range, -50, 60)).toEqual({ start_s: 0, stop_s: 10 });
  expect(panRange(range, 500, 60)).toEqual({ start_s: 50, stop_s: 60 });
});

test("there is an end to zooming in", () => {
  let close = range;
  for (let i = 0; i < 100; i++) close = zoomRange(close, 0.5, 15, 60);
  expect(close.stop_s - close.start_s).toBeCloseTo(0.2);
});

test("the view turns the page when the playhead leaves it", () => {
  expect(revealTime(range, 15, 60)).toBe(range);
  const next = revealTime(range, 21, 60);
  expect(next.start_s).toBeLessThan(21);
  expect(next.stop_s - next.start_s).toBeCloseTo(10);
});

test("ticks are round and far enough apart, for seconds and for hours", () => {
  expect(
    computeTicks({ start_s: 0, stop_s: 10 }, 700)
      .map((tick) => tick.label)
      .slice(0, 3),
  ).toEqual(["0:00", "0:01", "0:02"]);
  for (const length of [0.3, 7, 100, 3600, 40000]) {
    const ticks = computeTicks({ start_s: 3, stop_s: 3 + length }, 800);
    expect(ticks.length).toBeGreaterThan(1);
    expect(ticks.length).toBeLessThanOrEqual(14);
  }
});

test("clocks", () => {
  expect(formatTime(75.5, 1)).toBe("1:15.5");
  expect(formatTime(3599.996, 2)).toBe("1:00:00.00");
  expect(formatTime(3725)).toBe("1:02:05");
});
