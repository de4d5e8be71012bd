/** Choose another result to compare with: a preset's or a label file's. */
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { useStudio, type DialogProps } from "../context";
import type { AnnotatorChoice, CompareRequest, Version } from "../../messages";
import { Button, Checkbox, Dialog, toggleMember, useBusy, WorkButton } from "../../layout/controls";
import { formatCount } from "../../util";
import { describeEdit } from "../editing/edits";
import { Table } from "../../layout/tables";

export function CompareDialog({ close }: DialogProps) {
  const { session } = useStudio();
  const [busy, run] = useBusy();
  const { presets = [], annotations = [] } = session.state.value ?? {};
  const compare = (name: string, request: CompareRequest): Promise<void> =>
    run(name, async () => {
      if (await session.comparisons.compare(request)) close();
    });
  return (
    <Dialog title="Compare with another result" close={close}>
      <p class="quiet">Its segments are laid below the shown ones, with how well they agree.</p>
      <h2>Several people’s labels, over the folder</h2>
      <PeopleChoice close={close} />
      <h2>What a preset finds</h2>
      <Table
        class="methods"
        rows={presets.map(({ name, help }) => ({
          key: name,
          cells: [
            <WorkButton name={name} busy={busy} work={() => compare(name, { preset: name })} />,
            <span class="quiet">{help}</span>,
          ],
        }))}
      />
      <h2>A label file of the folder</h2>
      <div class="choices">
        {annotations.map(({ id, name }) => (
          <span class="group" key={id}>
            <WorkButton name={name} busy={busy} work={() => compare(name, { annotation: id })} />
            <Button
              aria-label={`Work on ${name}: it becomes the table`}
              title="It becomes the table you work on; the present one is kept in History"
              disabled={busy !== ""}
              onClick={() => {
                void session.edited.value?.edit({ kind: "take_labels", annotation: id });
                close();
              }}
            >
              Work on it
            </Button>
          </span>
        ))}
        {annotations.length === 0 && (
          <p class="quiet">
            There is none in {session.state.value?.folder}. Put a segment table or a label file
            there (CSV, JSON, ELAN, Praat, Audacity, …), or drop it on this page.
          </p>
        )}
      </div>
    </Dialog>
  );
}

const TABLES_HERE = "tables"; // id of the tables edited here

/** Choose whose labels to compare; by default those of all people. */
function PeopleChoice({ close }: { close: () => void }) {
  const { session, view } = useStudio();
  const people = useSignal<AnnotatorChoice[]>([]);
  const ticked = useSignal<ReadonlySet<string>>(new Set());
  const [busy, run] = useBusy();
  useEffect(() => {
    void session.notifications.attempt("agreement", async () => {
      const found = await session.api.loadAnnotators();
      const others = found.filter(({ id }) => id !== TABLES_HERE);
      people.value = found;
      // A comparison needs two: with a single other person, tick the tables edited here, too.
      ticked.value = new Set((others.length > 1 ? others : found).map(({ id }) => id));
    });
  }, [session, people, ticked]);
  const compare = async (): Promise<void> => {
    if (!(await session.people.compare([...ticked.value]))) return;
    view.tab.value = "compare";
    view.folder.value = null;
    close();
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
        disabled={busy !== "" || ticked.value.size < 2}
        onClick={() => void run("people", compare)}
        busy={busy !== ""}
      >
        Compare {ticked.value.size} people
      </Button>
    </div>
  );
}

/** List replaced tables of the recording, to compare or restore. */
export function VersionsDialog({ close }: DialogProps) {
  const { session } = useStudio();
  const versions = useSignal<Version[] | null>(null);
  const edited = session.edited.value;
  useEffect(() => {
    if (!edited) return;
    void session.notifications.attempt("versions", async () => {
      versions.value = (await session.api.loadVersions(edited.id)).versions;
    });
  }, [edited, session, versions]);
  const fps = edited?.confirmed.value.fps ?? 1;
  const look = (version: Version): Promise<boolean> =>
    session.notifications.attempt("versions", async () => {
      const found = await session.api.loadVersion(edited!.id, version.number);
      session.comparisons.showBelow({ ...found, name: `Version ${version.number}` }, true);
      close();
    });
  return (
    <Dialog title="Tables that were replaced" close={close}>
      <p class="quiet">
        Every table that another one took the place of is kept. Undo goes back edit by edit; here,
        whole tables come back, and what is shown now is kept in turn.
      </p>
      {versions.value?.length === 0 && <p>No table of this recording has been replaced yet.</p>}
      <Table
        class="formats versions"
        rows={(versions.value ?? []).map((version) => ({
          key: version.number,
          cells: [
            <span class="quiet">{new Date(version.at).toLocaleString()}</span>,
            <>
              {version.edit ? `last: ${describeEdit(version.edit, fps)}` : "as it was found"}
              <br />
              <span class="quiet">
                {formatCount(version.segments, "segment")}, {formatCount(version.names, "name")},{" "}
                {formatCount(version.corrections, "correction")}
              </span>
            </>,
            <span class="group">
              <Button onClick={() => void look(version)}>Look</Button>
              <Button
                onClick={() => {
                  void edited?.edit({ kind: "restore", version: version.number });
                  close();
                }}
              >
                Bring back
              </Button>
            </span>,
          ],
        }))}
      />
    </Dialog>
  );
}
