import { expect, test } from "vitest";
import {
  placeInStep,
  isFree,
  getFigureTime,
  MAX_MEMBERS,
  movePose,
  placeSideBySide,
} from "../src/viewer/placement";
import { motion, segment } from "./recordings";

const walk = motion(41, (i, joint) => [100 * i, 1000, joint * 200], {
  heading: Array(41).fill(Math.PI / 2),
});

test("one figure moves freely, several keep their places", () => {
  expect(placeSideBySide([{ motion: walk, name: "a" }], 2)[0]!.placement.isFixed).toBe(false);
  const two = placeSideBySide(
    [walk, walk].map((each) => ({ motion: each, name: "" })),
    2,
  );
  const [left, right] = two.map((figure) => figure.placement.slot[0]);
  expect(right! - left!).toBeGreaterThan(1);
  expect(two.every((figure) => figure.placement.isFixed)).toBe(true);
});

test("people of one file stand where they stood, beside another file around a slot", () => {
  const [left, right] = [0, 3000].map((x) => motion(41, (i) => [x + 10 * i, 1000, 0]));
  const duet = [left!, right!].map((each) => ({ motion: each, name: "", file: "duet" }));
  expect(placeSideBySide(duet, 2).every(isFree)).toBe(true);
  const placed = placeSideBySide([...duet, { motion: walk, name: "", file: "walk" }], 2);
  expect(placed.some(isFree)).toBe(false);
  expect(placed[0]!.placement).toEqual(placed[1]!.placement);
  const [x] = placed.map(({ placement }) => placement.slot[0]);
  expect(placed[2]!.placement.slot[0] - x!).toBeGreaterThan(1.5 + 1); // half of the two, half of the third
  expect(placed.map(({ placement }) => placement.isFixed)).toEqual([false, false, true]);
});

test("members begin on their places and look the same way", () => {
  const [figure] = placeInStep(walk, [segment(10, 20), segment(20, 30)], 2);
  const pose = Float32Array.from([1, 1, 0, 2, 1, 0]); // it looks along x, as the walk does
  movePose(pose, figure!.placement, 0);
  const [x, z] = figure!.placement.slot;
  expect([pose[0], pose[2]]).toEqual([expect.closeTo(x), expect.closeTo(z)]);
  expect([pose[3], pose[5]]).toEqual([expect.closeTo(x), expect.closeTo(z + 1)]);
});

test("a crowd is cut short", () => {
  const members = Array.from({ length: 100 }, (_, i) => segment(i, i + 1));
  expect(placeInStep(walk, members, 2)).toHaveLength(MAX_MEMBERS);
});

test("all have done the same share of their repetition", () => {
  const members = [segment(10, 20), segment(20, 40)];
  const figures = placeInStep(walk, members, 2);
  const times = figures.map((figure) => getFigureTime(figure, 1.5, members[0]));
  expect(times).toEqual([expect.closeTo(1.5), expect.closeTo(3)]);
});
