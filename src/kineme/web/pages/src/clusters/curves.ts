/** What the members of a cluster have in common: their curves over normalised time. Pure. */
import type { Segment } from "../messages";
import { headingAt, poseAt, rootOf, type Motion } from "../motion";

export const AXES = ["forward", "up", "left"] as const;
export type Axis = (typeof AXES)[number];

/** Fewest and most points of a curve, from the first to the last frame of a member. */
const FEWEST = 2;
const MOST_POINTS = 600; // more than the curves have pixels

/** A point of the body followed along one axis of the body's own frame. */
export interface Track {
  joint: number;
  axis: Axis;
}

/** How many points the curves of these members need: one for each sample of the longest. */
export function pointsFor(motion: Motion, members: readonly Segment[]): number {
  const seconds = Math.max(...members.map((each) => each.stop_s - each.start_s), 0);
  const samples = Math.ceil(seconds * motion.head.sample_fps) + 1;
  return Math.min(Math.max(samples, FEWEST), MOST_POINTS);
}

/**
 * The track of a member: metres from the root, at `points` times from its start to its end. With
 * a `phase` the curve begins that share of the cycle later and goes on from its end to its start;
 * it is broken (NaN) there.
 */
export function curveOf(
  motion: Motion,
  segment: Segment,
  { joint, axis }: Track,
  points: number,
  phase = 0,
): Float32Array {
  const curve = new Float32Array(points);
  const pose = new Float32Array(motion.head.joints.length * 3);
  const root = 3 * rootOf(motion.head);
  const length = segment.stop_s - segment.start_s;
  for (let i = 0; i < points; i++) {
    const share = i / (points - 1) + phase;
    if (phase > 0 && share > 1 && share - 1 / (points - 1) <= 1) {
      curve[i] = NaN;
      continue;
    }
    const seconds = segment.start_s + length * (share > 1 ? share - 1 : share);
    poseAt(motion, seconds, pose);
    const x = pose[3 * joint]! - pose[root]!;
    const y = pose[3 * joint + 1]! - pose[root + 1]!;
    const z = pose[3 * joint + 2]! - pose[root + 2]!;
    curve[i] = component(axis, x, y, z, headingAt(motion, seconds));
  }
  return curve;
}

/** A direction of the world seen from a body that looks to `heading`. */
export function component(axis: Axis, x: number, y: number, z: number, heading: number): number {
  if (axis === "up") return y;
  const [sin, cos] = [Math.sin(heading), Math.cos(heading)];
  return axis === "forward" ? x * sin + z * cos : x * cos - z * sin;
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

const COARSE = 61; // points that tell which track moves most

/** The track on which hands, feet and head move most in these members. */
export function liveliest(
  motion: Motion,
  members: readonly Segment[],
  phases: readonly number[] = [],
): Track {
  const { effectors } = motion.head;
  const parts = Object.keys(effectors).filter((part) => part !== "pelvis");
  const joints = parts.length ? parts.map((part) => effectors[part]!) : motion.head.joints.keys();
  let best: Track = { joint: 0, axis: "up" };
  let most = -1;
  for (const joint of joints) {
    for (const axis of AXES) {
      const track = { joint, axis };
      const { mean } = spreadOf(
        members.map((member, i) => curveOf(motion, member, track, COARSE, phases[i])),
      );
      const finite = mean.filter((value) => !Number.isNaN(value));
      const extent = Math.max(...finite) - Math.min(...finite);
      if (extent > most) [best, most] = [{ joint, axis }, extent];
    }
  }
  return best;
}

/** At most `n` of the members, evenly chosen. */
export function someOf<T>(all: readonly T[], n: number): T[] {
  if (all.length <= n) return [...all];
  return Array.from({ length: n }, (_, i) => all[Math.floor((i * all.length) / n)]!);
}
