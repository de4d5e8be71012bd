import { expect, test } from "vitest";
import { component, curveOf, liveliest, pointsFor, someOf, spreadOf } from "../src/clusters/curves";
import { motion, segment } from "./recordings";

test("directions of the body: it looks forward, and left is to its left", () => {
  expect(component("forward", 0, 0, 1, 0)).toBeCloseTo(1);
  expect(component("left", 1, 0, 0, 0)).toBeCloseTo(1);
  expect(component("forward", 1, 0, 0, Math.PI / 2)).toBeCloseTo(1);
  expect(component("left", 0, 0, -1, Math.PI / 2)).toBeCloseTo(1);
  expect(component("up", 5, 2, 7, 1)).toBe(2);
});

test("curves go from the first to the last moment, seen from the pelvis", () => {
  const reach = motion(21, (i, joint) => [500 * i, 0, joint * 100 * i]);
  const curve = curveOf(reach, segment(0, 20), { joint: 1, axis: "forward" }, 61);
  expect(curve).toHaveLength(61);
  expect(curve[0]).toBeCloseTo(0);
  expect(curve.at(-1)).toBeCloseTo(2);
  expect(curve[30]).toBeCloseTo(1);
});

test("one movement at two speeds gives one curve", () => {
  const slowing = motion(32, (i, joint) => [0, joint * (i <= 10 ? 100 * i : 50 * (i - 11)), 0]);
  const [fast, slow] = [segment(0, 10), segment(11, 31)].map((member) =>
    curveOf(slowing, member, { joint: 1, axis: "up" }, 61),
  );
  slow!.forEach((value, i) => expect(value).toBeCloseTo(fast![i]!, 4));
});

test("mean and deviation leave out what was not seen", () => {
  const flat = (value: number): Float32Array => new Float32Array(61).fill(value);
  const { mean, deviation } = spreadOf([flat(1), flat(3), flat(NaN)]);
  expect(mean[7]).toBeCloseTo(2);
  expect(deviation[7]).toBeCloseTo(1);
});

test("the joint and the axis that move most are shown first", () => {
  const wave = motion(21, (i, joint) => [0, 1000 + joint * 300 * Math.sin(i), 40 * Math.sin(i)]);
  expect(liveliest(wave, [segment(0, 20)])).toEqual({ joint: 1, axis: "up" });
});

test("some of many, from first to last", () => {
  expect(someOf([1, 2, 3], 5)).toEqual([1, 2, 3]);
  const some = someOf([...Array(1000).keys()], 10);
  expect(some).toHaveLength(10);
  expect(some[9]).toBeGreaterThan(800);
});

test("a curve has a point for each sample of the longest member", () => {
  const still = motion(500, () => [0, 0, 0]);
  expect(pointsFor(still, [segment(0, 10), segment(20, 220)])).toBe(201);
  expect(pointsFor(still, [segment(0, 0)])).toBe(2);
});
