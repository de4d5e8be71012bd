/** Transfer labels from a knowledge base of the folder. */
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect } from "preact/hooks";
import { useStudio } from "../context";
import { Dialog, type DialogProps } from "./Dialog";
import { NewKnowledge } from "./NewKnowledge";
import { Checkbox, Select, TextInput } from "../../layout/controls";

export function TransferDialog({ close }: DialogProps): JSX.Element {
  const { session } = useStudio();
  const bases = session.state.value?.knowledge_bases ?? [];
  const chosen = useSignal("");
  const base = chosen.value || (bases[0]?.id ?? "");
  const threshold = useSignal("");
  useEffect(() => void session.refresh(), [session]); // files may have been added
  const spread = useSignal(true);
  const transfer = (event: Event): void => {
    event.preventDefault();
    const limit = Number.parseFloat(threshold.value);
    void session.edited.value?.edit({
      kind: "transfer",
      knowledge_base: base,
      spread: spread.value,
      ...(Number.isFinite(limit) && { threshold: limit }),
    });
    close();
  };
  return (
    <Dialog title="Labels from a knowledge base" close={close}>
      {bases.length === 0 ? (
        <p>
          There is no knowledge base in {session.state.value?.folder} yet. Make one below, of
          recordings whose segments have names.
        </p>
      ) : (
        <form onSubmit={transfer}>
          <p class="quiet">
            A knowledge base is a file of movements that have names. Each primitive without a name
            takes that of the most similar one in it, if it is similar enough.
          </p>
          <label class="field">
            <span>Knowledge base</span>
            <Select
              value={base}
              options={bases.map(({ id, name }) => [id, name])}
              onSelect={(id) => (chosen.value = id)}
            />
          </label>
          <label class="field">
            <span>Largest distance at which two movements are the same</span>
            <TextInput
              type="number"
              min="0.01"
              max="1"
              step="0.01"
              placeholder="as usual"
              value={threshold}
            />
          </label>
          <Checkbox checked={spread.value} onCheck={(checked) => (spread.value = checked)}>
            Give each cluster the name that most of its members got
          </Checkbox>
          <p class="actions">
            <button type="submit" class="primary">
              Transfer labels
            </button>
          </p>
        </form>
      )}
      <NewKnowledge />
    </Dialog>
  );
}
