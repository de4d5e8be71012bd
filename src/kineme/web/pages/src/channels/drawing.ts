/** Draw curves below each other, with the segments in the background. */
import type { Curve } from "../messages";
import type { Store } from "../store";
import { readColor } from "../theme";
import { drawRuler, FONT, shortenText } from "../timeline/drawing";
import { GUTTER_WIDTH, RULER_HEIGHT, findVisible } from "../timeline/lanes";
import { toPixel, type Span } from "../view";
import type { CurveTiles } from "./tiles";

type Pen = CanvasRenderingContext2D;

const GAP = 3;
const PADDING = 4;

export interface Row {
  curve: number;
  head: Curve;
}

interface Box {
  top: number;
  height: number;
  plotWidth: number;
}

/** Return a row's top and height in pixels. */
export function getRowBounds(
  row: number,
  rows: number,
  height: number,
  ruler: boolean,
): [number, number] {
  const top = ruler ? RULER_HEIGHT : 2;
  const each = (height - top) / Math.max(rows, 1);
  return [top + row * each, Math.max(each - GAP, 1)];
}

export function drawChannels(
  pen: Pen,
  rows: readonly Row[],
  tiles: CurveTiles,
  store: Store,
  { width, height, ruler }: { width: number; height: number; ruler: boolean },
): void {
  const plotWidth = Math.max(Math.floor(width - GUTTER_WIDTH), 1);
  pen.font = FONT;
  pen.textBaseline = "middle";
  if (ruler) drawRuler(pen, store.range.value, plotWidth);
  rows.forEach((row, i) => {
    const [top, tall] = getRowBounds(i, rows.length, height, ruler);
    const box = { top, height: tall, plotWidth };
    drawTitle(pen, row.head, box);
    pen.save();
    pen.translate(GUTTER_WIDTH, 0);
    pen.beginPath();
    pen.rect(0, top, plotWidth, tall);
    pen.clip();
    drawSegments(pen, store, box);
    drawCurve(pen, row.curve, tiles, store, box);
    pen.restore();
  });
}

function drawTitle(pen: Pen, { name, group, unit }: Curve, { top, height }: Box): void {
  const two = height > 26;
  const middle = top + height / 2;
  pen.fillStyle = readColor("text");
  pen.fillText(shortenText(pen, name, GUTTER_WIDTH - 14), 10, two ? middle - 7 : middle);
  pen.fillStyle = readColor("quiet");
  const below = group === "channels" ? unit : `${group}${unit ? `, ${unit}` : ""}`;
  if (two) pen.fillText(shortenText(pen, below, GUTTER_WIDTH - 14), 10, middle + 7);
}

/** Shade the primitives faintly, to show which repetition a curve is in. */
function drawSegments(pen: Pen, store: Store, { top, height, plotWidth }: Box): void {
  const range = store.range.value;
  pen.fillStyle = readColor("lane");
  pen.fillRect(0, top, plotWidth, height);
  const lane = store.primitives.value.length ? store.primitives.value : store.activities.value;
  const [from, to] = findVisible(lane, range.start_s, range.stop_s);
  let drawn = -Infinity;
  for (let i = from; i < to; i++) {
    const segment = lane[i]!;
    const left = toPixel(range, plotWidth, segment.start_s);
    const right = toPixel(range, plotWidth, segment.stop_s);
    if (right - drawn < 0.5) continue;
    drawn = right;
    const color = store.getColor(segment);
    if (color) {
      pen.globalAlpha = 0.16;
      pen.fillStyle = color;
      pen.fillRect(left, top, right - left, height);
      pen.globalAlpha = 1;
    }
    pen.fillStyle = readColor("line");
    if (right - left > 4) pen.fillRect(Math.round(left), top, 1, height);
  }
}

function drawCurve(pen: Pen, curve: number, tiles: CurveTiles, store: Store, box: Box): void {
  const bounds = tiles.getBounds(curve);
  if (!bounds) return;
  const [low, high] = bounds[0] < bounds[1] ? bounds : [bounds[0] - 1, bounds[1] + 1];
  const scale = (box.height - 2 * PADDING) / (high - low);
  const y = (value: number): number => box.top + box.height - PADDING - (value - low) * scale;
  if (low < 0 && high > 0) {
    pen.fillStyle = readColor("line");
    pen.fillRect(0, Math.round(y(0)), box.plotWidth, 1);
  }
  pen.strokeStyle = readColor("text");
  pen.lineWidth = 1.2;
  pen.lineJoin = "round";
  strokeOutline(pen, sampleOutline(curve, tiles, store, box.plotWidth), y);
}

