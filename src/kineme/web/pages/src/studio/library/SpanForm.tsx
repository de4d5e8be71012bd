/** Edit the searched span and the largest distance. */
import type { JSX } from "preact";
import { NumberInput } from "../../layout/NumberInput";
import type { Span } from "../../messages";
import { formatSeconds } from "./hits";
import type { LibraryPage } from "./libraryPage";
import { Button, Checkbox } from "../../layout/controls";

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
  return (
    <form
      class="tools"
      onSubmit={(event) => {
        event.preventDefault();
        const given = page.span.value ?? span; // Enter also commits the focused field
        const title = `${given.recording} ${given.start_s} to ${given.stop_s} s`;
        if (valid) void page.startSearch({ title, like: [given], unlike: [] });
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
            {formatSeconds(each.duration_s)}
          </option>
        ))}
      </datalist>
      <Field label="from, s" value={start_s} change={(start_s) => change({ start_s })} />
      <Field label="to, s" value={stop_s} change={(stop_s) => change({ stop_s })} />
      <Field
        label="largest distance"
        value={page.threshold.value}
        change={(threshold) => {
          if (threshold > 0) page.threshold.value = threshold;
        }}
      />
      <Checkbox checked={page.mirror.value} onCheck={(checked) => (page.mirror.value = checked)}>
        mirrored, too
      </Checkbox>
      <button type="submit" class="primary" disabled={!valid}>
        Find more like this
      </button>
      {page.question.value && (
        <Button onClick={() => void page.searchAgain()}>The last search again</Button>
      )}
    </form>
  );
}

function Field(props: {
  label: string;
  value: number;
  change: (value: number) => void;
}): JSX.Element {
  return (
    <label>
      {props.label} <NumberInput step="any" min={0} value={props.value} onNumber={props.change} />
    </label>
  );
}
