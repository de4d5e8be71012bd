/** The primitive under the playhead, and the way to the others of its cluster. */
import type { JSX } from "preact";
import { useStore } from "../context";
import { NO_COLOR } from "../colors";
import { durationOf, nameOf } from "../segments";
import { IconButton } from "../transport/icons";
import { confidenceOf } from "../confidence";
import { clock } from "../view";

export function Present(): JSX.Element | null {
  const store = useStore();
  const segment = store.present.value;
  if (!segment) return null;
  const table = store.recording.value?.segmentation;
  const confidence = table && confidenceOf(table).get(segment);
  const cluster = store.clusters.value.find((each) => each.id === segment.cluster);
  const members = cluster?.members ?? [];
  const at = members.indexOf(segment);
  const go = (by: number): void => {
    const next = members[(at + by + members.length) % members.length];
    if (next) store.select(next);
  };
  return (
    <section class="present" aria-label="At the playhead">
      <p class="present-name">
        <span class="swatch" style={{ background: store.colorOf(segment) ?? NO_COLOR }} />
        <b>{nameOf(segment)}</b>
        <span class="spacer" />
        {at >= 0 && (
          <>
            <span class="quiet number">
              {at + 1} of {members.length}
            </span>
            <IconButton icon="back" label="Member before" onClick={() => go(-1)} />
            <IconButton icon="on" label="Next member" onClick={() => go(1)} />
          </>
        )}
      </p>
      <p class="quiet number">
        {clock(segment.start_s, 2)} to {clock(segment.stop_s, 2)} · {durationOf(segment).toFixed(2)}{" "}
        s{confidence?.text && <span title={confidence.why}> · {confidence.text}</span>}
      </p>
    </section>
  );
}
