/** Relate the drawn repetitions to segments. Compute their ranges. */
import type { CycleCurve, ClusterCurves, CycleChannel } from "../messages";
import { computeMean } from "../util";
import { type Store, useStore } from "../store";
import { useComputed, useSignal, useSignalEffect, type ReadonlySignal } from "@preact/signals";
import type { OpenRecording, RecordingData } from "../recordingData";

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

interface MeasuredCurves {
  data: RecordingData;
  channels: readonly CycleChannel[];
  /** null if the cluster has no curves. */
  curves: ClusterCurves | null;
  /** Curves of the other side of the body. */
  opposite: ClusterCurves | null;
}

/**
 * Return the loaded curves. The previous ones stay until the next arrive, unless the recording
 * changes. With `beside`, another recording takes the place of the other side of the body.
 */
export function useClusterCurves(
  chosen: ReadonlySignal<string>,
  beside: ReadonlySignal<OpenRecording | undefined>,
): ReadonlySignal<MeasuredCurves | null> {
  const store = useStore();
  const measured = useSignal<MeasuredCurves | null>(null);
  // Changes when an edit is confirmed, not while it is sent.
  const revision = useComputed(() => store.recording.value?.revision ?? 0);
  const data = useComputed(() => store.active.value?.data);
  const cluster = useComputed(() => getShownCluster(store));
  const id = useComputed(() => beside.value?.recording.value.id ?? "");
  const revisionBeside = useComputed(() => beside.value?.recording.value.revision ?? 0);
  useSignalEffect(() => {
    let isCurrent = true;
    const [from, of, channel, now] = [data.value, cluster.value, chosen.value, revision.value];
    void revisionBeside.value;
    if (!from) return;
    void loadCurves(from, of, channel, now, id.value).then(
      (found) => {
        if (isCurrent) measured.value = found;
      },
      () => undefined, // the next change requests them again
    );
    return () => void (isCurrent = false);
  });
  return useComputed(() => (measured.value?.data === data.value ? measured.value : null));
}

/** Return the selected cluster's number, else the first; -1 without clusters. */
export function getShownCluster(store: Store): number {
  return (store.shownCluster.value ?? store.clusters.value[0])?.id ?? -1;
}

async function loadCurves(
  data: RecordingData,
  cluster: number,
  chosen: string,
  revision: number,
  beside: string,
): Promise<MeasuredCurves> {
  if (cluster < 0) return { data, channels: [], curves: null, opposite: null };
  const channels = await data.loadCycleChannels();
  const channel = channels.some(({ name }) => name === chosen) ? chosen : "";
  const curves = await data.loadClusterCurves(cluster, channel, revision, beside);
  const other = !beside && channels.find(({ name }) => name === curves?.channel)?.opposite;
  const opposite = other ? await data.loadClusterCurves(cluster, other, revision) : null;
  return { data, channels, curves, opposite };
}
