/** Transfer labels from a knowledge base of the folder. */
import { useSignal } from "@preact/signals";
import { useStudio, type DialogProps } from "../context";
import {
  Button,
  Checkbox,
  Dialog,
  Field,
  Form,
  Select,
  TextInput,
  toggleMember,
  useBusy,
} from "../../layout/controls";

export function TransferDialog({ close }: DialogProps) {
  const { session } = useStudio();
  const bases = session.state.value?.knowledge_bases ?? [];
  const chosen = useSignal("");
  const base = chosen.value || (bases[0]?.id ?? "");
  const threshold = useSignal("");
  const spread = useSignal(true);
  const transfer = (): void => {
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
        <Form onSubmit={transfer}>
          <p class="quiet">
            A knowledge base is a file of movements that have names. Each primitive without a name
            takes that of the most similar one in it, if it is similar enough.
          </p>
          <Field title="Knowledge base">
            <Select
              value={base}
              options={bases.map(({ id, name }) => [id, name])}
              onSelect={(id) => (chosen.value = id)}
            />
          </Field>
          <Field title="Largest distance at which two movements are the same">
            <TextInput
              type="number"
              min="0.01"
              max="1"
              step="0.01"
              placeholder="as usual"
              value={threshold}
            />
          </Field>
          <Checkbox checked={spread.value} onCheck={(checked) => (spread.value = checked)}>
            Give each cluster the name that most of its members got
          </Checkbox>
          <p class="actions">
            <Button type="submit" class="primary">
              Transfer labels
            </Button>
          </p>
        </Form>
      )}
      <NewKnowledge />
    </Dialog>
  );
}

/** Create a knowledge base from recordings with named segments. */
function NewKnowledge() {
  const { session } = useStudio();
  const named = (session.state.value?.recordings ?? []).filter((each) => each.named > 0);
  const excluded = useSignal<ReadonlySet<string>>(new Set());
  const name = useSignal("moves");
  const [busy, run] = useBusy();
  const makeKnowledge = (): Promise<boolean> =>
    session.notifications.attempt("knowledge", async () => {
      const recordings = named.map(({ id }) => id).filter((id) => !excluded.value.has(id));
      const made = await session.api.makeKnowledge({ name: name.value.trim(), recordings });
      session.notifications.tell(
        `${made.name} is in the folder: other recordings can take its names.`,
      );
      await session.refresh();
    });
  return (
    <Form onSubmit={() => void run("knowledge", makeKnowledge)}>
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
        <Button
          type="submit"
          disabled={busy !== "" || !name.value.trim() || !named.length}
          busy={busy !== ""}
        >
          Make it
        </Button>
      </p>
    </Form>
  );
}
