/** The curves of the cluster that is looked at, asked for anew whenever the table has changed. */
import { useComputed, useSignal, useSignalEffect, type ReadonlySignal } from "@preact/signals";
import { useStore } from "../context";
import type { ClusterCurves, CycleChannel } from "../messages";
import type { OpenRecording } from "../opened";
import type { RecordingData } from "../recordingData";
import type { Store } from "../store";

export interface Measured {
  data: RecordingData;
  channels: readonly CycleChannel[];
  /** null where the cluster has none. */
  curves: ClusterCurves | null;
  /** The same of the other side of the body. */
  opposite: ClusterCurves | null;
}

/**
 * Those before stay until the next ones are here; those of another recording do not. In place of
 * the other side of the body there may be another recording (`beside`).
 */
export function useClusterCurves(
  chosen: ReadonlySignal<string>,
  beside: ReadonlySignal<OpenRecording | undefined>,
): ReadonlySignal<Measured | null> {
  const store = useStore();
  const measured = useSignal<Measured | null>(null);
  const revision = useComputed(() => store.recording.value?.revision ?? 0); // not with each edit
  const data = useComputed(() => store.active.value?.data);
  const cluster = useComputed(() => shownCluster(store));
  const id = useComputed(() => beside.value?.recording.value.id ?? "");
  const revisionBeside = useComputed(() => beside.value?.recording.value.revision ?? 0);
  useSignalEffect(() => {
    let asked = true;
    const [from, of, channel, now] = [data.value, cluster.value, chosen.value, revision.value];
    void revisionBeside.value;
    if (!from) return;
    void measure(from, of, channel, now, id.value).then(
      (found) => {
        if (asked) measured.value = found;
      },
      () => undefined, // asked for again once anything is another
    );
    return () => void (asked = false);
  });
  return useComputed(() => (measured.value?.data === data.value ? measured.value : null));
}

/** The cluster that is chosen, else the first; -1 without clusters. */
export function shownCluster(store: Store): number {
  return (store.shownCluster.value ?? store.clusters.value[0])?.id ?? -1;
}

async function measure(
  data: RecordingData,
  cluster: number,
  chosen: string,
  revision: number,
  beside: string,
): Promise<Measured> {
  if (cluster < 0) return { data, channels: [], curves: null, opposite: null };
  const channels = await data.cycleChannels();
  const channel = channels.some(({ name }) => name === chosen) ? chosen : "";
  const curves = await data.clusterCurves(cluster, channel, revision, beside);
  const other = !beside && channels.find(({ name }) => name === curves?.channel)?.opposite;
  const opposite = other ? await data.clusterCurves(cluster, other, revision) : null;
  return { data, channels, curves, opposite };
}
