/** Choose whose labels to compare; all by default. */
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect } from "preact/hooks";
import { useStudio } from "../context";
import { formatCount } from "../../formatCount";
import type { AnnotatorChoice } from "../../messages";
import { Button, Checkbox, toggleMember } from "../../layout/controls";

const TABLES_HERE = "tables"; // id of the tables edited here

export function PeopleChoice({ close }: { close: () => void }): JSX.Element {
  const { session, view } = useStudio();
  const people = useSignal<AnnotatorChoice[]>([]);
  const ticked = useSignal<ReadonlySet<string>>(new Set());
  const busy = useSignal(false);
  useEffect(() => {
    void session.notifications.attempt("agreement", async () => {
      const found = await session.api.loadAnnotators();
      const others = found.filter(({ id }) => id !== TABLES_HERE);
      people.value = found;
      ticked.value = new Set((others.length > 1 ? others : found).map(({ id }) => id));
    });
  }, [session, people, ticked]);
  const compare = async (): Promise<void> => {
    busy.value = true;
    if (await session.people.compare([...ticked.value])) {
      view.tab.value = "compare";
      view.folder.value = null;
      close();
    }
    busy.value = false;
  };

  if (people.value.length < 2)
    return (
      <p class="quiet">
        None yet. Put the label files of each person into a folder of its own here (anna/walk.eaf),
        or their names behind that of the recording (walk.anna.eaf).
      </p>
    );
  return (
    <div class="choices">
      <fieldset class="people">
        {people.value.map(({ id, name, recordings }) => (
          <Checkbox
            key={id}
            checked={ticked.value.has(id)}
            onCheck={() => (ticked.value = toggleMember(ticked.value, id))}
          >
            {name} <span class="quiet">{formatCount(recordings, "recording")}</span>
          </Checkbox>
        ))}
      </fieldset>
      <Button
        class="primary"
        disabled={busy.value || ticked.value.size < 2}
        onClick={() => void compare()}
        busy={busy.value}
      >
        Compare {ticked.value.size} people
      </Button>
    </div>
  );
}
