/** What the members of a cluster have in common: their curves over normalised time. Pure. */
import type { Segment } from "../messages";
import type { Course } from "./courses";

/** Fewest and most points of a curve, from the first to the last frame of a member. */
const FEWEST = 2;
const MOST_POINTS = 600; // more than the curves have pixels

/** How many points the curves of these members need: one for each sample of the longest. */
export function pointsFor(fps: number, members: readonly Segment[]): number {
  const seconds = Math.max(...members.map((each) => each.stop_s - each.start_s), 0);
  return Math.min(Math.max(Math.ceil(seconds * fps) + 1, FEWEST), MOST_POINTS);
}

/**
 * The course of a member at `points` times from its start to its end. With a `phase` the curve
 * begins that share of the cycle later and goes on from its end to its start; it is broken (NaN)
 * there.
 */
export function curveOf(course: Course, segment: Segment, points: number, phase = 0): Float32Array {
  const curve = new Float32Array(points);
  const length = segment.stop_s - segment.start_s;
  for (let i = 0; i < points; i++) {
    const share = i / (points - 1) + phase;
    if (phase > 0 && share > 1 && share - 1 / (points - 1) <= 1) {
      curve[i] = NaN;
      continue;
    }
    curve[i] = course.at(segment.start_s + length * (share > 1 ? share - 1 : share));
  }
  return curve;
}

export interface Spread {
  mean: Float32Array;
  deviation: Float32Array;
}

/** Mean and standard deviation of each sample; what is missing (NaN) does not count. */
export function spreadOf(curves: readonly Float32Array[]): Spread {
  const points = curves[0]?.length ?? 0;
  const mean = new Float32Array(points);
  const deviation = new Float32Array(points);
  for (let i = 0; i < points; i++) {
    const values = curves.map((curve) => curve[i]!).filter((value) => !Number.isNaN(value));
    const middle = values.reduce((sum, value) => sum + value, 0) / values.length;
    const squares = values.reduce((sum, value) => sum + (value - middle) ** 2, 0);
    mean[i] = middle;
    deviation[i] = Math.sqrt(squares / values.length);
  }
  return { mean, deviation };
}

/** How far a curve is from the mean: the root of the mean square; NaN where nothing was seen. */
export function distanceFrom({ mean }: Spread, curve: Float32Array): number {
  let [sum, n] = [0, 0];
  curve.forEach((value, i) => {
    if (Number.isNaN(value)) return;
    sum += (value - mean[i]!) ** 2;
    n += 1;
  });
  return Math.sqrt(sum / n);
}

/** Numbers of the curves that are farthest from the mean, the farthest first. */
export function farthest(spread: Spread, curves: readonly Float32Array[], n: number): number[] {
  const far = curves.map((curve) => distanceFrom(spread, curve));
  const numbers = [...far.keys()].filter((i) => !Number.isNaN(far[i]!));
  return numbers.sort((a, b) => far[b]! - far[a]!).slice(0, n);
}

const COARSE = 61; // points that tell which course moves most

/** The course that goes farthest in the mean of these members, in proportion to its `size`. */
export function liveliest(
  courses: readonly Course[],
  members: readonly Segment[],
  phases: readonly number[] = [],
  size: (course: Course) => number = () => 1,
): Course | null {
  let best: Course | null = courses[0] ?? null;
  let most = -1;
  for (const course of courses) {
    const { mean } = spreadOf(members.map((each, i) => curveOf(course, each, COARSE, phases[i])));
    const finite = mean.filter((value) => !Number.isNaN(value));
    const extent = (Math.max(...finite) - Math.min(...finite)) / size(course);
    if (extent > most) [best, most] = [course, extent];
  }
  return best;
}

/** At most `n` of the members, evenly chosen. */
export function someOf<T>(all: readonly T[], n: number): T[] {
  if (all.length <= n) return [...all];
  return Array.from({ length: n }, (_, i) => all[Math.floor((i * all.length) / n)]!);
}