/** Return the curve's outline; coarser bins stand in for tiles that are still loading. */
function sampleOutline(curve: number, tiles: CurveTiles, store: Store, plotWidth: number): Outline {
  const { factor, levels, tile } = tiles.list;
  const range = store.range.value;
  const fps = store.fps.value;
  const frames = store.recording.value?.n_frames ?? 0;
  const perPixel = ((range.stop_s - range.start_s) * fps) / plotWidth;
  const computeAtLevel = (level: number): Outline => {
    const wide = factor ** level;
    const bins = Math.ceil(frames / wide);
    let number = -1;
    let pairs: Float32Array | null = null;
    const bin = (i: number): readonly [number, number] | null => {
      if (Math.floor(i / tile) !== number) {
        number = Math.floor(i / tile);
        pairs = tiles.get(curve, level, number);
        if (!pairs?.length) missing = true;
      }
      const at = 2 * (i - number * tile);
      return pairs?.length ? [pairs[at]!, pairs[at + 1]!] : null;
    };
    return computeOutline(bin, bins, fps / wide, range, plotWidth);
  };
  let missing = false;
  const fine = computeAtLevel(chooseLevel(perPixel, factor, levels));
  if (!missing) return fine;
  const coarse = computeAtLevel(levels - 1);
  return {
    low: fine.low.map((value, i) => (Number.isNaN(value) ? coarse.low[i]! : value)),
    high: fine.high.map((value, i) => (Number.isNaN(value) ? coarse.high[i]! : value)),
  };
}

/** Draw one line up and down through every pixel column, with gaps at missing values. */
function strokeOutline(pen: Pen, { low, high }: Outline, y: (value: number) => number): void {
  pen.beginPath();
  let down = true;
  let broken = true;
  for (let x = 0; x < low.length; x++) {
    if (Number.isNaN(low[x]!)) {
      broken = true;
      continue;
    }
    const [first, last] = down ? [high[x]!, low[x]!] : [low[x]!, high[x]!];
    if (broken) pen.moveTo(x + 0.5, y(first));
    else pen.lineTo(x + 0.5, y(first));
    if (first !== last || broken) pen.lineTo(x + 0.5, y(last) + (first === last ? 0.01 : 0));
    down = !down;
    broken = false;
  }
  pen.stroke();
}

/** Minimum and maximum of each pixel column; NaN if there is none. */
export interface Outline {
  low: Float32Array;
  high: Float32Array;
}

/** Return the coarsest level whose bins are no wider than a pixel. */
export function chooseLevel(framesPerPixel: number, factor: number, levels: number): number {
  const level = Math.floor(Math.log(Math.max(framesPerPixel, 1)) / Math.log(factor) + 1e-9);
  return Math.min(level, levels - 1);
}

/** Return the range of values in each of `width` pixels, interpolated if bins are wider. */
function computeOutline(
  bin: (index: number) => readonly [number, number] | null,
  bins: number,
  perSecond: number,
  range: Span,
  width: number,
): Outline {
  const low = new Float32Array(width).fill(NaN);
  const high = new Float32Array(width).fill(NaN);
  const perPixel = ((range.stop_s - range.start_s) * perSecond) / width;
  const first = range.start_s * perSecond;
  for (let x = 0; x < width; x++) {
    const from = first + x * perPixel;
    const until = from + perPixel;
    if (perPixel < 1) {
      const value = interpolateBins(bin, bins, from + 0.5 * perPixel);
      low[x] = high[x] = value;
      continue;
    }
    for (let i = Math.max(Math.floor(from), 0); i < Math.min(Math.ceil(until), bins); i++) {
      const pair = bin(i);
      if (!pair || Number.isNaN(pair[0])) continue;
      low[x] = Number.isNaN(low[x]!) ? pair[0] : Math.min(low[x]!, pair[0]);
      high[x] = Number.isNaN(high[x]!) ? pair[1] : Math.max(high[x]!, pair[1]);
    }
  }
  return { low, high };
}

/** Interpolate between two bins; NaN outside of the curve. */
function interpolateBins(
  bin: (index: number) => readonly [number, number] | null,
  bins: number,
  at: number,
): number {
  const before = Math.floor(at);
  if (before < 0 || before > bins - 1) return NaN;
  const a = bin(before)?.[0] ?? NaN;
  const b = bin(Math.min(before + 1, bins - 1))?.[0] ?? NaN;
  const share = at - before;
  return share < 1e-6 || Number.isNaN(b) ? a : a + share * (b - a);
}
