/** Relate the drawn repetitions to segments. Compute their ranges. */
import type { CycleCurve } from "../messages";
import { computeMean } from "../mean";
import type { Store } from "../store";

/** Select a repetition's segment and go to the repetition's start. */
export function selectCycle(store: Store, cycle: CycleCurve | undefined): void {
  const segment = store.primitives.value.find(
    ({ start_frame }) => start_frame === cycle?.start_frame,
  );
  if (!segment || !cycle) return;
  store.select(segment);
  if (segment.start_s < cycle.start_s && cycle.start_s < segment.stop_s) store.seek(cycle.start_s);
}

/** Return the indices of the repetitions that the table excludes. */
export function findExcluded(store: Store, cycles: readonly CycleCurve[]): ReadonlySet<number> {
  const rows = store.primitives.value.filter(({ excluded }) => excluded);
  const starts = new Set(rows.map(({ start_frame }) => start_frame));
  return new Set(cycles.flatMap(({ start_frame }, i) => (starts.has(start_frame) ? [i] : [])));
}

/** Return the index of the selected repetition, else of the one at the playhead; -1 if neither. */
export function findCurrentCycle(store: Store, cycles: readonly CycleCurve[]): number {
  const { level, start_frame } = store.selected.value ?? {};
  const at = store.playhead.value;
  const selected = cycles.findIndex((each) => each.start_frame === start_frame);
  if (selected >= 0 && level === "primitive") return selected;
  return cycles.findIndex((each) => each.start_s <= at && at < each.stop_s);
}

/** Return a repetition's range of motion, maximum minus minimum; null if not recorded. */
export function computeRange({ values }: CycleCurve): number | null {
  const known = values.filter((value) => value !== null);
  return known.length ? Math.max(...known) - Math.min(...known) : null;
}

/** Return mean and standard deviation of the ranges as text, such as "92 ± 3"; empty if none. */
export function summarizeRanges(cycles: readonly CycleCurve[]): string {
  const { mean, deviation } = computeMean(
    cycles.map(computeRange).filter((range) => range !== null),
  );
  if (mean === null) return "";
  return formatNumber(mean) + (deviation === null ? "" : ` ± ${formatNumber(deviation)}`);
}

/** Format a number with three significant digits. */
export function formatNumber(value: number): string {
  return `${Number(value.toPrecision(3))}`;
}

export function appendUnit(number: string, unit: string): string {
  return unit === "°" ? `${number}°` : `${number} ${unit}`.trim();
}
