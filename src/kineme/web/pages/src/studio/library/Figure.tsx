/** Draw a small strip of poses or an animation of a span once it is visible. */
import { useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { adaptColor, getClusterColor } from "../../colors";
import { Canvas, strokeLine, theme, ticker, type Pen } from "../../drawing";
import type { Span } from "../../messages";
import { computePose, findRoot, unpackMotion, type Motion } from "../../motion";
import { decodeBase64 } from "../../recordingData";
import { RecentMap } from "../../util";
import { explainError, type Api } from "../server/api";

const POSES = [0, 1 / 6, 2 / 6, 3 / 6, 4 / 6, 5 / 6, 1];
const MAX_SKETCHES = 600;
const EDGE = 5; // pixels above and below a body

/** A drawn span: a body, or channels scaled to 0–1. */
interface Sketch {
  flat: Flat | null;
  curves: readonly (readonly number[])[];
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

/** Load and cache the sketches of a page. */
export class Sketches {
  private readonly cache = new RecentMap<Promise<Sketch>>(MAX_SKETCHES);

  constructor(private readonly api: Api) {}

  load(span: Span): Promise<Sketch> {
    const key = JSON.stringify([span.recording, span.start_s, span.stop_s]);
    const kept = this.cache.get(key) ?? this.request(span);
    this.cache.set(key, kept);
    kept.catch(() => this.cache.delete(key));
    return kept;
  }

  private async request(span: Span): Promise<Sketch> {
    const { motion, numbers, curves } = await this.api.loadFigure(span);
    if (!motion) return { flat: null, curves };
    const packed = decodeBase64(numbers).buffer;
    return { flat: flattenMotion(await unpackMotion(motion, packed)), curves };
  }
}

interface Props {
  sketches: Sketches;
  span: Span;
  cluster: number;
  /** Whether to animate; undefined draws a strip of poses. */
  playing?: boolean | undefined;
}

export function Figure({ sketches, span, cluster, playing }: Props) {
  const place = useRef<HTMLSpanElement>(null);
  const sketch = useSignal<Sketch | null>(null);
  const failure = useSignal("");
  const visible = useRef(false);
  /** Drawn share of the span, from 0 to 1. */
  const share = useSignal(0.5);
  const { recording, start_s, stop_s } = span;

  useEffect(() => {
    sketch.value = null;
    failure.value = "";
    let here = true;
    const inView = new IntersectionObserver((entries) => {
      visible.current = entries.at(-1)!.isIntersecting;
      if (!visible.current || sketch.peek()) return;
      sketches
        .load({ recording, start_s, stop_s })
        .then((found) => here && (sketch.value = found))
        .catch((error: unknown) => here && (failure.value = explainError(error)));
    });
    inView.observe(place.current!);
    return () => {
      here = false;
      inView.disconnect();
    };
  }, [sketches, recording, start_s, stop_s, sketch, failure]);

  useEffect(() => {
    share.value = 0.5;
    if (!playing) return;
    return ticker.add(() => {
      const { flat } = sketch.peek() ?? {};
      const seconds = Math.max(flat ? flat.poses.length / flat.fps : stop_s - start_s, 0.1);
      if (visible.current) share.value = ((performance.now() / 1000) % seconds) / seconds;
      ticker.request();
    });
  }, [playing, share, sketch, start_s, stop_s]);

  return (
    <span class="figure" ref={place} data-drawn={sketch.value !== null}>
      <Canvas
        label={recording}
        aria-hidden="true"
        watch={() => void [sketch.value, share.value]}
        draw={(pen) => {
          const { flat, curves } = sketch.value ?? {};
          const color = adaptColor(getClusterColor(cluster), theme.value);
          if (flat) drawPoses(pen, flat, playing === undefined ? POSES : [share.value], color);
          else if (curves) drawCurves(pen, curves, playing ? share.value : null, color);
        }}
      />
      {failure.value && (
        <span class="quiet" title={failure.value}>
          cannot be drawn
        </span>
      )}
    </span>
  );
}

/** Draw poses at shares of the span (0 to 1) beside each other. */
export function drawPoses(pen: Pen, flat: Flat, shares: readonly number[], color: string): void {
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
  pen.lineCap = pen.lineJoin = "round";
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
function drawCurves(pen: Pen, curves: Sketch["curves"], share: number | null, color: string): void {
  const [wide, tall] = [pen.canvas.clientWidth, pen.canvas.clientHeight];
  const lane = tall / (curves.length || 1);
  pen.strokeStyle = color;
  pen.lineWidth = 1.2;
  curves.forEach((curve, row) => {
    const x = (at: number): number => (at / Math.max(curve.length - 1, 1)) * wide;
    strokeLine(
      pen,
      curve.map((value, at) => [x(at), (row + 0.9 - 0.8 * value) * lane]),
    );
  });
  if (share !== null)
    strokeLine(pen, [
      [share * wide, 0],
      [share * wide, tall],
    ]);
}

/** Project a motion to 2-D, seen from the side where it moves most. */
function flattenMotion(motion: Motion): Flat {
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
