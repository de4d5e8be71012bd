/** Select another open recording whose mean curve is drawn for comparison. */
import type { JSX } from "preact";
import type { ClusterCurves } from "../messages";
import type { OpenRecording } from "../openRecording";
import type { Store } from "../store";
import { Select } from "../layout/controls";

/** Describe the other recording's curve, or why it has none. */
export function describeComparison(
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

/** Return the open recordings except the active one. */
export function getOtherRecordings(store: Store): readonly OpenRecording[] {
  return store.opened.value.filter((each) => each !== store.active.value);
}

export function getId({ recording }: OpenRecording): string {
  return recording.value.id;
}

interface ComparisonSelectProps {
  others: readonly OpenRecording[];
  /** Id of the selected recording; empty for none. */
  id: string;
  onChoose: (id: string) => void;
}

export function ComparisonSelect({
  others,
  id,
  onChoose,
}: ComparisonSelectProps): JSX.Element | null {
  if (!others.length) return null;
  return (
    <div class="curve-choice">
      <span class="quiet">Beside</span>
      <Select
        label="Beside"
        value={id}
        options={[
          ["", "no other recording"],
          ...others.map((each) => [getId(each), each.recording.value.name] as const),
        ]}
        onSelect={onChoose}
      />
    </div>
  );
}
