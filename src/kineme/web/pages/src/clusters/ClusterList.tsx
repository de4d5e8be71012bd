/** Every cluster with its colour, how often it occurs and how long it lasts. */
import type { JSX } from "preact";
import { clusterColor } from "../colors";
import type { Cluster } from "../segments";
import type { Store } from "../store";
import { clock } from "../view";
import { ClusterName } from "./ClusterName";

export function ClusterList({ store }: { store: Store }): JSX.Element {
  const clusters = store.clusters.value;
  if (clusters.length === 0)
    return <p class="empty quiet">Nothing repeats itself here: there are no clusters.</p>;
  const most = Math.max(...clusters.map((cluster) => cluster.members.length));
  return (
    <table class="clusters">
      <thead>
        <tr>
          <th scope="col">Cluster</th>
          <th scope="col">Count</th>
          <th scope="col" title="Mean duration of a member, seconds">
            Mean
          </th>
          <th scope="col" title="All members together">
            Total
          </th>
        </tr>
      </thead>
      <tbody onPointerLeave={() => (store.hovered.value = null)}>
        {clusters.map((cluster) => (
          <Row key={cluster.id} cluster={cluster} store={store} most={most} />
        ))}
      </tbody>
    </table>
  );
}

interface RowProps {
  cluster: Cluster;
  store: Store;
  most: number;
}

function Row({ cluster, store, most }: RowProps): JSX.Element {
  const { id, members, mean_s, total_s } = cluster;
  const color = clusterColor(id);
  const shown = store.cluster.value === id;
  return (
    <tr
      class={shown ? "shown" : ""}
      onPointerEnter={() => (store.hovered.value = id)}
      onClick={() => store.selectCluster(id)}
    >
      <th scope="row">
        <ClusterName cluster={cluster} store={store} />
      </th>
      <td class="number count">
        <span
          class="bar"
          style={{ width: `${(40 * members.length) / most}px`, background: color }}
        />
        {members.length}
      </td>
      <td class="number">{mean_s.toFixed(2)} s</td>
      <td class="number">{clock(total_s, total_s < 60 ? 1 : 0)}</td>
    </tr>
  );
}
