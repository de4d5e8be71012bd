/** Draw curves below each other, with the segments in the background. */
import { signal } from "@preact/signals";
import { drawInside, FONT, type Pen, readColor, shortenText, strokeLine } from "../drawing";
import type { Curve, CurveList } from "../messages";
import type { RecordingData } from "../recordingData";
import type { Store } from "../store";
import { RecentMap } from "../util";
import type { Span } from "../view";
import { forEachVisible, GUTTER_WIDTH, RULER_HEIGHT } from "./lanes";
import { drawRuler } from "./timelineDrawing";

const GAP = 3;
const PADDING = 4;
const MAX_TILES = 2000; // of 8 kB each

/** A curve and its index in the list of all curves. */
export interface Row {
  curve: number;
  head: Curve;
}

interface Box {
  top: number;
  height: number;
  plotWidth: number;
}

export function drawChannels(
  pen: Pen,
  rows: readonly Row[],
  tiles: CurveTiles,
  store: Store,
  { width, height, ruler }: { width: number; height: number; ruler: boolean },
): void {
  const plotWidth = Math.max(Math.floor(width - GUTTER_WIDTH), 1);
  const first = ruler ? RULER_HEIGHT : 2;
  const each = (height - first) / Math.max(rows.length, 1);
  pen.font = FONT;
  pen.textBaseline = "middle";
  if (ruler) drawRuler(pen, store.range.value, plotWidth);
  rows.forEach(({ curve, head }, i) => {
    const box = { top: first + i * each, height: Math.max(each - GAP, 1), plotWidth };
    drawTitle(pen, head, box);
    drawInside(pen, [GUTTER_WIDTH, box.top, plotWidth, box.height], () => {
      pen.translate(GUTTER_WIDTH, 0);
      drawSegments(pen, store, box);
      drawCurve(pen, curve, tiles, store, box);
    });
  });
}

/** Load a recording's curves in tiles on demand and cache the latest. */
export class CurveTiles {
  /** Number of loaded tiles; redraws depend on it. */
  readonly loadCount = signal(0);
  private readonly cache = new RecentMap<Float32Array | null>(MAX_TILES);

  constructor(
    readonly data: RecordingData,
    readonly list: CurveList,
  ) {}

  /** Return pairs of minimum and maximum; null while loading. */
  get(curve: number, level: number, number: number): Float32Array | null {
    const key = `${curve} ${level} ${number}`;
    const kept = this.cache.get(key);
    if (kept !== undefined) return kept;
    this.cache.set(key, null);
    void this.data.loadCurveTile(curve, level, number).then(
      (bytes) => {
        this.cache.set(key, new Float32Array(bytes ?? new ArrayBuffer(0)));
        this.loadCount.value += 1;
      },
      () => this.cache.delete(key), // the next draw requests it again
    );
    return null;
  }

  /** Return the curve's minimum and maximum; null while loading. */
  getBounds(curve: number): [number, number] | null {
    const pairs = this.get(curve, this.list.levels - 1, 0);
    if (!pairs) return null;
    const finite = pairs.filter((value) => !Number.isNaN(value));
    let [low, high] = [Infinity, -Infinity];
    for (const value of finite) [low, high] = [Math.min(low, value), Math.max(high, value)];
    return finite.length ? [low, high] : [0, 1];
  }

  /** Return the value at a frame; null while loading, NaN if missing. */
  getValue(curve: number, frame: number): number | null {
    const { tile } = this.list;
    const pairs = this.get(curve, 0, Math.floor(frame / tile));
    return pairs?.length ? (pairs[2 * (frame % tile)] ?? NaN) : null;
  }
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
  pen.fillStyle = readColor("lane");
  pen.fillRect(0, top, plotWidth, height);
  const lane = store.primitives.value.length ? store.primitives.value : store.activities.value;
  forEachVisible(lane, store.range.value, plotWidth, (segment, left, right) => {
    pen.globalAlpha = 0.16;
    pen.fillStyle = store.getColor(segment) ?? "transparent";
    pen.fillRect(left, top, right - left, height);
    pen.globalAlpha = 1;
    pen.fillStyle = readColor("line");
    if (right - left > 4) pen.fillRect(Math.round(left), top, 1, height);
  });
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
  const points = Array.from(low, (value, x): [number, number][] | [null] => {
    if (Number.isNaN(value)) return [null];
    const ends = [value, high[x]!].map((end): [number, number] => [x + 0.5, y(end)]);
    // A line of no length would not be drawn where a value has no neighbours.
    ends[1]![1] += value === high[x] ? 0.01 : 0;
    return x % 2 ? ends : ends.reverse();
  });
  strokeLine(pen, points.flat());
}

/** Minimum and maximum of each pixel column; NaN if there is none. */
interface Outline {
  low: Float32Array;
  high: Float32Array;
}

/** Return the coarsest level whose bins are no wider than a pixel. */
function chooseLevel(framesPerPixel: number, factor: number, levels: number): number {
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
