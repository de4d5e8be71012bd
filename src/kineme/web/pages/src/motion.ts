/** Unpack binary motion and compute poses. */
import type { MotionHead } from "./messages";

const MISSING = -32768;

/** Poses of a recording: `steps` holds x, y, z of each joint, sample by sample. */
export interface Motion {
  head: MotionHead;
  steps: Int16Array;
}

/** Return the motion of a deflated message; see `kineme.web.display`. */
export async function unpackMotion(head: MotionHead, packed: ArrayBuffer): Promise<Motion> {
  return decodeMotion(head, await inflate(packed).arrayBuffer());
}

/** Return inflated data as a response to read from. */
export function inflate(packed: ArrayBuffer): Response {
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream);
}

/** Sum the differences of each column (joint, then axis) into values, sample by sample. */
export function decodeMotion(head: MotionHead, bytes: ArrayBuffer): Motion {
  const { n_samples } = head;
  const n_columns = head.joints.length * 3;
  if (bytes.byteLength !== 2 * n_samples * n_columns)
    throw new Error(`The motion has ${bytes.byteLength} bytes, not ${2 * n_samples * n_columns}.`);
  const view = new DataView(bytes);
  const steps = new Int16Array(n_samples * n_columns);
  for (let column = 0; column < n_columns; column++) {
    let value = 0;
    for (let sample = 0; sample < n_samples; sample++) {
      value += view.getInt16(2 * (column * n_samples + sample), true);
      steps[sample * n_columns + column] = value; // 16-bit overflow is intended
    }
  }
  return { head, steps };
}

/**
 * Write the pose at a time (seconds) to `out`: x, y, z per joint in metres, interpolated between
 * two samples. A joint missing in either becomes NaN.
 */
export function computePose(motion: Motion, seconds: number, out: Float32Array): void {
  const { origin, step, n_samples, sample_fps } = motion.head;
  const at = Math.min(Math.max(seconds * sample_fps, 0), n_samples - 1);
  const first = Math.floor(at);
  const share = at - first;
  const n = motion.head.joints.length * 3;
  const a = first * n;
  const b = Math.min(first + 1, n_samples - 1) * n;
  for (let i = 0; i < n; i++) {
    const from = motion.steps[a + i]!;
    const to = motion.steps[b + i]!;
    out[i] =
      from === MISSING || to === MISSING
        ? NaN
        : origin[i % 3]! + step * (from + share * (to - from));
  }
}

/** Return an empty pose for `computePose`. */
export function createPose({ head }: Motion): Float32Array<ArrayBuffer> {
  return new Float32Array(3 * head.joints.length);
}

/** Return the root's position (x, z) at a time; 0 if it is missing. */
export function getRootPosition(motion: Motion, seconds: number): [number, number] {
  const pose = createPose(motion);
  computePose(motion, seconds, pose);
  const root = 3 * findRoot(motion.head);
  return [pose[root] || 0, pose[root + 2] || 0];
}

/** Return the body's heading at a time, radians about y from +z towards +x; 0 if unknown. */
export function getHeading(motion: Motion, seconds: number): number {
  const { heading, sample_fps } = motion.head;
  if (!heading || heading.length === 0) return 0;
  const at = Math.min(Math.max(Math.round(seconds * sample_fps), 0), heading.length - 1);
  return heading[at]!;
}

/** Return the index of the joint without a parent. */
export function findRoot(head: MotionHead): number {
  return Math.max(head.parents.indexOf(-1), 0);
}
