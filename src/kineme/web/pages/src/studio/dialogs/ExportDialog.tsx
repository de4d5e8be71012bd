/** Export the segments in any format that the package writes. */
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { useStudio } from "../context";
import type { Level } from "../../messages";
import { saveFile } from "../server/api";
import { Dialog, type DialogProps } from "./Dialog";
import { Button } from "../../layout/controls";

const CHOICES: readonly (readonly [Level | "", string])[] = [
  ["", "activities and primitives, if it holds both"],
  ["activity", "activities alone"],
  ["primitive", "primitives alone"],
];

export function ExportDialog({ close }: DialogProps) {
  const { session } = useStudio();
  const level = useSignal<Level | "">("");
  const all = useSignal(false);
  const busy = useSignal("");
  useEffect(() => void session.refresh(), [session]);
  const recordings = session.state.value?.recordings ?? [];
  const done = recordings.filter((each) => session.list.isChecked(each)).length;
  const write = async (format: string): Promise<void> => {
    const edited = session.edited.value;
    if (!edited) return;
    busy.value = format;
    await session.notifications.attempt("export", async () => {
      const { api } = session;
      const asked = all.value
        ? api.exportAll(format, level.value)
        : api.exportSegments(edited.id, format, level.value);
      saveFile(await asked);
    });
    busy.value = "";
  };
  return (
    <Dialog title="Write the segments as a file" close={close}>
      <fieldset>
        {CHOICES.map(([each, title]) => (
          <label class="check" key={each}>
            <input
              type="radio"
              name="level"
              checked={level.value === each}
              onChange={() => (level.value = each)}
            />
            {title}
          </label>
        ))}
      </fieldset>
      <fieldset>
        <label class="check">
          <input type="radio" name="of" checked={!all.value} onChange={() => (all.value = false)} />
          this recording
        </label>
        <label class="check">
          <input
            type="radio"
            name="of"
            checked={all.value}
            disabled={!done}
            onChange={() => (all.value = true)}
          />
          every recording that is checked ({done} of {recordings.length}), as one ZIP
        </label>
      </fieldset>
      <table class="formats">
        <tbody>
          {session.state.value?.export_formats.map(({ name, suffix, help }) => (
            <tr key={name}>
              <td>
                <Button
                  data-format={name}
                  disabled={busy.value !== ""}
                  onClick={() => void write(name)}
                  busy={busy.value === name}
                >
                  {name}
                </Button>
              </td>
              <td class="quiet">{suffix}</td>
              <td>{help}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </Dialog>
  );
}
