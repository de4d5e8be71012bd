/** The table of repetitions; on paper it follows the pictures. */
import { type ReadonlySignal, useSignal, useSignalEffect } from "@preact/signals";
import { counted } from "../counted";
import type { JSX } from "preact";
import type { Recording } from "../messages";
import { useStore } from "../context";
import { NO_COLOR } from "../colors";
import { durationOf, nameOf } from "../segments";
import { onPaper } from "../theme";
import { clock } from "../view";
import { repetitionsOf } from "./repetitions";
import { Button } from "../layout/controls";

export function Repetitions({ of }: { of: ReadonlySignal<Recording | undefined> }): JSX.Element {
  const store = useStore();
  const table = of.value?.segmentation;
  const rows = table ? repetitionsOf(table) : [];
  if (!rows.length) return <p class="empty quiet">Nothing repeats itself here.</p>;
  const out = rows.reduce((sum, { leftOut }) => sum + leftOut.filter(Boolean).length, 0);
  return (
    <table class="repetitions">
      {out > 0 && (
        <caption class="quiet">{counted(out, "repetition")} left out of means by hand.</caption>
      )}
      <thead>
        <tr>
          <th scope="col">Activity</th>
          <th scope="col">Start</th>
          <th scope="col">Length</th>
          <th scope="col">Times</th>
          <th scope="col" title="Mean and standard deviation">
            Mean ± sd
          </th>
          <th scope="col">Each, in seconds</th>
        </tr>
      </thead>
      <tbody>
        {rows.map(({ activity, durations, leftOut, mean, deviation }) => (
          <tr key={activity.start_frame}>
            <th scope="row">
              <Button class="plain" onClick={() => store.select(activity)}>
                <span class="swatch" style={{ background: store.colorOf(activity) ?? NO_COLOR }} />
                {nameOf(activity)}
              </Button>
            </th>
            <td class="number">{clock(activity.start_s, 1)}</td>
            <td class="number">{durationOf(activity).toFixed(1)} s</td>
            <td class="number">{timesOf(leftOut)}</td>
            <td class="number">
              {mean?.toFixed(2)}
              {deviation !== null && ` ± ${deviation.toFixed(2)}`}
            </td>
            <td class="each">
              {durations.map((each, i) => [
                i > 0 && "  ",
                leftOut[i] ? <s title="left out by hand">{each.toFixed(2)}</s> : each.toFixed(2),
              ])}
            </td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}

const PAUSE = 500; // milliseconds

/** How often, and where some are left out how many of them are in the mean. */
function timesOf(leftOut: readonly boolean[]): string {
  const counted = leftOut.filter((each) => !each).length;
  return counted < leftOut.length ? `${counted} of ${leftOut.length}` : `${counted}`;
}

/** What is printed below the pictures: what was found in what, and the repetitions. */
export function Paper(): JSX.Element | null {
  const store = useStore();
  const rested = useRested(store.recording);
  const recording = rested.value;
  if (!recording) return null;
  const { provenance } = recording.segmentation;
  return (
    <section class="paper" aria-hidden="true">
      <p>
        {clock(recording.n_frames / recording.fps, 1)}, {recording.n_frames} frames at{" "}
        {Number(recording.fps.toPrecision(5))} Hz
        {typeof provenance.preset === "string" && `, segmented by ${provenance.preset}`}
      </p>
      <h2>Repetitions</h2>
      <Repetitions of={rested} />
    </section>
  );
}

/** The recording once edits of it have rested, or at once where it is printed: its table is long. */
function useRested(
  present: ReadonlySignal<Recording | undefined>,
): ReadonlySignal<Recording | undefined> {
  const rested = useSignal(present.peek());
  useSignalEffect(() => {
    const { value } = present;
    const take = (): void => void (rested.value = value);
    if (!rested.peek() || onPaper.value) take();
    const timer = setTimeout(take, PAUSE);
    return () => clearTimeout(timer);
  });
  return rested;
}
