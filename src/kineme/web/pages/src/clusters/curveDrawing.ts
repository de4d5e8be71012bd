/** How the curves of a cluster look. */
import { onPage } from "../colors";
import { cssColor, theme } from "../theme";
import type { Spread } from "./curves";

type Pen = CanvasRenderingContext2D;

export interface CurvePicture {
  curves: readonly Float32Array[];
  spread: Spread;
  /** Which of the curves is selected; -1: none. */
  selected: number;
  color: string;
}

/** Pixels around the curves. */
export const LEFT = 34;
export const RIGHT = 8;
const BELOW = 16;
const ABOVE = 8;

export function drawCurves(pen: Pen, picture: CurvePicture, width: number, height: number): void {
  const { curves, spread, selected } = picture;
  const [low, high] = boundsOf(curves);
  const last = spread.mean.length - 1;
  const x = (i: number): number => LEFT + (i / last) * (width - LEFT - RIGHT);
  const y = (value: number): number =>
    ABOVE + ((high - value) / (high - low)) * (height - ABOVE - BELOW);
  drawAxes(pen, { low, high, x, y, height, last });
  const color = onPage(picture.color, theme.value);
  pen.lineJoin = "round";
  pen.fillStyle = color;
  pen.globalAlpha = 0.25;
  band(pen, spread, x, y);
  pen.globalAlpha = Math.max(0.18, Math.min(0.6, 6 / curves.length));
  pen.strokeStyle = color;
  pen.lineWidth = 1;
  for (const curve of curves) line(pen, curve, x, y);
  pen.globalAlpha = 1;
  pen.lineWidth = 2.5;
  line(pen, spread.mean, x, y);
  pen.strokeStyle = cssColor("text");
  pen.lineWidth = 1.5;
  if (curves[selected]) line(pen, curves[selected], x, y);
}

/** The curve that passes nearest to a point of the canvas. */
export function nearestCurve(
  curves: readonly Float32Array[],
  px: number,
  py: number,
  width: number,
  height: number,
): number {
  const [low, high] = boundsOf(curves);
  const share = Math.min(Math.max((px - LEFT) / (width - LEFT - RIGHT), 0), 1);
  const i = Math.round(share * ((curves[0]?.length ?? 1) - 1));
  const value = high - ((py - ABOVE) / (height - ABOVE - BELOW)) * (high - low);
  const far = curves.map((curve) => Math.abs(curve[i]! - value));
  return far.indexOf(Math.min(...far.filter((each) => !Number.isNaN(each))));
}

function boundsOf(curves: readonly Float32Array[]): [number, number] {
  let [low, high] = [Infinity, -Infinity];
  for (const curve of curves)
    for (const value of curve) {
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
  /** The number of the last point. */
  last: number;
}

function drawAxes(pen: Pen, { low, high, x, y, height, last }: Axes): void {
  pen.font = "10px system-ui, sans-serif";
  pen.textBaseline = "middle";
  pen.textAlign = "right";
  pen.fillStyle = cssColor("quiet");
  pen.strokeStyle = cssColor("line");
  pen.lineWidth = 1;
  const step = stepOf(high - low);
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  for (let i = Math.ceil(low / step); i * step <= high; i++) {
    const at = Math.round(y(i * step)) + 0.5;
    pen.beginPath();
    pen.moveTo(LEFT, at);
    pen.lineTo(x(last), at);
    pen.stroke();
    pen.fillText((i * step).toFixed(Math.min(digits, 4)), LEFT - 5, at);
  }
  for (const [share, align] of [
    [0, "left"],
    [0.5, "center"],
    [1, "right"],
  ] as const) {
    pen.textAlign = align;
    pen.fillText(`${100 * share} %`, x(share * last), height - BELOW / 2 + 1);
  }
  pen.textAlign = "left";
}

/** 1, 2 or 5 times a power of ten: five steps or fewer in an extent. */
function stepOf(extent: number): number {
  const power = 10 ** Math.floor(Math.log10(extent / 5));
  return [1, 2, 5, 10].map((times) => times * power).find((step) => extent / step <= 5)!;
}

function line(pen: Pen, curve: Float32Array, x: Axes["x"], y: Axes["y"]): void {
  pen.beginPath();
  let down = false;
  curve.forEach((value, i) => {
    if (Number.isNaN(value)) down = false;
    else if (down) pen.lineTo(x(i), y(value));
    else {
      pen.moveTo(x(i), y(value));
      down = true;
    }
  });
  pen.stroke();
}

function band(pen: Pen, { mean, deviation }: Spread, x: Axes["x"], y: Axes["y"]): void {
  pen.beginPath();
  for (let i = 0; i < mean.length; i++) pen.lineTo(x(i), y(mean[i]! + deviation[i]!));
  for (let i = mean.length - 1; i >= 0; i--) pen.lineTo(x(i), y(mean[i]! - deviation[i]!));
  pen.fill();
}
