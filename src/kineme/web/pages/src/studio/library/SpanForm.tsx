/** A recording, from when to when, and how near a hit must be. */
import type { JSX } from "preact";
import type { Span } from "../../messages";
import { seconds } from "./hits";
import type { LibraryPage } from "./libraryPage";

export function SpanForm({ page }: { page: LibraryPage }): JSX.Element {
  const recordings = (page.state.value?.recordings ?? []).filter((each) => each.vocabulary);
  const first = recordings[0];
  const span: Span = page.span.value ?? {
    recording: first?.recording ?? "",
    start_s: 0,
    stop_s: Math.min(3, first?.duration_s ?? 3),
  };
  const change = (some: Partial<Span>): void => void (page.span.value = { ...span, ...some });
  const exists = recordings.some((each) => each.recording === span.recording);
  const { start_s, stop_s, recording } = span;
  const valid = exists && start_s >= 0 && stop_s > start_s;
  const title = `${recording} ${start_s} to ${stop_s} s`;
  return (
    <form
      class="tools"
      onSubmit={(event) => {
        event.preventDefault();
        if (valid) void page.ask({ title, like: [span], unlike: [] });
      }}
    >
      <label>
        Recording{" "}
        <input
          type="text"
          list="library-recordings"
          value={recording}
          onInput={(event) => change({ recording: event.currentTarget.value })}
        />
      </label>
      <datalist id="library-recordings">
        {recordings.slice(0, 500).map((each) => (
          <option key={each.recording} value={each.recording}>
            {seconds(each.duration_s)}
          </option>
        ))}
      </datalist>
      <Field label="from, s" value={start_s} change={(start_s) => change({ start_s })} />
      <Field label="to, s" value={stop_s} change={(stop_s) => change({ stop_s })} />
      <Field
        label="largest distance"
        value={page.threshold.value}
        change={(threshold) => threshold > 0 && (page.threshold.value = threshold)}
      />
      <label>
        <input
          type="checkbox"
          checked={page.mirror.value}
          onChange={(event) => (page.mirror.value = event.currentTarget.checked)}
        />{" "}
        mirrored, too
      </label>
      <button type="submit" class="primary" disabled={!valid}>
        Find more like this
      </button>
      {page.question.value && (
        <button type="button" onClick={() => void page.searchAgain()}>
          The last search again
        </button>
      )}
    </form>
  );
}

function Field(props: {
  label: string;
  value: number;
  change: (value: number) => unknown;
}): JSX.Element {
  return (
    <label>
      {props.label}{" "}
      <input
        type="number"
        step="any"
        min="0"
        value={props.value}
        onInput={(event) => {
          const value = event.currentTarget.valueAsNumber;
          if (Number.isFinite(value)) props.change(value);
        }}
      />
    </label>
  );
}
