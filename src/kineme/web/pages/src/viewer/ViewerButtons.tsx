/** Offer the viewer's options. */
import type { Signal } from "@preact/signals";
import type { JSX } from "preact";
import { useStore } from "../context";
import type { Store } from "../store";
import { Button } from "../layout/controls";

export function ViewerButtons({ onFrame }: { onFrame: () => void }): JSX.Element {
  const store = useStore();
  return (
    <div class="viewer-buttons">
      <Toggle on={store.follow} title="The camera follows the figure">
        Follow
      </Toggle>
      <Toggle on={store.trails} title="The last paths of hands and feet">
        Trails
      </Toggle>
      <Toggle
        on={store.inStep}
        title="All members of the selected cluster, playing in step"
        disabled={store.clusters.value.length === 0 || !store.active.value?.motion.value}
        onBeforeToggle={() => store.cluster.value ?? store.selectCluster(getCurrentCluster(store))}
      >
        In step
      </Toggle>
      <Button
        aria-pressed={store.ghost.value !== null}
        title="Keep the repetition at the playhead as a ghost, and lay it over the others (V)"
        disabled={!store.present.value || !store.active.value?.motion.value}
        onClick={() => store.toggleGhost()}
      >
        Ghost
      </Button>
      <Button onClick={onFrame} title="Put the camera where everything is seen">
        Reset view
      </Button>
    </div>
  );
}

interface ToggleProps {
  on: Signal<boolean>;
  title: string;
  disabled?: boolean;
  /** Called before the signal changes. */
  onBeforeToggle?: () => unknown;
  children: string;
}

function Toggle({
  on,
  title,
  disabled = false,
  onBeforeToggle,
  children,
}: ToggleProps): JSX.Element {
  return (
    <Button
      aria-pressed={on.value}
      title={title}
      disabled={disabled}
      onClick={() => {
        onBeforeToggle?.();
        on.value = !on.value;
      }}
    >
      {children}
    </Button>
  );
}

/** Return the cluster at the playhead, else the first. */
function getCurrentCluster(store: Store): number {
  const present = store.present.value?.cluster ?? -1;
  return present >= 0 ? present : (store.clusters.value[0]?.id ?? 0);
}
