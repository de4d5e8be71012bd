/** Show a cluster's name; double click or F2 edits it if the page allows edits. */
import { useSignal } from "@preact/signals";
import { useLayoutEffect, useRef } from "preact/hooks";
import type { JSX } from "preact";
import { useStore } from "../context";
import { getClusterColor } from "../colors";
import { NameInput } from "../layout/NameInput";
import type { Cluster } from "../segments";
import { Button, Swatch } from "../layout/controls";

export function ClusterName({ cluster }: { cluster: Cluster }): JSX.Element {
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
        label={`Name of cluster ${id}`}
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
