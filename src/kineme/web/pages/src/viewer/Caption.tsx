/** Describe what is played, over the picture. */
import type { JSX } from "preact";
import { NO_COLOR } from "../colors";
import { useStore } from "../context";
import { formatCount } from "../formatCount";
import { formatPerson, type OpenRecording } from "../openRecording";
import { getSegmentName, findPrimitiveAt } from "../segments";
import { formatTime } from "../view";
import { MAX_MEMBERS } from "./placement";
import { Swatch } from "../layout/controls";

export function Caption(): JSX.Element {
  const store = useStore();
  const present = store.present.value;
  const shown = store.shownCluster.value;
  const stepping = store.inStep.value && shown;
  const people = stepping ? [] : store.people.value;
  const n = shown?.members.length ?? 0;
  const all = formatCount(n, "member");
  const count = n > MAX_MEMBERS ? `the first ${MAX_MEMBERS} of ${n} members` : all;
  return (
    <div class="caption">
      {people.map((each) => (
        <PersonCaption key={each.recording.value.id} opened={each} />
      ))}
      {present && !people.length && (
        <p>
          <Swatch color={store.getColor(present) ?? NO_COLOR} /> {getSegmentName(present)}
        </p>
      )}
      {store.ghost.value && !stepping && (
        <p class="quiet">
          ghost: {getSegmentName(store.ghost.value)} of {formatTime(store.ghost.value.start_s, 2)}
        </p>
      )}
      {stepping && <p class="quiet">{count} in step</p>}
      {!stepping && store.opened.value.length > Math.max(people.length, 1) && (
        <p class="quiet">
          {store.opened.value.map((each) => each.recording.value.name).join(" · ")}
        </p>
      )}
    </div>
  );
}

/** Show the primitive of one of several people; the active one's name is bold. */
function PersonCaption({ opened }: { opened: OpenRecording }): JSX.Element {
  const store = useStore();
  const { person, name, segmentation } = opened.recording.value;
  const present = findPrimitiveAt(segmentation, store.playhead.value);
  const called = formatPerson(person ?? name);
  return (
    <p>
      <Swatch color={(present && store.getColor(present)) ?? NO_COLOR} />{" "}
      {opened === store.active.value ? <strong>{called}</strong> : called}{" "}
      <span class="quiet">{present && getSegmentName(present)}</span>
    </p>
  );
}
