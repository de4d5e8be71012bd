/** From time to pixels and back: the span of a recording that is shown. Pure functions. */

export interface Span {
  start_s: number;
  stop_s: number;
}

/** Least seconds that fill the screen. */
const LEAST = 0.2;

export function toPixel(range: Span, width: number, seconds: number): number {
  return ((seconds - range.start_s) / (range.stop_s - range.start_s)) * width;
}

export function toSeconds(range: Span, width: number, pixel: number): number {
  return range.start_s + (pixel / width) * (range.stop_s - range.start_s);
}

/** `factor` < 1 shows less; the time `at` stays where it is as long as the recording fills the view. */
export function zoomed(range: Span, factor: number, at: number, total: number): Span {
  const before = range.stop_s - range.start_s;
  const after = Math.min(Math.max(before * factor, Math.min(LEAST, total)), total);
  const start = at - ((at - range.start_s) / before) * after;
  return inside({ start_s: start, stop_s: start + after }, total);
}

export function panned(range: Span, by: number, total: number): Span {
  return inside({ start_s: range.start_s + by, stop_s: range.stop_s + by }, total);
}

/** The range moved so that a time is in it: unmoved if it is, else with the time at its left. */
export function following(range: Span, seconds: number, total: number): Span {
  const length = range.stop_s - range.start_s;
  if (range.start_s <= seconds && seconds <= range.stop_s) return range;
  return panned(range, seconds - range.start_s - 0.08 * length, total);
}

/** Moved into the recording, with its length kept. */
export function inside(range: Span, total: number): Span {
  const length = Math.min(range.stop_s - range.start_s, total);
  const start = Math.min(Math.max(range.start_s, 0), total - length);
  return { start_s: start, stop_s: start + length };
}

export interface Tick {
  seconds: number;
  label: string;
}

const STEPS = [
  0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600,
];

/** Round times at least `apart` pixels from each other. */
export function ticksOf(range: Span, width: number, apart = 64): Tick[] {
  const least = ((range.stop_s - range.start_s) / Math.max(width, 1)) * apart;
  const step = STEPS.find((each) => each >= least) ?? 7200;
  const digits = step < 0.1 ? 2 : step < 1 ? 1 : 0;
  const ticks: Tick[] = [];
  for (let i = Math.ceil(range.start_s / step - 1e-9); i * step <= range.stop_s + 1e-9; i++)
    ticks.push({ seconds: i * step, label: clock(i * step, digits) });
  return ticks;
}

/** 75.5 -> "1:15.5"; hours where there are any. */
export function clock(seconds: number, digits = 0): string {
  const units = Math.round(seconds * 10 ** digits);
  const full = Math.floor(units / 10 ** digits);
  const rest = digits ? `.${String(units % 10 ** digits).padStart(digits, "0")}` : "";
  const two = (value: number): string => String(value).padStart(2, "0");
  const [h, m, s] = [Math.floor(full / 3600), Math.floor(full / 60) % 60, full % 60];
  return (h ? `${h}:${two(m)}` : `${m}`) + `:${two(s)}${rest}`;
}
