/** Another recording of the page, whose mean curve is drawn with that of the same movement here. */
import type { JSX } from "preact";
import type { ClusterCurves } from "../messages";
import type { OpenRecording } from "../opened";
import type { Store } from "../store";
import { Select } from "../layout/controls";

/** What is drawn of it, or why nothing is. */
export function whatIsBeside(
  store: Store,
  other: OpenRecording,
  { beside, channel }: ClusterCurves,
): string {
  const { name } = other.recording.value;
  if (beside)
    return `; ${name} (dashed): ${beside.n} of ${beside.total}; a bar where they differ (95 %)`;
  const { label } = store.shownCluster.value ?? store.clusters.value[0] ?? {};
  if (!label) return `; name this movement alike in both to see that of ${name}`;
  return `; ${name} has no “${label}”, or no ${channel}`;
}

/** The other recordings of the page. */
export function othersOf(store: Store): readonly OpenRecording[] {
  return store.opened.value.filter((each) => each !== store.active.value);
}

export function idOf({ recording }: OpenRecording): string {
  return recording.value.id;
}

interface Choice {
  others: readonly OpenRecording[];
  /** Empty: none. */
  id: string;
  choose: (id: string) => void;
}

/** Which of them it is; nothing where there is none. */
export function BesideSelect({ others, id, choose }: Choice): JSX.Element | null {
  if (!others.length) return null;
  return (
    <div class="curve-choice">
      <span class="quiet">Beside</span>
      <Select
        label="Beside"
        value={id}
        options={[
          ["", "no other recording"],
          ...others.map((each) => [idOf(each), each.recording.value.name] as const),
        ]}
        onSelect={choose}
      />
    </div>
  );
}
