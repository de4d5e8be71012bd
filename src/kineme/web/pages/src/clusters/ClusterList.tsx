/** List the clusters with count and duration; without clusters, the labels. */
import type { JSX } from "preact";
import { useStore } from "../context";
import { getClusterColor, NO_COLOR } from "../colors";
import type { Segment } from "../messages";
import { countLabels, type Cluster } from "../segments";
import { formatTime } from "../view";
import { ClusterName } from "./ClusterName";
import { Button, Swatch, TableHead } from "../layout/controls";

export function ClusterList(): JSX.Element {
  const store = useStore();
  const clusters = store.clusters.value;
  if (clusters.length === 0) return <LabelList />;
  const most = Math.max(...clusters.map((cluster) => cluster.members.length));
  return (
    <table class="clusters">
      <Head first="Cluster" />
      <tbody onPointerLeave={() => (store.hovered.value = null)}>
        {clusters.map((cluster) => (
          <ClusterRow key={cluster.id} cluster={cluster} most={most} />
        ))}
      </tbody>
    </table>
  );
}

function Head({ first }: { first: string }): JSX.Element {
  return (
    <TableHead
      columns={[
        first,
        "Count",
        ["Mean", "Mean duration of one, seconds"],
        ["Total", "All of them together"],
      ]}
    />
  );
}

interface RowProps {
  cluster: Cluster;
  most: number;
}

function ClusterRow({ cluster, most }: RowProps): JSX.Element {
  const store = useStore();
  const { id, members, mean_s, total_s } = cluster;
  const shown = store.cluster.value === id;
  return (
    <tr
      class={shown ? "shown" : ""}
      onPointerEnter={() => (store.hovered.value = id)}
      onClick={() => store.selectCluster(id)}
    >
      <th scope="row">
        <ClusterName cluster={cluster} />
      </th>
      <CountCells
        color={getClusterColor(id)}
        {...{ count: members.length, most, mean_s, total_s }}
      />
    </tr>
  );
}

function CountCells(props: {
  color: string;
  count: number;
  most: number;
  mean_s: number;
  total_s: number;
}): JSX.Element {
  const { color, count, most, mean_s, total_s } = props;
  return (
    <>
      <td class="number count">
        <span class="bar" style={{ width: `${(40 * count) / most}px`, background: color }} />
        {count}
      </td>
      <td class="number">{mean_s.toFixed(2)} s</td>
      <td class="number">{formatTime(total_s, total_s < 60 ? 1 : 0)}</td>
    </>
  );
}

/** List the labels of a table without clusters. */
function LabelList(): JSX.Element {
  const store = useStore();
  const { primitives, activities } = store;
  const lane = primitives.value.some((each) => each.label) ? primitives : activities;
  const labels = countLabels(lane.value);
  if (!labels.length)
    return <p class="empty quiet">Nothing repeats itself here: there are no clusters.</p>;
  const most = Math.max(...labels.map(({ count }) => count));
  const selectNext = (label: string): void => {
    const next = (each: Segment): boolean => each.label === label;
    const later = lane.value.find((each) => next(each) && each.start_frame > store.frame.value);
    const target = later ?? lane.value.find(next);
    if (target) store.select(target);
  };
  return (
    <table class="clusters">
      <Head first="Label" />
      <tbody>
        {labels.map(({ label, count, total_s }) => {
          const color = store.labelColors.value.get(label) ?? NO_COLOR;
          return (
            <tr key={label} onClick={() => selectNext(label)}>
              <th scope="row">
                <Button class="plain" title="Go to the next one">
                  <Swatch color={color} />
                  <span class="cluster-name">{label}</span>
                </Button>
              </th>
              <CountCells {...{ color, count, most, mean_s: total_s / count, total_s }} />
            </tr>
          );
        })}
      </tbody>
    </table>
  );
}
