/** Numbers that are followed through the members of a cluster: joints, angles, channels. */
import type { CurveTiles } from "../channels/tiles";
import { headingAt, poseAt, rootOf, type Motion } from "../motion";

export const AXES = ["forward", "up", "left"] as const;
export type Axis = (typeof AXES)[number];
export const BEND = "flexion";

/** A number over time: `at` gives it at a second; NaN where nothing was seen, or is not here yet. */
export interface Course {
  group: string;
  name: string;
  unit: string;
  /** Values per second that tell more than their neighbours. */
  fps: number;
  at(seconds: number): number;
}

/** A direction of the world seen from a body that looks to `heading`. */
export function component(axis: Axis, x: number, y: number, z: number, heading: number): number {
  if (axis === "up") return y;
  const [sin, cos] = [Math.sin(heading), Math.cos(heading)];
  return axis === "forward" ? x * sin + z * cos : x * cos - z * sin;
}

/** Of each joint the three axes, metres from the root, and degrees where two bones meet. */
export function coursesOfMotion(motion: Motion): Course[] {
  const { joints, sample_fps } = motion.head;
  const pose = new Float32Array(joints.length * 3);
  const root = 3 * rootOf(motion.head);
  const placeOf = (joint: number, axis: Axis) => (seconds: number) => {
    poseAt(motion, seconds, pose);
    const [x, y, z] = [0, 1, 2].map((i) => pose[3 * joint + i]! - pose[root + i]!);
    return component(axis, x!, y!, z!, headingAt(motion, seconds));
  };
  const bend = (before: number, joint: number, after: number) => (seconds: number) => {
    poseAt(motion, seconds, pose);
    return angleBetween(bone(pose, before, joint), bone(pose, joint, after));
  };
  const axes = AXES.flatMap((group) =>
    joints.map((name, i) => ({ group, name, unit: "m", fps: sample_fps, at: placeOf(i, group) })),
  );
  const angles = bendsOf(motion).map(([before, joint, after]) => ({
    group: BEND,
    name: joints[joint]!,
    unit: "°",
    fps: sample_fps,
    at: bend(before, joint, after),
  }));
  return [...axes, ...angles];
}

/** Each channel, as far as its tiles are here; what is asked for comes. */
export function coursesOfChannels(tiles: CurveTiles, fps: number): Course[] {
  return tiles.list.curves.flatMap(({ group, name, unit }, curve) =>
    group === "channels" || group === "analog"
      ? [{ group, name, unit, fps, at: (seconds) => tiles.near(curve, seconds * fps) }]
      : [],
  );
}

/** The joint before, the joint, and the joint after, where one bone goes on from another. */
function bendsOf({ head: { joints, parents } }: Motion): [number, number, number][] {
  return joints.flatMap((_, joint) => {
    const after = parents.flatMap((parent, i) => (parent === joint ? [i] : []));
    const before = parents[joint]!;
    return before >= 0 && after.length === 1 ? [[before, joint, after[0]!]] : [];
  });
}

function bone(pose: Float32Array, from: number, to: number): number[] {
  return [0, 1, 2].map((i) => pose[3 * to + i]! - pose[3 * from + i]!);
}

/** Degrees; 0 where both point the same way, NaN where one has no length. */
function angleBetween(a: readonly number[], b: readonly number[]): number {
  const dot = a.reduce((sum, value, i) => sum + value * b[i]!, 0);
  const lengths = Math.hypot(...a) * Math.hypot(...b);
  return (Math.acos(Math.min(Math.max(dot / lengths, -1), 1)) * 180) / Math.PI;
}
