/** Choose a preset and its parameters; a change shows a preview, a button applies it. */
import { signal, useSignal } from "@preact/signals";
import { useCallback, useEffect, useRef } from "preact/hooks";
import { useStudio } from "../context";
import type { Parameter, PresetChoice, Segments, Progress, State } from "../../messages";
import type { EditedRecording } from "../editing/editedRecording";
import { DetailSlider, Button, Select, Checkbox, NumberInput } from "../../layout/controls";
import type { SegmentationChoice, Proposal } from "../editing/comparisons";
import { formatCount } from "../../util";

/** Whether the parameters are shown, for all recordings. */
const showsAdvanced = signal(false);

const PAUSE = 120; // milliseconds without a change before a preview is requested

export function PresetPanel() {
  const { session } = useStudio();
  const state = session.state.value;
  const edited = session.edited.value;
  return state && edited && <Presets key={edited.id} edited={edited} state={state} />;
}

function Presets({ edited, state }: { edited: EditedRecording; state: State }) {
  const { session } = useStudio();
  const { draft } = session.comparisons;
  const keep = useSignal(true);
  const timer = useRef(0);
  const { revision, segmentation: table, motion } = edited.confirmed.value;
  // The lengths of parameters for signals are in another unit.
  const presets =
    motion === null
      ? state.presets.map((each) => ({ ...each, parameters: each.signal_parameters }))
      : state.presets;
  const proposal = session.comparisons.proposal.value;
  const busy = session.segmenting.value;
  const used = readChoice(table, presets, state.default_preset);
  const { preset, values, detail } = draft.value ?? proposal?.choice ?? used;
  const choice = presets.find((each) => each.name === preset)!;

  /** Whether a preset produced the table; not if people made it or the run was cancelled. */
  const isFound = typeof table.provenance.preset === "string";
  const isUsual =
    detail === 1 &&
    choice.parameters.every(
      ({ name, value, step }) => Math.abs((values[name] ?? value) - value) < step / 2,
    );

  const requestPreview = useCallback(
    (next: SegmentationChoice, pause: number): void => {
      draft.value = next;
      window.clearTimeout(timer.current);
      timer.current = window.setTimeout(() => {
        // Else it was cancelled.
        if (draft.peek() === next) void session.comparisons.propose(next, keep.value);
      }, pause);
    },
    [session, draft, keep],
  );
  useEffect(
    () => () => {
      window.clearTimeout(timer.current);
      session.comparisons.cancel();
    },
    [session],
  );
  useEffect(() => {
    // The preview was of another table.
    if (proposal && proposal.revision !== revision)
      requestPreview(draft.peek() ?? proposal.choice, 0);
  }, [proposal, revision, requestPreview, draft]);
  const changeParameter = ({ name, minimum, maximum }: Parameter, value: number): void => {
    if (!Number.isFinite(value)) return;
    const bounded = Math.min(Math.max(value, minimum), maximum);
    requestPreview({ preset, values: { ...values, [name]: bounded }, detail }, PAUSE);
  };
  const levels = {
    all: proposal && !draft.value ? proposal.preview.details : state.details,
    detail,
    choose: (next: number) => requestPreview({ preset, values, detail: next }, PAUSE),
  };
  useEffect(() => void (session.store.levels.value = levels));
  useEffect(() => () => void (session.store.levels.value = null), [session]);
  return (
    <section class="preset-panel" aria-label="Segmentation" aria-busy={busy}>
      <div class="panel-head">
        <h2>Segmentation</h2>
        {busy && <span class="busy" role="status" aria-label="Segmenting" />}
        <span class="spacer" />
        <Button
          title={isFound ? "The preset’s own values" : "Segments by this preset, to look at"}
          disabled={isFound ? isUsual : busy || proposal !== null}
          onClick={() => requestPreview({ preset, values: getDefaults(choice), detail: 1 }, 0)}
        >
          {isFound ? "Reset" : "Segment"}
        </Button>
      </div>
      {busy && <RunProgress id={edited.id} />}
      <div class="preset-choice">
        <Select
          label="Preset"
          value={preset}
          options={presets.map(({ name }) => [name, name])}
          onSelect={(chosen) => {
            const next = presets.find(({ name }) => name === chosen)!;
            requestPreview({ preset: next.name, values: getDefaults(next), detail: 1 }, 0);
          }}
        />
        <p class="preset-help quiet">{choice.help}</p>
        <DetailSlider />
        <details
          class="advanced"
          open={showsAdvanced.value}
          onToggle={(event) => (showsAdvanced.value = event.currentTarget.open)}
        >
          <summary>Advanced</summary>
          {choice.parameters.map((parameter) => (
            <ParameterSlider
              key={`${preset}.${parameter.name}`}
              parameter={parameter}
              value={values[parameter.name] ?? parameter.value}
              change={(value) => changeParameter(parameter, value)}
            />
          ))}
        </details>
      </div>
      {proposal && (
        <ProposalPanel
          proposal={proposal}
          keep={keep.value}
          setKeep={(keeps) => {
            keep.value = keeps;
            requestPreview(proposal.choice, 0);
          }}
        />
      )}
    </section>
  );
}

