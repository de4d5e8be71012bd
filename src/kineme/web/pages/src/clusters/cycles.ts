/** The repetitions that are drawn: which segments they are, and how far they go. */
import type { CycleCurve } from "../messages";
import { meanOf } from "../mean";
import type { Store } from "../store";

/** Selects the segment of a repetition, if it is there still, and goes to where it is measured from. */
export function selectCycle(store: Store, cycle: CycleCurve | undefined): void {
  const segment = store.primitives.value.find(
    ({ start_frame }) => start_frame === cycle?.start_frame,
  );
  if (!segment || !cycle) return;
  store.select(segment);
  if (segment.start_s < cycle.start_s && cycle.start_s < segment.stop_s) store.seek(cycle.start_s);
}

/** The numbers of the repetitions that people left out, by the table as it is shown. */
export function leftOutOf(store: Store, cycles: readonly CycleCurve[]): ReadonlySet<number> {
  const rows = store.primitives.value.filter(({ excluded }) => excluded);
  const starts = new Set(rows.map(({ start_frame }) => start_frame));
  return new Set(cycles.flatMap(({ start_frame }, i) => (starts.has(start_frame) ? [i] : [])));
}

/** The number of the selected repetition, else of the one under the playhead; -1: neither. */
export function cycleAt(store: Store, cycles: readonly CycleCurve[]): number {
  const { level, start_frame } = store.selected.value ?? {};
  const at = store.playhead.value;
  const selected = cycles.findIndex((each) => each.start_frame === start_frame);
  if (selected >= 0 && level === "primitive") return selected;
  return cycles.findIndex((each) => each.start_s <= at && at < each.stop_s);
}

/** How far a repetition goes in its channel, from the least to the greatest value; null: not recorded. */
export function rangeOf({ values }: CycleCurve): number | null {
  const known = values.filter((value) => value !== null);
  return known.length ? Math.max(...known) - Math.min(...known) : null;
}

/** Mean and standard deviation of these ranges, such as "92 ± 3"; empty for none. */
export function summarizeRanges(cycles: readonly CycleCurve[]): string {
  const { mean, deviation } = meanOf(cycles.map(rangeOf).filter((range) => range !== null));
  if (mean === null) return "";
  return formatNumber(mean) + (deviation === null ? "" : ` ± ${formatNumber(deviation)}`);
}

/** A number to three digits. */
export function formatNumber(value: number): string {
  return `${Number(value.toPrecision(3))}`;
}

export function withUnit(number: string, unit: string): string {
  return unit === "°" ? `${number}°` : `${number} ${unit}`.trim();
}
