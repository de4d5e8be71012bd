/** Export the segments in any format that the package writes. */
import { useSignal } from "@preact/signals";
import { Dialog, RadioGroup, useBusy, WorkButton } from "../../layout/controls";
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
  const recordings = session.state.value?.recordings ?? [];
  const done = recordings.filter((each) => session.list.getStatus(each) === "checked").length;
  const write = (format: string): Promise<void> =>
    run(format, async () => {
      const { api, notifications } = session;
      const id = session.edited.value?.id;
      if (!id) return;
      await notifications.attempt("export", async () =>
        saveFile(
          scope.value === "all"
            ? await api.exportAll(format, level.value)
            : await api.exportSegments(id, format, level.value),
        ),
      );
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
            <WorkButton name={name} busy={busy} data-format={name} work={() => write(name)} />,
            <span class="quiet">{suffix}</span>,
            help,
          ],
        }))}
      />
    </Dialog>
  );
}
