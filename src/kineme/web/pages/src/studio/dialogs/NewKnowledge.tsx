/** Create a knowledge base from recordings with named segments. */
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect } from "preact/hooks";
import { useStudio } from "../context";
import { Checkbox, toggleMember, TextInput } from "../../layout/controls";

export function NewKnowledge(): JSX.Element {
  const { session } = useStudio();
  const named = (session.state.value?.recordings ?? []).filter((each) => each.named > 0);
  const excluded = useSignal<ReadonlySet<string>>(new Set());
  const name = useSignal("moves");
  const busy = useSignal(false);
  useEffect(() => void session.refresh(), [session]); // names may have been added
  const makeKnowledge = async (event: Event): Promise<void> => {
    event.preventDefault();
    busy.value = true;
    await session.notifications.attempt("knowledge", async () => {
      const recordings = named.map(({ id }) => id).filter((id) => !excluded.value.has(id));
      const made = await session.api.makeKnowledge({ name: name.value.trim(), recordings });
      session.notifications.tell(
        `${made.name} is in the folder: other recordings can take its names.`,
      );
      await session.refresh();
    });
    busy.value = false;
  };
  return (
    <form class="new-knowledge" onSubmit={(event) => void makeKnowledge(event)}>
      <h2>Make a knowledge base of recordings with names</h2>
      {named.length === 0 && <p class="quiet">No recording of the folder has names yet.</p>}
      <div class="choices">
        {named.map(({ id, name: title, named: count }) => (
          <Checkbox
            key={id}
            checked={!excluded.value.has(id)}
            onCheck={() => (excluded.value = toggleMember(excluded.value, id))}
          >
            {title} <span class="quiet">{count}</span>
          </Checkbox>
        ))}
      </div>
      <p class="actions">
        <TextInput aria-label="Name of the knowledge base" value={name} />
        <button type="submit" disabled={busy.value || !name.value.trim() || !named.length}>
          Make it {busy.value && <span class="busy" />}
        </button>
      </p>
    </form>
  );
}
