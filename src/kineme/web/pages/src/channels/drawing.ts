/** How curves look: one below the other, with the segments behind them. */
import type { Curve } from "../messages";
import type { Store } from "../store";
import { cssColor } from "../theme";
import { drawRuler, FONT, shortened } from "../timeline/frame";
import { GUTTER, RULER, visible } from "../timeline/lanes";
import { toPixel } from "../view";
import { levelFor, outlineOf, type Outline } from "./outline";
import type { CurveTiles } from "./tiles";

type Pen = CanvasRenderingContext2D;

const GAP = 3;
const PAD = 4; // pixels above and below a curve

export interface Row {
  curve: number;
  head: Curve;
}

interface Box {
  top: number;
  height: number;
  room: number;
}

/** The place of each row. */
export function boxOf(row: number, rows: number, height: number, ruler: boolean): [number, number] {
  const top = ruler ? RULER : 2;
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
  const room = Math.max(Math.floor(width - GUTTER), 1);
  pen.font = FONT;
  pen.textBaseline = "middle";
  if (ruler) drawRuler(pen, store.range.value, room);
  rows.forEach((row, i) => {
    const [top, tall] = boxOf(i, rows.length, height, ruler);
    const box = { top, height: tall, room };
    drawTitle(pen, row.head, box);
    pen.save();
    pen.translate(GUTTER, 0);
    pen.beginPath();
    pen.rect(0, top, room, tall);
    pen.clip();
    drawSegments(pen, store, box);
    drawCurve(pen, row.curve, tiles, store, box);
    pen.restore();
  });
}

function drawTitle(pen: Pen, { name, group, unit }: Curve, { top, height }: Box): void {
  const two = height > 26;
  const middle = top + height / 2;
  pen.fillStyle = cssColor("text");
  pen.fillText(shortened(pen, name, GUTTER - 14), 10, two ? middle - 7 : middle);
  pen.fillStyle = cssColor("quiet");
  const below = group === "channels" ? unit : `${group}${unit ? `, ${unit}` : ""}`;
  if (two) pen.fillText(shortened(pen, below, GUTTER - 14), 10, middle + 7);
}

/** Faint colours of the primitives, so that one sees which repetition a curve is in. */
function drawSegments(pen: Pen, store: Store, { top, height, room }: Box): void {
  const range = store.range.value;
  pen.fillStyle = cssColor("lane");
  pen.fillRect(0, top, room, height);
  const lane = store.primitives.value.length ? store.primitives.value : store.activities.value;
  const [from, to] = visible(lane, range.start_s, range.stop_s);
  let drawn = -Infinity;
  for (let i = from; i < to; i++) {
    const segment = lane[i]!;
    const left = toPixel(range, room, segment.start_s);
    const right = toPixel(range, room, segment.stop_s);
    if (right - drawn < 0.5) continue;
    drawn = right;
    const color = store.colorOf(segment);
    if (color) {
      pen.globalAlpha = 0.16;
      pen.fillStyle = color;
      pen.fillRect(left, top, right - left, height);
      pen.globalAlpha = 1;
    }
    pen.fillStyle = cssColor("line");
    if (right - left > 4) pen.fillRect(Math.round(left), top, 1, height);
  }
}

function drawCurve(pen: Pen, curve: number, tiles: CurveTiles, store: Store, box: Box): void {
  const bounds = tiles.bounds(curve);
  if (!bounds) return;
  const [low, high] = bounds[0] < bounds[1] ? bounds : [bounds[0] - 1, bounds[1] + 1];
  const scale = (box.height - 2 * PAD) / (high - low);
  const y = (value: number): number => box.top + box.height - PAD - (value - low) * scale;
  if (low < 0 && high > 0) {
    pen.fillStyle = cssColor("line");
    pen.fillRect(0, Math.round(y(0)), box.room, 1);
  }
  pen.strokeStyle = cssColor("text");
  pen.lineWidth = 1.2;
  pen.lineJoin = "round";
  stroke(pen, shownOf(curve, tiles, store, box.room), y);
}

/** As fine as the screen; what has not come yet is drawn as coarse as it is known. */
function shownOf(curve: number, tiles: CurveTiles, store: Store, room: number): Outline {
  const { factor, levels, tile } = tiles.list;
  const range = store.range.value;
  const fps = store.fps.value;
  const frames = store.recording.value?.n_frames ?? 0;
  const perPixel = ((range.stop_s - range.start_s) * fps) / room;
  const outlineAt = (level: number): Outline => {
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
    return outlineOf(bin, bins, fps / wide, range, room);
  };
  let missing = false;
  const fine = outlineAt(levelFor(perPixel, factor, levels));
  if (!missing) return fine;
  const coarse = outlineAt(levels - 1);
  return {
    low: fine.low.map((value, i) => (Number.isNaN(value) ? coarse.low[i]! : value)),
    high: fine.high.map((value, i) => (Number.isNaN(value) ? coarse.high[i]! : value)),
  };
}

/** One line up and down through every column, broken where nothing was seen. */
function stroke(pen: Pen, { low, high }: Outline, y: (value: number) => number): void {
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
