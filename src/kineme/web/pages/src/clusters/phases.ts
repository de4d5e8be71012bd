/**
 * Where in their cycle the members of a cluster begin. Pure functions.
 *
 * What is repeated back to back has no beginning of its own: of two walks one may be cut at each
 * left step, the other at each right step. The mean of both, from the first to the last frame of
 * each cycle, is of nothing that anybody did. All repetitions of an activity are cut alike, so
 * each activity is turned as a whole to the phase of the one that has most members.
 */
import type { Segment } from "../messages";
import type { Course } from "./courses";
import { someOf } from "./curves";

const POINTS = 60; // of a cycle; phases are told as finely
const ROW = POINTS + 1; // with the point at which the next one begins
const FEW = 6; // members that an activity is told by
/** It is another phase where turning leaves less than this share of what differs. */
const LEFT = 0.5;

/** How much of a cycle each member begins later than the others do, by these courses: 0 to 1. */
export function phasesOf(courses: readonly Course[], members: readonly Segment[]): number[] {
  const groups = new Map<number, Segment[]>();
  for (const member of members)
    groups.set(member.activity, [...(groups.get(member.activity) ?? []), member]);
  const most = Math.max(...[...groups.values()].map((each) => each.length));
  const first = [...groups.values()].find((each) => each.length === most);
  if (!first || groups.size === 1) return members.map(() => 0);
  const reference = meanCycle(courses, first);
  const phases = new Map<number, number>();
  for (const [activity, group] of groups)
    phases.set(activity, group === first ? 0 : turned(reference, meanCycle(courses, group)));
  return members.map(({ activity }) => phases.get(activity)!);
}

/** What the courses are on average: course by course its points, less their mean. */
function meanCycle(courses: readonly Course[], group: readonly Segment[]): Float64Array {
  const sums = new Float64Array(courses.length * ROW);
  const counts = new Float64Array(courses.length * ROW);
  for (const { start_s, stop_s } of someOf(group, FEW))
    courses.forEach((course, i) => {
      for (let point = 0; point < ROW; point++) {
        const value = course.at(start_s + ((stop_s - start_s) * point) / POINTS);
        if (Number.isNaN(value)) continue;
        sums[i * ROW + point]! += value;
        counts[i * ROW + point]! += 1;
      }
    });
  const cycle = sums.map((sum, at) => sum / counts[at]!); // NaN where nothing was seen
  for (let row = 0; row < courses.length; row++) center(cycle.subarray(row * ROW, (row + 1) * ROW));
  return cycle;
}

/** Takes the mean off, in place; what is missing is as the mean. */
function center(values: Float64Array): void {
  const finite = values.filter((value) => !Number.isNaN(value));
  const mean = finite.reduce((sum, value) => sum + value, 0) / Math.max(finite.length, 1);
  values.forEach((value, i) => (values[i] = Number.isNaN(value) ? 0 : value - mean));
}

/** By what share of a cycle another one is best turned to be like the reference. */
function turned(reference: Float64Array, other: Float64Array): number {
  if (!isClosed(reference) || !isClosed(other)) return 0;
  const differences = Array.from({ length: POINTS }, (_, by) => difference(reference, other, by));
  const least = Math.min(...differences);
  return least < LEFT * differences[0]! ? differences.indexOf(least) / POINTS : 0;
}

/** Whether it ends where it began: both are nearer to each other than two points are on average. */
function isClosed(cycle: Float64Array): boolean {
  let [gap, squares] = [0, 0];
  for (let row = 0; row < cycle.length; row += ROW)
    gap += (cycle[row + POINTS]! - cycle[row]!) ** 2;
  for (const value of cycle) squares += value ** 2;
  return gap < (2 * squares) / ROW;
}

function difference(reference: Float64Array, other: Float64Array, by: number): number {
  let sum = 0;
  for (let row = 0; row < reference.length; row += ROW)
    for (let point = 0; point < POINTS; point++)
      sum += (reference[row + point]! - other[row + ((point + by) % POINTS)]!) ** 2;
  return sum;
}
