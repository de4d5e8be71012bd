/** Show the clusters and the curves of the selected one. */
import type { JSX } from "preact";
import { ClusterList } from "./ClusterList";
import { ClusterTools } from "./ClusterTools";
import { Curves } from "./Curves";

export function Clusters(): JSX.Element {
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
