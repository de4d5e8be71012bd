/** Choose another result to compare with: a preset's or a label file's. */
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect } from "preact/hooks";
import { useStudio } from "../context";
import type { CompareRequest } from "../../messages";
import { PeopleChoice } from "../people/PeopleChoice";
import { Dialog, type DialogProps } from "./Dialog";
import { Button } from "../../layout/controls";

export function CompareDialog({ close }: DialogProps): JSX.Element {
  const { session } = useStudio();
  const busy = useSignal("");
  useEffect(() => void session.refresh(), [session]); // files may have been added
  const { presets = [], annotations = [] } = session.state.value ?? {};
  const compare = async (name: string, request: CompareRequest): Promise<void> => {
    busy.value = name;
    if (await session.comparisons.compare(request)) close();
    busy.value = "";
  };
  return (
    <Dialog title="Compare with another result" close={close}>
      <p class="quiet">Its segments are laid below the shown ones, with how well they agree.</p>
      <h2>Several people’s labels, over the folder</h2>
      <PeopleChoice close={close} />
      <h2>What a preset finds</h2>
      <table class="methods">
        <tbody>
          {presets.map(({ name, help }) => (
            <tr key={name}>
              <td>
                <Button
                  disabled={busy.value !== ""}
                  onClick={() => void compare(name, { preset: name })}
                  busy={busy.value === name}
                >
                  {name}
                </Button>
              </td>
              <td class="quiet">{help}</td>
            </tr>
          ))}
        </tbody>
      </table>
      <h2>A label file of the folder</h2>
      <div class="choices">
        {annotations.map(({ id, name }) => (
          <span class="group" key={id}>
            <Button
              disabled={busy.value !== ""}
              onClick={() => void compare(name, { annotation: id })}
              busy={busy.value === name}
            >
              {name}
            </Button>
            <Button
              aria-label={`Work on ${name}: it becomes the table`}
              title="It becomes the table you work on; the present one is kept in History"
              disabled={busy.value !== ""}
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