/** Return the preset and values that produced a table, with defaults for missing ones. */
function readChoice(
  table: Segments,
  presets: PresetChoice[],
  fallback: string,
): SegmentationChoice {
  const { preset: name, parameters, detail } = table.provenance;
  const choice =
    presets.find((each) => each.name === name) ?? presets.find((each) => each.name === fallback)!;
  const values = getDefaults(choice);
  if (choice.name === name && typeof parameters === "object" && parameters !== null)
    for (const key of Object.keys(values)) {
      const value = (parameters as Record<string, unknown>)[key];
      if (typeof value === "number") values[key] = value;
    }
  return { preset: choice.name, values, detail: typeof detail === "number" ? detail : 1 };
}

function getDefaults(choice: PresetChoice): SegmentationChoice["values"] {
  return Object.fromEntries(choice.parameters.map(({ name, value }) => [name, value]));
}

/** Show the consequences of a previewed segmentation, and apply or discard it. */
function ProposalPanel(props: {
  proposal: Proposal;
  keep: boolean;
  setKeep: (keep: boolean) => void;
}) {
  const { session } = useStudio();
  const { proposal, keep, setKeep } = props;
  const { preview } = proposal;
  const counts = `${formatCount(preview.corrections, "correction")}, ${formatCount(preview.names, "name")}`;
  const some = preview.corrections + preview.names > 0;
  return (
    <div class="proposed" role="group" aria-label="Preview">
      <div class="proposed-said">
        {some && (
          <Checkbox checked={keep} onCheck={setKeep}>
            Take over {counts}
          </Checkbox>
        )}
        {some && keep && preview.lost.length > 0 && (
          <details open>
            <summary>{formatCount(preview.lost.length, "name")} would be lost</summary>
            <ul>
              {preview.lost.map((what) => (
                <li key={what}>{what}</li>
              ))}
            </ul>
          </details>
        )}
        <p class="quiet">
          Shown below what is there; borders that differ are marked. Nothing has been changed.
        </p>
      </div>
      <p class="actions">
        <Button onClick={() => session.comparisons.discard()}>Discard</Button>
        <Button
          class="primary"
          disabled={keep !== proposal.keep}
          onClick={() => session.comparisons.apply()}
        >
          {some ? (keep ? "Apply" : `Apply: replaces ${counts}`) : "Apply"}
        </Button>
      </p>
    </div>
  );
}

/** Edit a preset's parameter with a number field and a slider. */
function ParameterSlider(props: {
  parameter: Parameter;
  value: number;
  change: (value: number) => void;
}) {
  const { parameter, value, change } = props;
  const { name, help, minimum, maximum, step, unit } = parameter;
  const title = name.replaceAll("_", " ");
  return (
    <div class="parameter" title={help}>
      <label for={`parameter-${name}`}>
        {title} <span class="quiet">{unit}</span>
      </label>
      <NumberInput
        aria-label={unit ? `${title} in ${unit}` : title}
        min={minimum}
        max={maximum}
        step={Number(step.toFixed(3))}
        value={Number(value.toFixed(3))}
        onNumber={change}
      />
      <input
        id={`parameter-${name}`}
        type="range"
        min={minimum}
        max={maximum}
        step={step}
        value={value}
        onInput={(event) => change(event.currentTarget.valueAsNumber)}
      />
    </div>
  );
}

const POLL_INTERVAL = 400; // milliseconds between requests, and before the first

/** Show a segmentation's progress, with a button to cancel. */
function RunProgress({ id }: { id: string }) {
  const { session } = useStudio();
  const progress = useSignal<Progress | null>(null);
  useEffect(() => {
    const timer = window.setInterval(() => {
      void session.api.loadProgress(id).then(
        (now) => (progress.value = now),
        () => undefined, // the page reports this already
      );
    }, POLL_INTERVAL);
    return () => window.clearInterval(timer);
  }, [session, id, progress]);
  if (!progress.value?.stage) return null;
  const { stage, share } = progress.value;
  const text = share === null ? stage : `${stage}, ${Math.round(100 * share)} %`;
  return (
    <div class="run-progress">
      <progress aria-label="Segmentation" value={share ?? undefined} />
      <Button title="What is there stays (Escape)" onClick={() => session.cancel()}>
        Cancel
      </Button>
      <span class="quiet">{text}</span>
    </div>
  );
}
