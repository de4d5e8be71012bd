/** Compute what each pixel shows of a curve. Pure functions. */
import type { Span } from "../view";

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
export function computeOutline(
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
