/** How the recording is read, where its file does not say or says it wrongly. */
import { useSignal } from "@preact/signals";
import type { JSX, TargetedEvent } from "preact";
import { explain } from "../server/api";
import type { Session } from "../session";

const UNITS = ["m", "cm", "mm", "inch", "cmu"];
const AXES = ["x", "y", "z", "-x", "-y", "-z"];

export function ReadingPanel({ session }: { session: Session }): JSX.Element | null {
  const recording = session.store.recording.value;
  const busy = useSignal(false);
  if (!recording) return null;
  const { id, reading } = recording;
  const said = (name: string): string => String(reading[name] ?? "");
  const read = async (event: TargetedEvent<HTMLFormElement, Event>): Promise<void> => {
    event.preventDefault();
    const form = new FormData(event.currentTarget);
    const text = (name: string): string => String(form.get(name) ?? "").trim();
    const request = {
      person: text("person"),
      fps: Number(text("fps")) || 0,
      unit: text("unit"),
      up: text("up"),
    };
    busy.value = true;
    try {
      await session.api.readAs(id, request);
      session.bulletin.solved("reading");
      session.close(id);
      await session.open(id);
    } catch (error) {
      session.bulletin.problem(explain(error), "reading");
    }
    busy.value = false;
  };
  return (
    <details class="reading-panel" key={id} open={Object.keys(reading).length > 0}>
      <summary>How this file is read</summary>
      <form onSubmit={(event) => void read(event)}>
        <label class="field" title="Which of several people, by name or number">
          <span>Person</span>
          <input type="text" name="person" placeholder="the first" defaultValue={said("person")} />
        </label>
        <label class="field">
          <span>Frames per second</span>
          <input
            type="number"
            name="fps"
            min="0"
            step="any"
            placeholder="as the file says"
            defaultValue={said("fps")}
          />
        </label>
        <div class="pair">
          <Choice name="unit" title="Unit" values={UNITS} value={said("unit")} />
          <Choice name="up" title="Up" values={AXES} value={said("up")} />
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
}): JSX.Element {
  const { name, title, values, value } = props;
  return (
    <label class="field">
      <span>{title}</span>
      <select name={name} defaultValue={value}>
        <option value="">as found</option>
        {values.map((each) => (
          <option key={each} value={each} selected={each === value}>
            {each}
          </option>
        ))}
      </select>
    </label>
  );
}
