/** Export the segments in any format that the package writes. */
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { Button, Dialog, RadioGroup, useBusy } from "../../layout/controls";
import { Table } from "../../layout/tables";
import type { Level } from "../../messages";
import { type DialogProps, useStudio } from "../context";
import { saveFile } from "../server/api";

const CHOICES: readonly (readonly [Level | "", string])[] = [
  ["", "activities and primitives, if it holds both"],
  ["activity", "activities alone"],
  ["primitive", "primitives alone"],
];

export function ExportDialog({ close }: DialogProps) {
  const { session } = useStudio();
  const level = useSignal<Level | "">("");
  const scope = useSignal<"one" | "all">("one");
  const [busy, run] = useBusy();
  useEffect(() => void session.refresh(), [session]);
  const recordings = session.state.value?.recordings ?? [];
  const done = recordings.filter((each) => session.list.isChecked(each)).length;
  const write = (format: string): Promise<void> =>
    run(format, async () => {
      const { api, notifications } = session;
      const edited = session.edited.value;
      if (edited)
        await notifications.attempt("export", async () => {
          const isAll = scope.value === "all";
          saveFile(
            await (isAll
              ? api.exportAll(format, level.value)
              : api.exportSegments(edited.id, format, level.value)),
          );
        });
    });
  const scopes = [
    ["one", "this recording"],
    [
      "all",
      `every recording that is checked (${done} of ${recordings.length}), as one ZIP`,
      done === 0,
    ],
  ] as const;
  return (
    <Dialog title="Write the segments as a file" close={close}>
      <RadioGroup
        name="level"
        value={level.value}
        options={CHOICES}
        onSelect={(chosen) => (level.value = chosen)}
      />
      <RadioGroup
        name="of"
        value={scope.value}
        options={scopes}
        onSelect={(chosen) => (scope.value = chosen)}
      />
      <Table
        class="formats"
        rows={(session.state.value?.export_formats ?? []).map(({ name, suffix, help }) => ({
          key: name,
          cells: [
            <Button
              data-format={name}
              disabled={busy !== ""}
              onClick={() => void write(name)}
              busy={busy === name}
            >
              {name}
            </Button>,
            <span class="quiet">{suffix}</span>,
            help,
          ],
        }))}
      />
    </Dialog>
  );
}
