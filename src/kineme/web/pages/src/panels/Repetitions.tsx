/** Show the table of repetitions, on the page and in print. */
import { useSignal, useSignalEffect, type ReadonlySignal } from "@preact/signals";
import { formatCount } from "../util";
import type { Recording } from "../messages";
import { useStore } from "../store";
import { getDuration, getSegmentName, listRepetitions } from "../segments";
import { isPrinting } from "../drawing";
import { formatTime } from "../view";
import { Button, Swatch } from "../layout/controls";
import { Table } from "../layout/tables";

const PAUSE = 500; // milliseconds without an edit before the printed table is renewed
const COLUMNS = [
  "Activity",
  "Start",
  "Length",
  "Times",
  ["Mean ± sd", "Mean and standard deviation"],
  "Each, in seconds",
] as const;

export function Repetitions(props: { recording: ReadonlySignal<Recording | undefined> }) {
  const store = useStore();
  const table = props.recording.value?.segmentation;
  const rows = table ? listRepetitions(table) : [];
  if (!rows.length) return <p class="empty quiet">Nothing repeats itself here.</p>;
  const out = rows.reduce((sum, { leftOut }) => sum + leftOut.filter(Boolean).length, 0);
  return (
    <Table
      class="repetitions number"
      caption={
        out > 0 && (
          <span class="quiet">{formatCount(out, "repetition")} left out of means by hand.</span>
        )
      }
      columns={COLUMNS}
      rows={rows.map(({ activity, durations, leftOut, mean, deviation }) => ({
        key: activity.start_frame,
        head: (
          <Button class="plain" onClick={() => store.select(activity)}>
            <Swatch color={store.getColor(activity)} />
            {getSegmentName(activity)}
          </Button>
        ),
        cells: [
          formatTime(activity.start_s, 1),
          `${getDuration(activity).toFixed(1)} s`,
          formatTimes(leftOut),
          `${mean?.toFixed(2) ?? ""}${deviation === null ? "" : ` ± ${deviation.toFixed(2)}`}`,
          durations.map((each, i) => [
            i > 0 && "  ",
            leftOut[i] ? <s title="left out by hand">{each.toFixed(2)}</s> : each.toFixed(2),
          ]),
        ],
      }))}
    />
  );
}

/** Return the number of repetitions that count, and of all if some are excluded. */
function formatTimes(leftOut: readonly boolean[]): string {
  const counted = leftOut.filter((each) => !each).length;
  return counted < leftOut.length ? `${counted} of ${leftOut.length}` : `${counted}`;
}

/** Show what is printed below the pictures. */
export function PrintedReport() {
  const store = useStore();
  const settled = useSettled(store.recording);
  const recording = settled.value;
  if (!recording) return null;
  const { provenance } = recording.segmentation;
  return (
    <section class="paper" aria-hidden="true">
      <p>
        {formatTime(recording.n_frames / recording.fps, 1)}, {recording.n_frames} frames at{" "}
        {Number(recording.fps.toPrecision(5))} Hz
        {typeof provenance.preset === "string" && `, segmented by ${provenance.preset}`}
      </p>
      <h2>Repetitions</h2>
      <Repetitions recording={settled} />
    </section>
  );
}

/** Return the recording once edits pause, or at once for printing: its table is long. */
function useSettled(
  present: ReadonlySignal<Recording | undefined>,
): ReadonlySignal<Recording | undefined> {
  const settled = useSignal(present.peek());
  useSignalEffect(() => {
    const { value } = present;
    const take = (): void => void (settled.value = value);
    if (!settled.peek() || isPrinting.value) take();
    const timer = setTimeout(take, PAUSE);
    return () => clearTimeout(timer);
  });
  return settled;
}
