import { expect, test } from "vitest";
import { CurveTiles } from "../src/channels/tiles";
import {
  AXES,
  component,
  coursesOfChannels,
  coursesOfMotion,
  type Course,
} from "../src/clusters/courses";
import {
  curveOf,
  distanceFrom,
  farthest,
  liveliest,
  pointsFor,
  someOf,
  spreadOf,
} from "../src/clusters/curves";
import type { Motion } from "../src/motion";
import type { RecordingData } from "../src/recordingData";
import { motion, segment } from "./recordings";

function hand(of: Motion, axis: string): Course {
  return coursesOfMotion(of).find(({ group, name }) => group === axis && name === "hand")!;
}

test("directions of the body: it looks forward, and left is to its left", () => {
  expect(component("forward", 0, 0, 1, 0)).toBeCloseTo(1);
  expect(component("left", 1, 0, 0, 0)).toBeCloseTo(1);
  expect(component("forward", 1, 0, 0, Math.PI / 2)).toBeCloseTo(1);
  expect(component("left", 0, 0, -1, Math.PI / 2)).toBeCloseTo(1);
  expect(component("up", 5, 2, 7, 1)).toBe(2);
});

test("curves go from the first to the last moment, seen from the pelvis", () => {
  const reach = motion(21, (i, joint) => [500 * i, 0, joint * 100 * i]);
  const curve = curveOf(hand(reach, "forward"), segment(0, 20), 61);
  expect(curve).toHaveLength(61);
  expect(curve[0]).toBeCloseTo(0);
  expect(curve.at(-1)).toBeCloseTo(2);
  expect(curve[30]).toBeCloseTo(1);
});

test("one movement at two speeds gives one curve", () => {
  const slowing = motion(32, (i, joint) => [0, joint * (i <= 10 ? 100 * i : 50 * (i - 11)), 0]);
  const [fast, slow] = [segment(0, 10), segment(11, 31)].map((member) =>
    curveOf(hand(slowing, "up"), member, 61),
  );
  slow!.forEach((value, i) => expect(value).toBeCloseTo(fast![i]!, 4));
});

test("mean and deviation leave out what was not seen", () => {
  const flat = (value: number): Float32Array => new Float32Array(61).fill(value);
  const { mean, deviation } = spreadOf([flat(1), flat(3), flat(NaN)]);
  expect(mean[7]).toBeCloseTo(2);
  expect(deviation[7]).toBeCloseTo(1);
});

test("the mean is told from those that are farthest from it", () => {
  const flat = (value: number): Float32Array => new Float32Array(61).fill(value);
  const curves = [flat(1), flat(1), flat(7), flat(NaN), flat(2)];
  const spread = spreadOf(curves.slice(0, 2));
  expect(farthest(spread, curves, 2)).toEqual([2, 4]);
  expect(distanceFrom(spread, flat(4))).toBeCloseTo(3);
});

test("where two bones meet there is an angle, of degrees", () => {
  const joints = ["hip", "knee", "foot"];
  const steps = Int16Array.from([0, 0, 0, 0, -500, 0, 500, -500, 0]);
  const head = { ...motion(1, () => [0, 0, 0]).head, joints, parents: [-1, 0, 1] };
  const bends = coursesOfMotion({ head, steps }).filter(({ unit }) => unit === "°");
  expect(bends.map(({ name }) => name)).toEqual(["knee"]);
  expect(bends[0]!.at(0)).toBeCloseTo(90);
});

test("channels are followed through their tiles, as soon as they are here", async () => {
  const curves = [{ name: "force", group: "channels", unit: "N" }];
  const pairs = Float32Array.from([0, 0, 10, 10, 30, 30]);
  const data = { curveTile: () => Promise.resolve(pairs.buffer) } as unknown as RecordingData;
  const tiles = new CurveTiles(data, { curves, factor: 4, tile: 1024, levels: 1 });
  const [force] = coursesOfChannels(tiles, 10);
  expect(force!.at(0.15)).toBeNaN();
  await new Promise((resolve) => setTimeout(resolve));
  expect(tiles.settled.value).toBe(1);
  expect(force!.at(0.15)).toBeCloseTo(20);
  expect(force!.at(9)).toBeNaN();
});

test("the joint and the axis that move most are shown first", () => {
  const wave = motion(21, (i, joint) => [0, 1000 + joint * 300 * Math.sin(i), 40 * Math.sin(i)]);
  const courses = coursesOfMotion(wave).filter(({ group }) => AXES.some((axis) => axis === group));
  const found = liveliest(courses, [segment(0, 20)]);
  expect([found!.name, found!.group]).toEqual(["hand", "up"]);
});

test("some of many, from first to last", () => {
  expect(someOf([1, 2, 3], 5)).toEqual([1, 2, 3]);
  const some = someOf([...Array(1000).keys()], 10);
  expect(some).toHaveLength(10);
  expect(some[9]).toBeGreaterThan(800);
});

test("a curve has a point for each sample of the longest member", () => {
  expect(pointsFor(10, [segment(0, 10), segment(20, 220)])).toBe(201);
  expect(pointsFor(10, [segment(0, 0)])).toBe(2);
});
