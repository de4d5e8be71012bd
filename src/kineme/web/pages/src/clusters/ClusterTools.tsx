/** Renumber clusters or merge two of them. */
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useStore } from "../context";
import type { Cluster } from "../segments";
import type { Store } from "../store";

const ORDERS: readonly (readonly [string, (a: Cluster, b: Cluster) => number])[] = [
  ["first seen first", (a, b) => a.members[0]!.start_frame - b.members[0]!.start_frame],
  ["most seconds first", (a, b) => b.total_s - a.total_s],
  ["most repetitions first", (a, b) => b.members.length - a.members.length],
  ["by name", (a, b) => (a.label || "\uffff").localeCompare(b.label || "\uffff") || a.id - b.id],
];

export function ClusterTools(): JSX.Element | null {
  const store = useStore();
  const into = useSignal("");
  const edit = store.edit.value;
  const clusters = store.clusters.value;
  const shown = store.shownCluster.value;
  if (!edit || clusters.length < 2) return null;
  const applyOrder = (name: string): void => {
    const by = ORDERS.find(([each]) => each === name)?.[1];
    if (by)
      edit({
        kind: "order_clusters",
        order: [...orderAllClusters(store, clusters.slice().sort(by))],
      });
  };
  return (
    <div class="cluster-tools">
      <select
        aria-label="Number the clusters anew"
        value=""
        onChange={(event) => {
          applyOrder(event.currentTarget.value);
          event.currentTarget.value = "";
        }}
      >
        <option value="">Number anew…</option>
        {ORDERS.map(([name]) => (
          <option key={name} value={name}>
            {name}
          </option>
        ))}
      </select>
      {shown && (
        <select
          aria-label={`Merge cluster ${shown.id} into another`}
          value={into.value}
          onChange={(event) => {
            const target = Number(event.currentTarget.value);
            event.currentTarget.value = "";
            edit({ kind: "merge_clusters", cluster: shown.id, into: target });
          }}
        >
          <option value="">Merge {shown.label || shown.id} into…</option>
          {clusters
            .filter(({ id }) => id !== shown.id)
            .map(({ id, label }) => (
              <option key={id} value={id}>
                {label || `cluster ${id}`}
              </option>
            ))}
        </select>
      )}
    </div>
  );
}

/** Return all cluster numbers of the table; clusters that only activities have come last. */
function orderAllClusters(store: Store, ordered: readonly Cluster[]): Set<number> {
  const rows = store.recording.value?.segmentation.segments ?? [];
  const others = [...new Set(rows.map((row) => row.cluster))].filter((each) => each >= 0);
  return new Set([...ordered.map(({ id }) => id), ...others.sort((a, b) => a - b)]);
}
