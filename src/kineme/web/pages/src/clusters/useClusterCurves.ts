/** Load the curves of the shown cluster again whenever the table changes. */
import { useComputed, useSignal, useSignalEffect, type ReadonlySignal } from "@preact/signals";
import { useStore } from "../context";
import type { ClusterCurves, CycleChannel } from "../messages";
import type { OpenRecording } from "../openRecording";
import type { RecordingData } from "../recordingData";
import type { Store } from "../store";

export interface MeasuredCurves {
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
