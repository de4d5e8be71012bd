/** Project motions to 2-D, seen from the side where they move most. Pure functions. */
import { computePose, findRoot, type Motion } from "../../motion";

/** Projected poses, relative to the root at each sample. */
export interface Flat {
  bones: readonly (readonly [number, number])[];
  fps: number;
  /** Right and up of each joint, metres; NaN if missing. */
  poses: Float32Array[];
  low: [number, number];
  high: [number, number];
}

export function flattenMotion(motion: Motion): Flat {
  const { n_samples, sample_fps, bones } = motion.head;
  const joints = motion.head.joints.length;
  const root = motion.head.effectors["pelvis"] ?? findRoot(motion.head);
  const bodies = Array.from({ length: n_samples }, (_, sample) => {
    const pose = new Float32Array(3 * joints);
    computePose(motion, sample / sample_fps, pose);
    const [x, z] = [pose[3 * root]!, pose[3 * root + 2]!];
    for (let joint = 0; joint < joints; joint++) {
      pose[3 * joint]! -= x;
      pose[3 * joint + 2]! -= z;
    }
    return pose;
  });
  const angle = findWidestDirection(bodies);
  const [right, deep] = [Math.cos(angle), Math.sin(angle)];
  const low: [number, number] = [Infinity, Infinity];
  const high: [number, number] = [-Infinity, -Infinity];
  const poses = bodies.map((body) => {
    const flat = new Float32Array(2 * joints);
    for (let joint = 0; joint < joints; joint++) {
      flat[2 * joint] = right * body[3 * joint]! + deep * body[3 * joint + 2]!;
      flat[2 * joint + 1] = body[3 * joint + 1]!;
    }
    for (const joint of bones.flat())
      for (const axis of [0, 1] as const) {
        const at = flat[2 * joint + axis]!;
        if (at < low[axis]) low[axis] = at;
        if (at > high[axis]) high[axis] = at;
      }
    return flat;
  });
  return { bones, fps: sample_fps, poses, low, high };
}

/** Return the horizontal direction in which the joints move most, radians from x towards z. */
export function findWidestDirection(bodies: readonly Float32Array[]): number {
  let [xx, zz, xz] = [0, 0, 0];
  const n = bodies[0]?.length ?? 0;
  for (let at = 0; at < n; at += 3) {
    const visible = bodies.filter((body) => !Number.isNaN(body[at]! + body[at + 2]!));
    const mean = (axis: number): number =>
      visible.reduce((sum, body) => sum + body[at + axis]!, 0) / (visible.length || 1);
    const [x, z] = [mean(0), mean(2)];
    for (const body of visible) {
      const [dx, dz] = [body[at]! - x, body[at + 2]! - z];
      xx += dx * dx;
      zz += dz * dz;
      xz += dx * dz;
    }
  }
  return 0.5 * Math.atan2(2 * xz, xx - zz);
}
