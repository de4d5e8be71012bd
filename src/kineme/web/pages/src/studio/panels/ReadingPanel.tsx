/** Set how a recording is read where its file does not say or is wrong. */
import { useRef } from "preact/hooks";
import type { TargetedEvent } from "preact";
import { formatPerson } from "../../recordingData";
import { useStudio } from "../context";
import { Button, Field, useBusy } from "../../layout/controls";
import type { ReadRequest } from "../../messages";

const UNITS = ["m", "cm", "mm", "inch", "cmu"];
const AXES = ["x", "y", "z", "-x", "-y", "-z"];

export function ReadingPanel() {
  const { session } = useStudio();
  const { value: recording } = session.store.recording;
  const { value: unread } = session.unread;
  const form = useRef<HTMLFormElement>(null);
  const [busy, run] = useBusy();
  const id = unread?.id ?? recording?.id;
  const known = (!unread && recording?.read_options) || {};
  const takes = (!unread && recording?.takes) || [];
  const people = unread ? unread.people : (recording?.people ?? []);
  const shown = unread ? [] : session.store.people.value;
  const getOption = (name: string): string => {
    const value = known[name];
    return typeof value === "string" || typeof value === "number" ? String(value) : "";
  };
  const person = unread ? "" : (recording?.person ?? getOption("person"));
  if (!id) return null;
  const isOpen =
    unread !== null || Object.keys(known).length > 0 || takes.length > 1 || people.length > 0;
  const read = (chosen = person, everybody = false): Promise<void> => {
    const fields = Object.fromEntries(new FormData(form.current!)) as Record<string, string>;
    const given = {
      ...fields, // named as the options
      fps: Number(fields["fps"]),
      person: people.length ? chosen : fields["person"]?.trim(),
    };
    const stated = Object.entries(given).filter(([, value]) => value);
    const options = Object.fromEntries(stated) as ReadRequest["options"];
    return run("reading", () => session.readAs(id, { options, everybody }));
  };
  return (
    <details class="reading-panel" key={`${id} ${unread !== null}`} open={isOpen}>
      <summary>How {unread ? unread.name : "this file"} is read</summary>
      <form
        ref={form}
        onSubmit={(event) => {
          event.preventDefault();
          void read();
        }}
      >
        {people.length > 0 ? (
          <PersonButtons
            names={people}
            shown={shown.length ? shown.map((each) => each.recording.value.person ?? "") : [person]}
            question={unread !== null}
            read={read}
          />
        ) : (
          <Field title="Person" tooltip="Which of several people, by name or number">
            <input type="text" name="person" placeholder="the only one" defaultValue={person} />
          </Field>
        )}
        {takes.length > 1 && (
          <OptionSelect
            name="take"
            title={`Take, one of ${takes.length}`}
            none={null}
            values={takes}
            value={recording?.take ?? ""}
            onChange={(event) => event.currentTarget.form?.requestSubmit()}
          />
        )}
        <Field title="Frames per second">
          <input
            type="number"
            name="fps"
            min="0"
            step="any"
            placeholder="as the file says"
            defaultValue={getOption("fps")}
          />
        </Field>
        <div class="pair">
          <OptionSelect name="unit" title="Unit" values={UNITS} value={getOption("unit")} />
          <OptionSelect name="up" title="Up" values={AXES} value={getOption("up")} />
        </div>
        {!(unread && people.length > 0) && (
          <p class="actions">
            <Button
              type="submit"
              disabled={busy !== ""}
              busy={busy !== ""}
              title="Tables are made anew; those before are kept in History"
            >
              Read again
            </Button>
          </p>
        )}
      </form>
    </details>
  );
}

/** Choose one person of the file, or all. */
function PersonButtons(props: {
  names: readonly string[];
  shown: readonly string[];
  /** Whether no person is chosen yet. */
  question: boolean;
  read: (person?: string, everybody?: boolean) => Promise<void>;
}) {
  const { names, shown, question, read } = props;
  const { session } = useStudio();
  const all = shown.length === names.length;
  return (
    <fieldset class="people-choice">
      <legend>{question ? "Who is to be seen?" : "People in this file"}</legend>
      {names.map((name) => (
        <Button
          key={name}
          aria-pressed={shown.includes(name)}
          title={`Show ${formatPerson(name)} alone: each has a table of their own`}
          onClick={() => void read(name)}
        >
          {formatPerson(name)}
        </Button>
      ))}
      {names.length > 1 && !session.state.value?.of_library && (
        <Button
          class={question ? "primary" : ""}
          aria-pressed={all}
          title="Show all of them together, in the same time and space"
          onClick={() => void read(undefined, true)}
        >
          All {names.length} people
        </Button>
      )}
    </fieldset>
  );
}

function OptionSelect(props: {
  name: string;
  title: string;
  values: readonly string[];
  value: string;
  /** Text for no choice; null if one is required. */
  none?: string | null;
  onChange?: (event: TargetedEvent<HTMLSelectElement, Event>) => void;
}) {
  const { name, title, values, value, none = "as found" } = props;
  return (
    <Field title={title}>
      <select name={name} defaultValue={value} onChange={props.onChange}>
        {none !== null && <option value="">{none}</option>}
        {values.map((each) => (
          <option key={each} value={each} selected={each === value}>
            {each}
          </option>
        ))}
      </select>
    </Field>
  );
}
