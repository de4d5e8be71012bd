/** Show the primitive at the playhead, with buttons to the other members of its cluster. */
import type { JSX } from "preact";
import { useStore } from "../context";
import { NO_COLOR } from "../colors";
import { getDuration, getSegmentName } from "../segments";
import { IconButton } from "../transport/icons";
import { getConfidences } from "../confidence";
import { formatTime } from "../view";
import { Swatch } from "../layout/controls";

export function CurrentSegment(): JSX.Element | null {
  const store = useStore();
  const segment = store.present.value;
  if (!segment) return null;
  const table = store.recording.value?.segmentation;
  const confidence = table && getConfidences(table).get(segment);
  const cluster = store.clusters.value.find((each) => each.id === segment.cluster);
  const members = cluster?.members ?? [];
  const at = members.indexOf(segment);
  const selectMember = (by: number): void => {
    const next = members[(at + by + members.length) % members.length];
    if (next) store.select(next);
  };
  return (
    <section class="present" aria-label="At the playhead">
      <p class="present-name">
        <Swatch color={store.getColor(segment) ?? NO_COLOR} />
        <b>{getSegmentName(segment)}</b>
        <span class="spacer" />
        {at >= 0 && (
          <>
            <span class="quiet number">
              {at + 1} of {members.length}
            </span>
            <IconButton icon="back" label="Member before" onClick={() => selectMember(-1)} />
            <IconButton icon="on" label="Next member" onClick={() => selectMember(1)} />
          </>
        )}
      </p>
      <p class="quiet number">
        {formatTime(segment.start_s, 2)} to {formatTime(segment.stop_s, 2)} ·{" "}
        {getDuration(segment).toFixed(2)} s
        {confidence?.text && <span title={confidence.why}> · {confidence.text}</span>}
      </p>
    </section>
  );
}
