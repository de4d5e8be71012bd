/** What is played, in words over the picture. */
import type { JSX } from "preact";
import { NO_COLOR } from "../colors";
import { useStore } from "../context";
import { counted } from "../counted";
import { personCalled, type OpenRecording } from "../opened";
import { nameOf, primitiveAt } from "../segments";
import { clock } from "../view";
import { MOST_MEMBERS } from "./placement";

/** What is played: the primitive under the playhead, of each person, and which cluster is shown. */
export function Caption(): JSX.Element {
  const store = useStore();
  const present = store.present.value;
  const shown = store.shownCluster.value;
  const stepping = store.inStep.value && shown;
  const people = stepping ? [] : store.people.value;
  const n = shown?.members.length ?? 0;
  const all = counted(n, "member");
  const count = n > MOST_MEMBERS ? `the first ${MOST_MEMBERS} of ${n} members` : all;
  return (
    <div class="caption">
      {people.map((each) => (
        <PersonPresent key={each.recording.value.id} opened={each} />
      ))}
      {present && !people.length && (
        <p>
          <span class="swatch" style={{ background: store.colorOf(present) ?? NO_COLOR }} />{" "}
          {nameOf(present)}
        </p>
      )}
      {store.ghost.value && !stepping && (
        <p class="quiet">
          ghost: {nameOf(store.ghost.value)} of {clock(store.ghost.value.start_s, 2)}
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

/** The primitive of one of several people at the playhead; the name of the one in front is bold. */
function PersonPresent({ opened }: { opened: OpenRecording }): JSX.Element {
  const store = useStore();
  const { person, name, segmentation } = opened.recording.value;
  const present = primitiveAt(segmentation, store.playhead.value);
  const called = personCalled(person ?? name);
  return (
    <p>
      <span
        class="swatch"
        style={{ background: (present && store.colorOf(present)) ?? NO_COLOR }}
      />{" "}
      {opened === store.active.value ? <strong>{called}</strong> : called}{" "}
      <span class="quiet">{present && nameOf(present)}</span>
    </p>
  );
}
