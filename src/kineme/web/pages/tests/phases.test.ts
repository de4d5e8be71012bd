import { expect, test } from "vitest";
import { AXES, coursesOfMotion, type Course } from "../src/clusters/courses";
import { curveOf, liveliest, spreadOf } from "../src/clusters/curves";
import { phasesOf } from "../src/clusters/phases";
import type { Segment } from "../src/messages";
import type { Motion } from "../src/motion";
import { motion, segment } from "./recordings";

const CYCLE = 20; // frames
const swing = (frame: number): number => 300 * Math.sin((2 * Math.PI * frame) / CYCLE);
const walk = placesOf(motion(201, (frame, joint) => [0, 900, joint * Math.round(swing(frame))]));
const forward = walk.find(({ group, name }) => group === "forward" && name === "hand")!;

function placesOf(of: Motion): Course[] {
  return coursesOfMotion(of).filter(({ group }) => AXES.some((axis) => axis === group));
}

/** Repetitions of an activity, each a whole cycle, from a frame on. */
function cycles(from: number, n: number, activity: number): Segment[] {
  return Array.from({ length: n }, (_, i) =>
    segment(from + i * CYCLE, from + (i + 1) * CYCLE, { activity }),
  );
}

test("two walks cut at opposite phases have the mean of a walk", () => {
  const members = [...cycles(0, 4, 0), ...cycles(90, 4, 1)];
  const phases = phasesOf(walk, members);
  expect(phases).toEqual([0, 0, 0, 0, 0.5, 0.5, 0.5, 0.5]);
  const of = (which: readonly number[]): { extent: number; most: number } => {
    const curves = members.map((each, i) => curveOf(forward, each, 41, which[i]));
    const { mean, deviation } = spreadOf(curves);
    return { extent: Math.max(...mean) - Math.min(...mean), most: Math.max(...deviation) };
  };
  expect(of([]).extent).toBeLessThan(0.01); // as it is without
  expect(of(phases).extent).toBeCloseTo(0.6, 2);
  expect(of(phases).most).toBeLessThan(0.02);
  expect(liveliest(walk, members, phases)).toBe(forward);
});

test("the activity that has most members tells the phase", () => {
  const members = [...cycles(5, 1, 0), ...cycles(40, 3, 1)];
  expect(phasesOf(walk, members)).toEqual([0.75, 0, 0, 0]);
});

test("what is cut at one phase stays as it is cut, and so does what is another movement", () => {
  expect(phasesOf(walk, [...cycles(0, 2, 0), ...cycles(80, 2, 1)])).toEqual([0, 0, 0, 0]);
  expect(phasesOf(walk, cycles(0, 3, 0))).toEqual([0, 0, 0]);
  const reach = placesOf(
    motion(101, (frame, joint) => [0, joint * (frame < 50 ? 10 : -7) * frame, 0]),
  );
  expect(phasesOf(reach, [segment(0, 50), segment(50, 100, { activity: 1 })])).toEqual([0, 0]);
  expect(phasesOf(walk, [])).toEqual([]);
});

test("a turned curve is broken where it goes on from its end to its start", () => {
  const curve = curveOf(forward, segment(0, CYCLE), 21, 0.25);
  expect(curve[0]).toBeCloseTo(0.3);
  expect([...curve.keys()].filter((i) => Number.isNaN(curve[i]!))).toEqual([16]);
});
