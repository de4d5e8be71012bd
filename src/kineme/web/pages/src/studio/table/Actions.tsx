/** What is done to all chosen rows of the table, as one step. */
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useStudio } from "../context";
import type { ByHand } from "../../messages";
import { placeOf } from "../editing/commands";
import { findRow } from "../../segments";
import { save } from "../server/save";
import { type Row, spansToMerge } from "./rows";
import { Button } from "../../layout/controls";

export function Actions({ rows }: { rows: Row[] }): JSX.Element {
  const { session, editor } = useStudio();
  const busy = useSignal(false);
  const clips = async (loops: boolean): Promise<void> => {
    const edited = session.edited.value;
    if (!edited) return;
    busy.value = true;
    await session.bulletin.attempt("clips", async () => {
      await edited.settled(); // edits on their way may move rows
      const { segmentation } = edited.confirmed.value;
      const present = rows.map(({ segment }) => findRow(segmentation, segment));
      const numbers = present.map((row) => segmentation.segments.indexOf(row!));
      const there = numbers.filter((number) => number >= 0);
      save(await session.api.clips(edited.id, { rows: there, loops }));
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
  const merges = spansToMerge(rows);
  const checked = rows.length > 0 && rows.every(({ segment }) => segment.checked);
  const segments = rows.map(({ segment }) => segment);
  return (
    <div class="table-actions">
      <form
        onSubmit={(event) => {
          event.preventDefault();
          const label = name.value.trim();
          const edits = segments.map((each): ByHand => {
            return { kind: "name_segment", ...placeOf(each), label };
          });
          editor.together(edits, `named “${label}”`);
        }}
      >
        <input
          type="text"
          aria-label="Name for all chosen"
          placeholder="name"
          value={name.value}
          onInput={(event) => (name.value = event.currentTarget.value)}
        />
        <button type="submit">Name {rows.length}</button>
      </form>
      <Button
        disabled={!merges.length}
        title="Neighbours become one segment"
        onClick={() =>
          editor.together(
            merges.map(({ level, start, stop }) => {
              return { kind: "merge", level, start_frame: start, stop_frame: stop };
            }),
            "merged",
          )
        }
      >
        Merge
      </Button>
      <Button onClick={() => editor.check(segments, !checked)}>
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
        onClick={() => void clips(false)}
      >
        Clips…
      </Button>
      <Button
        disabled={busy.value}
        title="The same, each made to close, so that it can be repeated without a jerk"
        onClick={() => void clips(true)}
      >
        Loops…
      </Button>
    </div>
  );
}

/** A way to the list of loops, which needs no rows. */
export function LoopsButton(): JSX.Element {
  const { session, front } = useStudio();
  return (
    <Button
      disabled={!session.edited.value || !session.store.recording.value?.motion}
      title="Which repetitions make good loops: seam, sliding feet, turn and speed"
      onClick={() => front.show("loops")}
    >
      Loops by quality…
    </Button>
  );
}
