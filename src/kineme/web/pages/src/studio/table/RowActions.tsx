/** Edit or export all selected rows as one step. */
import { useSignal } from "@preact/signals";
import { useStudio } from "../context";
import type { ByHand } from "../../messages";
import { getTarget } from "../editing/commands";
import { findRow } from "../../segments";
import { saveFile } from "../server/api";
import { type Row, findSpansToMerge } from "./rows";
import { Button, TextInput } from "../../layout/controls";

export function RowActions({ rows }: { rows: Row[] }) {
  const { session, editor } = useStudio();
  const busy = useSignal(false);
  const exportClips = async (loops: boolean): Promise<void> => {
    const edited = session.edited.value;
    if (!edited) return;
    busy.value = true;
    await session.notifications.attempt("clips", async () => {
      await edited.waitUntilSent(); // pending edits may move rows
      const { segmentation } = edited.confirmed.value;
      const present = rows.map(({ segment }) => findRow(segmentation, segment));
      const numbers = present.map((row) => segmentation.segments.indexOf(row!));
      const there = numbers.filter((number) => number >= 0);
      saveFile(await session.api.exportClips(edited.id, { rows: there, loops }));
    });
    busy.value = false;
  };
  const cluster = rows[0]?.segment.cluster ?? -1;
  const divisible =
    cluster >= 0 &&
    rows.every(
      ({ segment }) => segment.cluster === cluster && segment.level === rows[0]?.segment.level,
    );
  const name = useSignal("");
  const merges = findSpansToMerge(rows);
  const checked = rows.length > 0 && rows.every(({ segment }) => segment.checked);
  const segments = rows.map(({ segment }) => segment);
  return (
    <div class="table-actions">
      <form
        onSubmit={(event) => {
          event.preventDefault();
          const label = name.value.trim();
          const edits = segments.map((each): ByHand => {
            return { kind: "name_segment", ...getTarget(each), label };
          });
          editor.sendTogether(edits, `named “${label}”`);
        }}
      >
        <TextInput aria-label="Name for all chosen" placeholder="name" value={name} />
        <button type="submit">Name {rows.length}</button>
      </form>
      <Button
        disabled={!merges.length}
        title="Neighbours become one segment"
        onClick={() =>
          editor.sendTogether(
            merges.map(({ level, start, stop }) => {
              return { kind: "merge", level, start_frame: start, stop_frame: stop };
            }),
            "merged",
          )
        }
      >
        Merge
      </Button>
      <Button onClick={() => editor.setChecked(segments, !checked)}>
        {checked ? "Uncheck" : "Check"}
      </Button>
      <Button
        disabled={!divisible}
        title="The chosen ones become a cluster of their own"
        onClick={() =>
          editor.edit({
            kind: "split_cluster",
            cluster,
            frames: segments.map(({ start_frame }) => start_frame),
          })
        }
      >
        New cluster
      </Button>
      <Button
        disabled={busy.value}
        title="The chosen segments as motion files"
        onClick={() => void exportClips(false)}
      >
        Clips…
      </Button>
      <Button
        disabled={busy.value}
        title="The same, each made to close, so that it can be repeated without a jerk"
        onClick={() => void exportClips(true)}
      >
        Loops…
      </Button>
    </div>
  );
}

/** Open the list of loops. */
export function LoopsButton() {
  const { session, view } = useStudio();
  return (
    <Button
      disabled={!session.edited.value || !session.store.recording.value?.motion}
      title="Which repetitions make good loops: seam, sliding feet, turn and speed"
      onClick={() => view.show("loops")}
    >
      Loops by quality…
    </Button>
  );
}
