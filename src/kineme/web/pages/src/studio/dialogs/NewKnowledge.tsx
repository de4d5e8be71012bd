/** A knowledge base of the recordings that have names. */
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect } from "preact/hooks";
import { useStudio } from "../context";
import { Checkbox, toggled } from "../../layout/controls";

export function NewKnowledge(): JSX.Element {
  const { session } = useStudio();
  const named = (session.state.value?.recordings ?? []).filter((each) => each.named > 0);
  const left = useSignal<ReadonlySet<string>>(new Set());
  const name = useSignal("moves");
  const busy = useSignal(false);
  useEffect(() => void session.refresh(), [session]); // names given since the page was opened
  const make = async (event: Event): Promise<void> => {
    event.preventDefault();
    busy.value = true;
    await session.bulletin.attempt("knowledge", async () => {
      const recordings = named.map(({ id }) => id).filter((id) => !left.value.has(id));
      const made = await session.api.makeKnowledge({ name: name.value.trim(), recordings });
      session.bulletin.tell(`${made.name} is in the folder: other recordings can take its names.`);
      await session.refresh();
    });
    busy.value = false;
  };
  return (
    <form class="new-knowledge" onSubmit={(event) => void make(event)}>
      <h2>Make a knowledge base of recordings with names</h2>
      {named.length === 0 && <p class="quiet">No recording of the folder has names yet.</p>}
      <div class="choices">
        {named.map(({ id, name: title, named: count }) => (
          <Checkbox
            key={id}
            checked={!left.value.has(id)}
            onCheck={() => (left.value = toggled(left.value, id))}
          >
            {title} <span class="quiet">{count}</span>
          </Checkbox>
        ))}
      </div>
      <p class="actions">
        <input
          type="text"
          aria-label="Name of the knowledge base"
          value={name.value}
          onInput={(event) => (name.value = event.currentTarget.value)}
        />
        <button type="submit" disabled={busy.value || !name.value.trim() || !named.length}>
          Make it {busy.value && <span class="busy" />}
        </button>
      </p>
    </form>
  );
}
