/** Show the clusters and the curves of the selected one. */
import { Curves } from "./Curves";
import { useSignal } from "@preact/signals";
import { useStore, type Store } from "../store";
import { countLabels, type Cluster } from "../segments";
import { getClusterColor, NO_COLOR } from "../colors";
import type { Segment } from "../messages";
import { formatTime } from "../view";
import { Button, NameInput, Swatch } from "../layout/controls";
import { useLayoutEffect, useRef } from "preact/hooks";
import { Table, type Row } from "../layout/tables";

export function Clusters() {
  return (
    <div class="cluster-panel">
      <div>
        <ClusterTools />
        <ClusterList />
      </div>
      <div>
        <Curves />
      </div>
    </div>
  );
}

const ORDERS: readonly (readonly [string, (a: Cluster, b: Cluster) => number])[] = [
  ["first seen first", (a, b) => a.members[0]!.start_frame - b.members[0]!.start_frame],
  ["most seconds first", (a, b) => b.total_s - a.total_s],
  ["most repetitions first", (a, b) => b.members.length - a.members.length],
  ["by name", (a, b) => (a.label || "\uffff").localeCompare(b.label || "\uffff") || a.id - b.id],
];

/** Renumber clusters or merge two of them. */
function ClusterTools() {
  const store = useStore();
  const edit = store.edit.value;
  const clusters = store.clusters.value;
  const shown = store.shownCluster.value;
  if (!edit || clusters.length < 2) return null;
  const applyOrder = (name: string): void => {
    const by = ORDERS.find(([each]) => each === name)?.[1];
    const order = by && orderAllClusters(store, clusters.slice().sort(by));
    if (order) edit({ kind: "order_clusters", order });
  };
  return (
    <div class="cluster-tools">
      <ActionSelect
        label="Number the clusters anew"
        title="Number anew…"
        options={ORDERS.map(([name]) => [name, name])}
        onSelect={applyOrder}
      />
      {shown && (
        <ActionSelect
          label={`Merge cluster ${shown.id} into another`}
          title={`Merge ${shown.label || shown.id} into…`}
          options={clusters
            .filter(({ id }) => id !== shown.id)
            .map(({ id, label }) => [String(id), label || `cluster ${id}`])}
          onSelect={(id) => edit({ kind: "merge_clusters", cluster: shown.id, into: Number(id) })}
        />
      )}
    </div>
  );
}

/** Select a value for one action; afterwards the title is shown again. */
function ActionSelect(props: {
  label: string;
  title: string;
  options: readonly (readonly [value: string, text: string])[];
  onSelect: (value: string) => void;
}) {
  const { label, title, options, onSelect } = props;
  return (
    <select
      aria-label={label}
      value=""
      onChange={({ currentTarget }) => {
        const { value } = currentTarget;
        currentTarget.value = "";
        onSelect(value);
      }}
    >
      <option value="">{title}</option>
      {options.map(([value, text]) => (
        <option key={value} value={value}>
          {text}
        </option>
      ))}
    </select>
  );
}

/** Return all cluster numbers of the table; clusters that only activities have come last. */
function orderAllClusters(store: Store, ordered: readonly Cluster[]): number[] {
  const rows = store.recording.value?.segmentation.segments ?? [];
  const others = [...new Set(rows.map((row) => row.cluster))].filter((each) => each >= 0);
  return [...new Set([...ordered.map(({ id }) => id), ...others.sort((a, b) => a - b)])];
}

/** List the clusters with count and duration; without clusters, the labels. */
function ClusterList() {
  const store = useStore();
  const clusters = store.clusters.value;
  if (clusters.length === 0) return <LabelList />;
  const rows = clusters.map((cluster) => {
    const { id, members, mean_s, total_s } = cluster;
    return {
      ...{ id, count: members.length, mean_s, total_s },
      color: getClusterColor(id),
      head: <ClusterName cluster={cluster} />,
      class: store.cluster.value === id ? "shown" : "",
      onPointerEnter: () => void (store.hovered.value = id),
      onPointerLeave: () => void (store.hovered.value = null),
      onClick: () => store.selectCluster(id),
    };
  });
  return <CountTable first="Cluster" rows={rows} />;
}

/** List the labels of a table without clusters. */
function LabelList() {
  const store = useStore();
  const { primitives, activities } = store;
  const lane = primitives.value.some((each) => each.label) ? primitives : activities;
  const labels = countLabels(lane.value);
  if (!labels.length)
    return <p class="empty quiet">Nothing repeats itself here: there are no clusters.</p>;
  const selectNext = (label: string): void => {
    const next = (each: Segment): boolean => each.label === label;
    const later = lane.value.find((each) => next(each) && each.start_frame > store.frame.value);
    const target = later ?? lane.value.find(next);
    if (target) store.select(target);
  };
  const rows = labels.map(({ label, count, total_s }) => {
    const color = store.labelColors.value.get(label) ?? NO_COLOR;
    const head = (
      <Button class="plain" title="Go to the next one">
        <Swatch color={color} />
        <span class="cluster-name">{label}</span>
      </Button>
    );
    const mean_s = total_s / count;
    return { id: label, color, head, count, mean_s, total_s, onClick: () => selectNext(label) };
  });
  return <CountTable first="Label" rows={rows} />;
}

interface CountRow extends Pick<Cluster, "mean_s" | "total_s">, Pick<Row, "head" | "onClick"> {
  id: string | number;
  color: string;
  count: number;
}

/** Show how often each cluster or label occurs, and how long. */
function CountTable({ first, rows }: { first: string; rows: readonly CountRow[] }) {
  const most = Math.max(...rows.map(({ count }) => count));
  return (
    <Table
      class="clusters number"
      columns={[
        first,
        "Count",
        ["Mean", "Mean duration of one, seconds"],
        ["Total", "All of them together"],
      ]}
      rows={rows.map(({ id, color, count, mean_s, total_s, ...row }) => ({
        ...row,
        key: id,
        cells: [
          <span class="count">
            <span class="bar" style={{ width: `${(40 * count) / most}px`, background: color }} />
            {count}
          </span>,
          `${mean_s.toFixed(2)} s`,
          formatTime(total_s, total_s < 60 ? 1 : 0),
        ],
      }))}
    />
  );
}

/** Show a cluster's name; double click or F2 edits it if the page allows edits. */
function ClusterName({ cluster }: { cluster: Cluster }) {
  const store = useStore();
  const { id, label } = cluster;
  const isNaming = useSignal(false);
  const field = useRef<HTMLInputElement>(null);
  const edit = store.edit.value;
  useLayoutEffect(() => {
    if (isNaming.value) field.current?.select();
  }, [isNaming.value]);
  if (isNaming.value && edit)
    return (
      <NameInput
        field={field}
        value={label}
        aria-label={`Name of cluster ${id}`}
        onName={(name) => edit({ kind: "name_cluster", cluster: id, label: name })}
        onDone={() => (isNaming.value = false)}
      />
    );
  const startNaming = (): void => void (isNaming.value = edit !== null);
  return (
    <Button
      class="plain"
      aria-pressed={store.cluster.value === id}
      title={edit ? "Double click or F2 to name it" : undefined}
      onDblClick={startNaming}
      onKeyDown={(event) => event.key === "F2" && startNaming()}
    >
      <Swatch color={getClusterColor(id)} />
      <span class="cluster-name">{label || `cluster ${id}`}</span>
      {store.present.value?.cluster === id && <span class="now" title="At the playhead" />}
    </Button>
  );
}
