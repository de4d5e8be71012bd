/** Draw the curves of a cluster. */
import { adaptColor } from "../colors";
import type { ClusterCurves } from "../messages";
import { readColor, strokeLine, theme, type Pen } from "../drawing";

/** Values over the cycle; null if not recorded. */
type Values = readonly (number | null)[];

interface CurvePicture {
  curves: ClusterCurves;
  /** Curves of the other side of the body; only their mean is drawn. */
  opposite: ClusterCurves | null;
  /** Indices of the excluded repetitions. */
  leftOut: ReadonlySet<number>;
  /** Index of the selected repetition; -1 for none. */
  selected: number;
  color: string;
}

/** Margins around the curves, in pixels. */
export const MARGIN_LEFT = 34;
export const MARGIN_RIGHT = 8;
const MARGIN_BOTTOM = 16;
const MARGIN_TOP = 8;

const DASHES = [5, 4];

/**
 * Draw the repetitions of a cluster with their mean and deviation. The mean of another session
 * (`beside`), else that of the other side of the body, is dashed.
 */
export function drawCurves(pen: Pen, picture: CurvePicture, width: number, height: number): void {
  const { curves, opposite, leftOut, selected } = picture;
  const { cycles, mean, beside } = curves;
  const [low, high] = computeBounds(curves, opposite);
  const last = mean.length - 1;
  const x = (i: number): number => MARGIN_LEFT + (i / last) * (width - MARGIN_LEFT - MARGIN_RIGHT);
  const y = (value: number): number =>
    MARGIN_TOP + ((high - value) / (high - low)) * (height - MARGIN_TOP - MARGIN_BOTTOM);
  drawAxes(pen, { low, high, x, y, height, last });
  const color = adaptColor(picture.color, theme.value);
  pen.lineJoin = "round";
  if (beside) {
    pen.fillStyle = readColor("quiet");
    pen.globalAlpha = 0.2;
    fillBand(pen, beside, x, y);
  }
  pen.fillStyle = color;
  pen.globalAlpha = 0.25;
  fillBand(pen, curves, x, y);
  // Many repetitions overlap, so each is paler.
  const alpha = Math.max(0.18, Math.min(0.6, 6 / cycles.length));
  pen.lineWidth = 1;
  for (const [i, { values, counts }] of cycles.entries()) {
    pen.strokeStyle = leftOut.has(i) ? readColor("quiet") : color;
    const isInMean = counts && !leftOut.has(i);
    pen.globalAlpha = isInMean ? alpha : alpha / 2;
    strokeCurve(pen, values, x, y);
  }
  pen.strokeStyle = color;
  pen.globalAlpha = 1;
  pen.lineWidth = 2.5;
  strokeCurve(pen, mean, x, y);
  const dashed = beside ?? opposite;
  if (dashed) {
    pen.strokeStyle = beside ? readColor("quiet") : color;
    pen.lineWidth = beside ? 2 : 1.5;
    pen.setLineDash(DASHES);
    strokeCurve(pen, dashed.mean, x, y);
    pen.setLineDash([]);
  }
  // Mark on the axis where the two sessions differ.
  pen.fillStyle = color;
  for (const [i, differs] of (beside?.differs ?? []).entries())
    if (differs) pen.fillRect(x(i - 0.5), height - MARGIN_BOTTOM - 3, x(1) - x(0) + 0.5, 3);
  pen.strokeStyle = readColor("text");
  pen.lineWidth = 1.5;
  if (cycles[selected]) strokeCurve(pen, cycles[selected].values, x, y);
}

/** Return the index of the repetition whose curve is nearest to a point of the canvas. */
export function findNearestCurve(
  curves: ClusterCurves,
  opposite: ClusterCurves | null,
  px: number,
  py: number,
  width: number,
  height: number,
): number {
  const [low, high] = computeBounds(curves, opposite);
  const share = Math.min(Math.max((px - MARGIN_LEFT) / (width - MARGIN_LEFT - MARGIN_RIGHT), 0), 1);
  const i = Math.round(share * (curves.mean.length - 1));
  const value = high - ((py - MARGIN_TOP) / (height - MARGIN_TOP - MARGIN_BOTTOM)) * (high - low);
  const far = curves.cycles.map(({ values }) => Math.abs((values[i] ?? Infinity) - value));
  return far.indexOf(Math.min(...far));
}

function computeBounds(curves: ClusterCurves, opposite: ClusterCurves | null): [number, number] {
  let [low, high] = [Infinity, -Infinity];
  const means = [opposite?.mean ?? [], curves.beside?.mean ?? []];
  for (const values of [...curves.cycles.map((each) => each.values), ...means])
    for (const value of values) {
      if (value === null) continue;
      if (value < low) low = value;
      if (value > high) high = value;
    }
  if (!(high > low))
    return [Number.isFinite(low) ? low - 0.5 : 0, Number.isFinite(low) ? low + 0.5 : 1];
  const margin = 0.06 * (high - low);
  return [low - margin, high + margin];
}

interface Axes {
  low: number;
  high: number;
  x: (i: number) => number;
  y: (value: number) => number;
  height: number;
  /** Index of the last sample. */
  last: number;
}

function drawAxes(pen: Pen, { low, high, x, y, height, last }: Axes): void {
  pen.font = "10px system-ui, sans-serif";
  pen.textBaseline = "middle";
  pen.textAlign = "right";
  pen.fillStyle = readColor("quiet");
  pen.strokeStyle = readColor("line");
  pen.lineWidth = 1;
  const step = chooseStep(high - low);
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  for (let i = Math.ceil(low / step); i * step <= high; i++) {
    const at = Math.round(y(i * step)) + 0.5;
    strokeLine(pen, [
      [MARGIN_LEFT, at],
      [x(last), at],
    ]);
    pen.fillText((i * step).toFixed(Math.min(digits, 4)), MARGIN_LEFT - 5, at);
  }
  for (const [share, align] of [
    [0, "left"],
    [0.5, "center"],
    [1, "right"],
  ] as const) {
    pen.textAlign = align;
    pen.fillText(`${100 * share} %`, x(share * last), height - MARGIN_BOTTOM / 2 + 1);
  }
  pen.textAlign = "left";
}

/** Return 1, 2 or 5 times a power of ten that divides an extent into at most five steps. */
function chooseStep(extent: number): number {
  const power = 10 ** Math.floor(Math.log10(extent / 5));
  return [1, 2, 5, 10].map((times) => times * power).find((step) => extent / step <= 5)!;
}

function strokeCurve(pen: Pen, curve: Values, x: Axes["x"], y: Axes["y"]): void {
  strokeLine(
    pen,
    curve.map((value, i) => (value === null ? null : [x(i), y(value)])),
  );
}

/** Fill mean ± standard deviation; nothing if it is unknown, as for a single repetition. */
function fillBand(
  pen: Pen,
  { mean, sd }: Pick<ClusterCurves, "mean" | "sd">,
  x: Axes["x"],
  y: Axes["y"],
): void {
  if (mean.includes(null) || sd.includes(null)) return;
  pen.beginPath();
  for (let i = 0; i < mean.length; i++) pen.lineTo(x(i), y(mean[i]! + sd[i]!));
  for (let i = mean.length - 1; i >= 0; i--) pen.lineTo(x(i), y(mean[i]! - sd[i]!));
  pen.fill();
}
