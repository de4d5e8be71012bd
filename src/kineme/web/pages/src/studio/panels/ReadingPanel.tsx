/** How the recording is read, where its file does not say or says it wrongly. */
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import type { JSX, TargetedEvent } from "preact";
import { useStudio } from "../context";

const UNITS = ["m", "cm", "mm", "inch", "cmu"];
const AXES = ["x", "y", "z", "-x", "-y", "-z"];

export function ReadingPanel(): JSX.Element | null {
  const { session } = useStudio();
  const { value: recording } = session.store.recording;
  const { value: unread } = session.unread;
  const people = useSignal<readonly string[]>([]);
  const busy = useSignal(false);
  const id = unread?.id ?? recording?.id;
  const reading = (!unread && recording?.reading) || {};
  const takes = (!unread && recording?.takes) || [];
  const option = (name: string): string => {
    const value = reading[name];
    return typeof value === "string" || typeof value === "number" ? String(value) : "";
  };
  const person = option("person");
  useEffect(() => {
    people.value = unread?.people ?? [];
    if (!unread && id && person)
      void session.api.people(id).then(
        (found) => (people.value = found),
        () => undefined,
      );
  }, [id, unread, person, people, session]);
  if (!id) return null;
  const read = async (event: TargetedEvent<HTMLFormElement, Event>): Promise<void> => {
    event.preventDefault();
    const form = new FormData(event.currentTarget);
    const text = (name: string): string => {
      const value = form.get(name);
      return typeof value === "string" ? value.trim() : "";
    };
    busy.value = true;
    await session.readAs(id, {
      person: text("person"),
      take: text("take"),
      fps: Number(text("fps")) || 0,
      unit: text("unit"),
      up: text("up"),
    });
    busy.value = false;
  };
  return (
    <details
      class="reading-panel"
      key={`${id} ${unread !== null}`}
      open={unread !== null || Object.keys(reading).length > 0 || takes.length > 1}
    >
      <summary>How {unread ? unread.name : "this file"} is read</summary>
      <form onSubmit={(event) => void read(event)}>
        {takes.length > 1 && (
          <Choice
            name="take"
            title={`Take, one of ${takes.length}`}
            none={null}
            values={takes}
            value={recording?.take ?? ""}
            onChange={(event) => event.currentTarget.form?.requestSubmit()}
          />
        )}
        {people.value.length > 0 ? (
          <Choice
            name="person"
            title="Person"
            none={unread ? "choose one" : "the only one"}
            values={people.value}
            value={person}
          />
        ) : (
          <label class="field" title="Which of several people, by name or number">
            <span>Person</span>
            <input type="text" name="person" placeholder="the only one" defaultValue={person} />
          </label>
        )}
        <label class="field">
          <span>Frames per second</span>
          <input
            type="number"
            name="fps"
            min="0"
            step="any"
            placeholder="as the file says"
            defaultValue={option("fps")}
          />
        </label>
        <div class="pair">
          <Choice name="unit" title="Unit" values={UNITS} value={option("unit")} />
          <Choice name="up" title="Up" values={AXES} value={option("up")} />
        </div>
        <p class="actions">
          <button
            type="submit"
            disabled={busy.value}
            title="The table is made anew; the one before is kept in History"
          >
            Read again {busy.value && <span class="busy" />}
          </button>
        </p>
      </form>
    </details>
  );
}

function Choice(props: {
  name: string;
  title: string;
  values: readonly string[];
  value: string;
  /** What stands for no choice; null where one is to be made. */
  none?: string | null;
  onChange?: (event: TargetedEvent<HTMLSelectElement, Event>) => void;
}): JSX.Element {
  const { name, title, values, value, none = "as found" } = props;
  return (
    <label class="field">
      <span>{title}</span>
      <select name={name} defaultValue={value} onChange={props.onChange}>
        {none !== null && <option value="">{none}</option>}
        {values.map((each) => (
          <option key={each} value={each} selected={each === value}>
            {each}
          </option>
        ))}
      </select>
    </label>
  );
}
