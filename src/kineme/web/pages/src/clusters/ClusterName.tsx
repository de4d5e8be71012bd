/** The name of a cluster in the list; where edit are possible, a double click or F2 changes it. */
import { useSignal } from "@preact/signals";
import { useLayoutEffect, useRef } from "preact/hooks";
import type { JSX } from "preact";
import { useStore } from "../context";
import { clusterColor } from "../colors";
import { NameInput } from "../layout/NameInput";
import type { Cluster } from "../segments";
import { Button } from "../layout/controls";

export function ClusterName({ cluster }: { cluster: Cluster }): JSX.Element {
  const store = useStore();
  const { id, label } = cluster;
  const naming = useSignal(false);
  const field = useRef<HTMLInputElement>(null);
  const edit = store.edit.value;
  useLayoutEffect(() => {
    if (naming.value) field.current?.select();
  }, [naming.value]);
  if (naming.value && edit)
    return (
      <NameInput
        field={field}
        value={label}
        label={`Name of cluster ${id}`}
        onName={(name) => edit({ kind: "name_cluster", cluster: id, label: name })}
        onDone={() => (naming.value = false)}
      />
    );
  const begin = (): void => void (naming.value = edit !== null);
  return (
    <Button
      class="plain"
      aria-pressed={store.cluster.value === id}
      title={edit ? "Double click or F2 to name it" : undefined}
      onDblClick={begin}
      onKeyDown={(event) => event.key === "F2" && begin()}
    >
      <span class="swatch" style={{ background: clusterColor(id) }} />
      <span class="cluster-name">{label || `cluster ${id}`}</span>
      {store.present.value?.cluster === id && <span class="now" title="At the playhead" />}
    </Button>
  );
}
