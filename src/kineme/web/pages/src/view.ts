/** Convert between time and pixels of the visible time span. Pure functions. */

export interface Span {
  start_s: number;
  stop_s: number;
}

/** Shortest visible span, seconds. */
const MIN_RANGE = 0.2;

export function toPixel(range: Span, width: number, seconds: number): number {
  return ((seconds - range.start_s) / (range.stop_s - range.start_s)) * width;
}

export function toSeconds(range: Span, width: number, pixel: number): number {
  return range.start_s + (pixel / width) * (range.stop_s - range.start_s);
}

/** Zoom a range by a factor (< 1 shows less), keeping the time `at` in place. */
export function zoomRange(range: Span, factor: number, at: number, total: number): Span {
  const before = range.stop_s - range.start_s;
  const after = Math.min(Math.max(before * factor, Math.min(MIN_RANGE, total)), total);
  const start = at - ((at - range.start_s) / before) * after;
  return clampRange({ start_s: start, stop_s: start + after }, total);
}

export function panRange(range: Span, by: number, total: number): Span {
  return clampRange({ start_s: range.start_s + by, stop_s: range.stop_s + by }, total);
}

/** Return the range moved so that it contains a time; a new range has the time near its left. */
export function revealTime(range: Span, seconds: number, total: number): Span {
  const length = range.stop_s - range.start_s;
  if (range.start_s <= seconds && seconds <= range.stop_s) return range;
  return panRange(range, seconds - range.start_s - 0.08 * length, total);
}

/** Move a range into the recording, keeping its length. */
export function clampRange(range: Span, total: number): Span {
  const length = Math.min(range.stop_s - range.start_s, total);
  const start = Math.min(Math.max(range.start_s, 0), total - length);
  return { start_s: start, stop_s: start + length };
}

interface Tick {
  seconds: number;
  label: string;
}

const STEPS = [
  0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600,
];

/** Return round times at least `apart` pixels from each other. */
export function computeTicks(range: Span, width: number, apart = 64): Tick[] {
  const least = ((range.stop_s - range.start_s) / Math.max(width, 1)) * apart;
  const step = STEPS.find((each) => each >= least) ?? 7200;
  const digits = step < 0.1 ? 2 : step < 1 ? 1 : 0;
  const ticks: Tick[] = [];
  for (let i = Math.ceil(range.start_s / step - 1e-9); i * step <= range.stop_s + 1e-9; i++)
    ticks.push({ seconds: i * step, label: formatTime(i * step, digits) });
  return ticks;
}

/** Format seconds, such as 75.5 as "1:15.5"; hours if any. */
export function formatTime(seconds: number, digits = 0): string {
  const units = Math.round(seconds * 10 ** digits);
  const full = Math.floor(units / 10 ** digits);
  const rest = digits ? `.${String(units % 10 ** digits).padStart(digits, "0")}` : "";
  const two = (value: number): string => String(value).padStart(2, "0");
  const [h, m, s] = [Math.floor(full / 3600), Math.floor(full / 60) % 60, full % 60];
  return (h ? `${h}:${two(m)}` : `${m}`) + `:${two(s)}${rest}`;
}
