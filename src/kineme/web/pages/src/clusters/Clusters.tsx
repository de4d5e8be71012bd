/** The clusters, and the curves of the one that is looked at. */
import type { JSX } from "preact";
import type { Store } from "../store";
import { ClusterList } from "./ClusterList";
import { ClusterTools } from "./ClusterTools";
import { Curves } from "./Curves";

export function Clusters({ store }: { store: Store }): JSX.Element {
  return (
    <div class="cluster-panel">
      <div>
        <ClusterTools store={store} />
        <ClusterList store={store} />
      </div>
      <div>
        <Curves store={store} />
      </div>
    </div>
  );
}
