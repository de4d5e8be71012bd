/**
 * Preset and the few parameters that matter. A change shows what it would find below what is
 * there; a button makes it the table, and says what becomes of corrections and names.
 */
import { signal, useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useCallback, useEffect, useRef } from "preact/hooks";
import { useStudio } from "../context";
import type { Parameter, PresetChoice, Segments } from "../../messages";
import type { EditedRecording } from "../editing/editedRecording";
import { DetailSlider } from "../../layout/DetailSlider";
import type { Choice } from "../editing/beside";
import { ParameterSlider } from "./ParameterSlider";
import { Proposed } from "./Proposed";
import { RunProgress } from "./RunProgress";
import { Button, Select } from "../../layout/controls";

/** Whether the constants are shown, beside preset and detail: of all recordings. */
const advanced = signal(false);

const PAUSE = 120; // milliseconds without a change before the server is asked

type Values = Record<string, number>;

export function PresetPanel(): JSX.Element | null {
  const { session } = useStudio();
  const state = session.state.value;
  const edited = session.edited.value;
  if (!state || !edited) return null;
  const signals = edited.confirmed.value.motion === null;
  return (
    <Presets
      key={edited.id}
      edited={edited}
      presets={signals ? state.presets.map(ofSignals) : state.presets}
      fallback={state.default_preset}
      details={state.details}
    />
  );
}

interface Props {
  edited: EditedRecording;
  presets: PresetChoice[];
  fallback: string;
  details: number[];
}

function Presets({ edited, presets, fallback, details }: Props): JSX.Element {
  const { session } = useStudio();
  const { draft } = session.beside;
  const keep = useSignal(true);
  const timer = useRef(0);
  const { revision, segmentation: table } = edited.confirmed.value;
  const proposal = session.beside.proposal.value;
  const busy = session.segmenting.value;
  const used = usedBy(table, presets, fallback);
  const { preset, values, detail } = draft.value ?? proposal?.choice ?? used;
  const choice = presets.find((each) => each.name === preset)!;

  /** Whether a preset has found the table: not where people made it, or where that was cancelled. */
  const isFound = typeof table.provenance.preset === "string";
  const isUsual = detail === 1 && choice.parameters.every((each) => isDefault(each, values));

  const again = useCallback(
    (next: Choice, pause: number): void => {
      draft.value = next;
      window.clearTimeout(timer.current);
      timer.current = window.setTimeout(() => {
        if (draft.peek() === next) void session.beside.propose(next, keep.value); // else cancelled
      }, pause);
    },
    [session, draft, keep],
  );
  useEffect(
    () => () => {
      window.clearTimeout(timer.current);
      session.beside.cancel();
    },
    [session],
  );
  useEffect(() => {
    if (proposal && proposal.revision !== revision) again(draft.peek() ?? proposal.choice, 0); // of another table
  }, [proposal, revision, again, draft]);
  const change = (parameter: Parameter, value: number): void => {
    const { minimum, maximum } = parameter;
    if (!Number.isFinite(value)) return;
    const bounded = Math.min(Math.max(value, minimum), maximum);
    again({ preset, values: { ...values, [parameter.name]: bounded }, detail }, PAUSE);
  };
  const levels = {
    all: proposal && !draft.value ? proposal.preview.details : details,
    detail,
    choose: (next: number) => again({ preset, values, detail: next }, PAUSE),
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
          onClick={() => again({ preset, values: defaults(choice), detail: 1 }, 0)}
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
            again({ preset: next.name, values: defaults(next), detail: 1 }, 0);
          }}
        />
        <p class="preset-help quiet">{choice.help}</p>
        <DetailSlider />
        <details
          class="advanced"
          open={advanced.value}
          onToggle={(event) => (advanced.value = event.currentTarget.open)}
        >
          <summary>Advanced</summary>
          {choice.parameters.map((parameter) => (
            <ParameterSlider
              key={`${preset}.${parameter.name}`}
              parameter={parameter}
              value={values[parameter.name] ?? parameter.value}
              change={(value) => change(parameter, value)}
            />
          ))}
        </details>
      </div>
      {proposal && (
        <Proposed
          proposal={proposal}
          keep={keep.value}
          setKeep={(keeps) => {
            keep.value = keeps;
            again(proposal.choice, 0);
          }}
        />
      )}
    </section>
  );
}

/** What signals are offered: lengths in their own unit, which their tables are in, too. */
function ofSignals(choice: PresetChoice): PresetChoice {
  return { ...choice, parameters: choice.signal_parameters };
}

/** The preset and values a table was made with; the preset's own where it does not say. */
function usedBy(table: Segments, presets: PresetChoice[], fallback: string): Choice {
  const { preset: name, parameters, detail } = table.provenance;
  const choice =
    presets.find((each) => each.name === name) ?? presets.find((each) => each.name === fallback)!;
  const values = defaults(choice);
  if (choice.name === name && typeof parameters === "object" && parameters !== null)
    for (const key of Object.keys(values)) {
      const value = (parameters as Record<string, unknown>)[key];
      if (typeof value === "number") values[key] = value;
    }
  return { preset: choice.name, values, detail: typeof detail === "number" ? detail : 1 };
}

function defaults(choice: PresetChoice): Values {
  return Object.fromEntries(choice.parameters.map(({ name, value }) => [name, value]));
}

function isDefault({ name, value, step }: Parameter, values: Values): boolean {
  return Math.abs((values[name] ?? value) - value) < step / 2;
}
