/** Edit the labels that all recordings share; the first nine have the keys 1 to 9. */
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useStudio } from "../context";
import { Button, CloseButton, TextInput } from "../../layout/controls";

const KEYS = 9;

export function SharedLabels(): JSX.Element {
  const { session, editor } = useStudio();
  const labels = session.state.value?.labels ?? [];
  const name = useSignal("");
  const saveLabels = (next: string[]): Promise<boolean> =>
    session.notifications.attempt("labels", async () => {
      await session.api.shareLabels({ labels: next });
      await session.refresh();
    });
  return (
    <section class="vocabulary" aria-label="Shared labels">
      <h2>Labels of the folder</h2>
      <div class="choices">
        {labels.map((label, i) => (
          <span class="group" key={label}>
            <Button
              title={
                i < KEYS ? `Name the segment “${label}” (${i + 1})` : `Name the segment “${label}”`
              }
              onClick={() => editor.nameTarget(label)}
            >
              {i < KEYS && <kbd>{i + 1}</kbd>} {label}
            </Button>
            <CloseButton
              label={`Take “${label}” off the list`}
              onClick={() => void saveLabels(labels.filter((each) => each !== label))}
            />
          </span>
        ))}
      </div>
      <form
        onSubmit={(event) => {
          event.preventDefault();
          const label = name.value.trim();
          name.value = "";
          if (label) void saveLabels([...labels, label]);
        }}
      >
        <TextInput
          aria-label="A label for all recordings of the folder"
          placeholder={labels.length ? "one more label" : "a label for the key 1"}
          value={name}
          onKeyDown={(event) => event.key === "Escape" && event.currentTarget.blur()}
        />
        <button type="submit">Add</button>
      </form>
    </section>
  );
}
