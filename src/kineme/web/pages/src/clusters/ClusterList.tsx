/** Every cluster with its colour, how often it occurs and how long it lasts; else the labels. */
import type { JSX } from "preact";
import { useStore } from "../context";
import { clusterColor, NO_COLOR } from "../colors";
import type { Segment } from "../messages";
import { labelsOf, type Cluster } from "../segments";
import { clock } from "../view";
import { ClusterName } from "./ClusterName";
import { Button } from "../layout/controls";

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
          <Row key={cluster.id} cluster={cluster} most={most} />
        ))}
      </tbody>
    </table>
  );
}

function Head({ first }: { first: string }): JSX.Element {
  return (
    <thead>
      <tr>
        <th scope="col">{first}</th>
        <th scope="col">Count</th>
        <th scope="col" title="Mean duration of one, seconds">
          Mean
        </th>
        <th scope="col" title="All of them together">
          Total
        </th>
      </tr>
    </thead>
  );
}

interface RowProps {
  cluster: Cluster;
  most: number;
}

function Row({ cluster, most }: RowProps): JSX.Element {
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
      <Counts color={clusterColor(id)} {...{ count: members.length, most, mean_s, total_s }} />
    </tr>
  );
}

function Counts(props: {
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
      <td class="number">{clock(total_s, total_s < 60 ? 1 : 0)}</td>
    </>
  );
}

/** The labels of a table that has no clusters: somebody named what happens, nobody grouped it. */
function LabelList(): JSX.Element {
  const store = useStore();
  const { primitives, activities } = store;
  const lane = primitives.value.some((each) => each.label) ? primitives : activities;
  const labels = labelsOf(lane.value);
  if (!labels.length)
    return <p class="empty quiet">Nothing repeats itself here: there are no clusters.</p>;
  const most = Math.max(...labels.map(({ count }) => count));
  const go = (label: string): void => {
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
            <tr key={label} onClick={() => go(label)}>
              <th scope="row">
                <Button class="plain" title="Go to the next one">
                  <span class="swatch" style={{ background: color }} />
                  <span class="cluster-name">{label}</span>
                </Button>
              </th>
              <Counts {...{ color, count, most, mean_s: total_s / count, total_s }} />
            </tr>
          );
        })}
      </tbody>
    </table>
  );
}
