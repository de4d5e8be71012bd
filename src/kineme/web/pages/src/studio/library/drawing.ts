/** Draw small figures on a canvas: poses or curves. */
import type { Flat } from "./flattenMotion";

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
