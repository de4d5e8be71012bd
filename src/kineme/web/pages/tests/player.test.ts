import { expect, test } from "vitest";
import { fitPicture } from "../src/panels/Video";
import { advance } from "../src/page";

const loop = { start_s: 2, stop_s: 4 };

test("time goes on, and round inside a loop", () => {
  expect(advance(1, 0.5, null)).toBe(1.5);
  expect(advance(3.5, 1, loop)).toBeCloseTo(2.5);
  expect(advance(0, 0.1, loop)).toBe(2);
  expect(advance(9, 0.1, loop)).toBeLessThan(4);
});

test("a picture is shown whole, in the middle of its box", () => {
  const picture = { width: 640, height: 480 };
  expect(fitPicture(picture, 1280, 480)).toEqual({ left: 320, top: 0, scale: 1 });
  expect(fitPicture(picture, 320, 480)).toEqual({ left: 0, top: 120, scale: 0.5 });
});
