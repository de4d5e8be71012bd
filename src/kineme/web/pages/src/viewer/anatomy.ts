/** Compute the size of a body and the thickness of its bones. Pure functions. */
import { memoize } from "../util";
import { computePose, type Motion } from "../motion";
import type { MotionHead } from "../messages";

/** Radii in metres; a bone tapers from `bones[i]` to `TAPER` times that. */
export interface Anatomy {
  /** Height of the body, or the extent of the recorded part, metres. */
  size: number;
  /** Height of the ground, metres. */
  ground: number;
  bones: Float32Array;
  joints: Float32Array;
  /** Index of the bone drawn as a head; -1 if unknown. */
  skull: number;
}

export const TAPER = 0.62;

function measureAnatomy(motion: Motion): Anatomy {
  const { head } = motion;
  const pose = new Float32Array(head.joints.length * 3);
  const lowest: number[] = [];
  const extents: number[] = [];
  const lengths = head.bones.map(() => [] as number[]);
  const seconds = head.n_samples / head.sample_fps;
  for (let i = 0; i < 100; i++) {
    computePose(motion, (seconds * i) / 100, pose);
    const box = computeBox(pose);
    if (!box) continue;
    lowest.push(box.low[1]);
    extents.push(Math.max(...box.high.map((high, axis) => high - box.low[axis]!)));
    head.bones.forEach(([a, b], bone) => {
      const length = computeDistance(pose, a, b);
      if (Number.isFinite(length)) lengths[bone]!.push(length);
    });
  }
  const size = computeQuantile(extents, 0.5) || 1;
  const bones = computeBoneRadii(
    head,
    size,
    lengths.map((all) => computeQuantile(all, 0.5)),
  );
  const joints = computeJointRadii(head, size, bones);
  const skull = head.bones.findIndex(([, tip]) => tip === head.effectors["head"]);
  return { size, ground: computeQuantile(lowest, 0.05) - 0.008 * size, bones, joints, skull };
}

/** Return bone radii in metres: long bones are thick, fingers thin, the spine thickest. */
function computeBoneRadii(head: MotionHead, size: number, lengths: number[]): Float32Array {
  const spine = tracePathToRoot(head, head.effectors["head"] ?? -1);
  return Float32Array.from(lengths, (length, bone) => {
    const [from, to] = head.bones[bone]!;
    const share = 0.03 * Math.sqrt(length / (0.23 * size));
    const thick = spine.has(from) && spine.has(to) ? 1.5 : 1;
    return size * Math.min(Math.max(share * thick, 0.005), 0.036);
  });
}

/** Return joint radii in metres; a joint covers the ends of its bones. */
function computeJointRadii(head: MotionHead, size: number, bones: Float32Array): Float32Array {
  const radii = new Float32Array(head.joints.length);
  head.bones.forEach(([from, to], bone) => {
    radii[from] = Math.max(radii[from]!, 1.12 * bones[bone]!);
    radii[to] = Math.max(radii[to]!, 1.2 * TAPER * bones[bone]!);
  });
  const crown = head.effectors["head"] ?? -1;
  return radii.map((radius, joint) => {
    const inside = joint === crown && radius > 0; // hidden inside the head
    return inside ? 0 : radius || 0.011 * size;
  });
}

function tracePathToRoot(head: MotionHead, joint: number): Set<number> {
  const path = new Set<number>();
  for (let at = joint; at >= 0 && !path.has(at); at = head.parents[at] ?? -1) path.add(at);
  return path;
}

/** Return the bounding box of the joints that are not missing; null if all are. */
function computeBox(
  pose: Float32Array,
): { low: [number, number, number]; high: [number, number, number] } | null {
  const low: [number, number, number] = [Infinity, Infinity, Infinity];
  const high: [number, number, number] = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < pose.length; i++) {
    const value = pose[i]!;
    if (Number.isNaN(value)) continue;
    const axis = (i % 3) as 0 | 1 | 2;
    if (value < low[axis]) low[axis] = value;
    if (value > high[axis]) high[axis] = value;
  }
  return low[0] <= high[0] ? { low, high } : null;
}

function computeDistance(pose: Float32Array, a: number, b: number): number {
  const at = (joint: number, axis: number): number => pose[3 * joint + axis]!;
  return Math.hypot(at(a, 0) - at(b, 0), at(a, 1) - at(b, 1), at(a, 2) - at(b, 2));
}

/** Return a quantile; 0 of no values. */
function computeQuantile(values: readonly number[], share: number): number {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted[Math.min(Math.floor(share * sorted.length), sorted.length - 1)] ?? 0;
}

/** Return the cached anatomy of a motion. */
export const getAnatomy = memoize(measureAnatomy);
