/** Draw small figures on a canvas: poses or curves. */
import { computePose, findRoot, type Motion } from "../../motion";

/** A drawn span: a body, or channels scaled to 0–1. */
export interface Sketch {
  flat: Flat | null;
  curves: readonly (readonly number[])[];
}

const EDGE = 5;

/** Clear a canvas and scale it to device pixels; null if it has no size. */
export function prepareCanvas(canvas: HTMLCanvasElement): CanvasRenderingContext2D | null {
  const [wide, tall] = [canvas.clientWidth, canvas.clientHeight];
  const pen = canvas.getContext("2d");
  if (!pen || !wide || !tall) return null;
  const [width, height] = [wide, tall].map((side) => Math.round(side * devicePixelRatio));
  if (canvas.width !== width) canvas.width = width!;
  if (canvas.height !== height) canvas.height = height!;
  pen.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
  pen.clearRect(0, 0, wide, tall);
  pen.lineCap = pen.lineJoin = "round";
  return pen;
}

/** Draw poses at shares of the span (0 to 1) beside each other. */
export function drawPoses(
  pen: CanvasRenderingContext2D,
  flat: Flat,
  shares: readonly number[],
  color: string,
): void {
  const [wide, tall] = [pen.canvas.clientWidth, pen.canvas.clientHeight];
  const n = shares.length;
  const size = [flat.high[0] - flat.low[0], flat.high[1] - flat.low[1]] as const;
  const scale = Math.min(
    ((n > 1 ? 1.4 : 1) * wide) / n / (size[0] || 1),
    (tall - 2 * EDGE) / (size[1] || 1),
  );
  const half = EDGE + (scale * size[0]) / 2; // half the width of the first and last figure
  const apart = n > 1 ? (wide - 2 * half) / (n - 1) : 0;
  const first = n > 1 ? half : wide / 2;
  pen.strokeStyle = color;
  pen.lineWidth = 1.6;
  shares.forEach((share, column) => {
    const pose = flat.poses[Math.round(share * (flat.poses.length - 1))];
    if (!pose) return;
    const x = (joint: number): number =>
      first + column * apart + scale * (pose[2 * joint]! - (flat.low[0] + flat.high[0]) / 2);
    const y = (joint: number): number => tall - EDGE - scale * (pose[2 * joint + 1]! - flat.low[1]);
    pen.beginPath();
    for (const [from, to] of flat.bones) {
      if (Number.isNaN(x(from) + y(from) + x(to) + y(to))) continue;
      pen.moveTo(x(from), y(from));
      pen.lineTo(x(to), y(to));
    }
    pen.stroke();
  });
}

/** Draw channels below each other with the playhead at `share`. */
export function drawCurves(
  pen: CanvasRenderingContext2D,
  curves: Sketch["curves"],
  share: number | null,
  color: string,
): void {
  const [wide, tall] = [pen.canvas.clientWidth, pen.canvas.clientHeight];
  const lane = tall / (curves.length || 1);
  pen.strokeStyle = color;
  pen.lineWidth = 1.2;
  curves.forEach((curve, row) => {
    pen.beginPath();
    curve.forEach((value, at) =>
      pen.lineTo((at / Math.max(curve.length - 1, 1)) * wide, (row + 0.9 - 0.8 * value) * lane),
    );
    pen.stroke();
  });
  if (share === null) return;
  pen.beginPath();
  pen.moveTo(share * wide, 0);
  pen.lineTo(share * wide, tall);
  pen.stroke();
}

/** Projected poses, relative to the root at each sample. */
export interface Flat {
  bones: readonly (readonly [number, number])[];
  fps: number;
  /** Right and up of each joint, metres; NaN if missing. */
  poses: Float32Array[];
  low: [number, number];
  high: [number, number];
}

/** Project motions to 2-D, seen from the side where they move most. Pure functions. */
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
