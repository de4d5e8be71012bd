/** Preset and the few parameters that matter; a change segments the recording again. */
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useRef } from "preact/hooks";
import type { Parameter, PresetChoice, Segments } from "../../messages";
import type { EditedRecording } from "../editing/editedRecording";
import type { Session } from "../session";

const PAUSE = 120; // milliseconds without a change before the server is asked

type Values = Record<string, number>;

interface Choice {
  preset: string;
  values: Values;
}

export function PresetPanel({ session }: { session: Session }): JSX.Element | null {
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
    />
  );
}

interface Props {
  edited: EditedRecording;
  presets: PresetChoice[];
  fallback: string;
}

function Presets({ edited, presets, fallback }: Props): JSX.Element {
  const draft = useSignal<Choice | null>(null);
  const timer = useRef(0);
  const table = edited.confirmed.value.segmentation;
  const busy = edited.busy.value;
  const { preset, values } = draft.value ?? onItsWay(edited) ?? usedBy(table, presets, fallback);
  const choice = presets.find((each) => each.name === preset)!;

  const again = (next: Choice, pause: number): void => {
    draft.value = next;
    window.clearTimeout(timer.current);
    timer.current = window.setTimeout(() => {
      edited.edit({ kind: "segment", preset: next.preset, parameters: next.values });
      draft.value = null;
    }, pause);
  };
  const change = (parameter: Parameter, value: number): void => {
    const { minimum, maximum } = parameter;
    if (!Number.isFinite(value)) return;
    const bounded = Math.min(Math.max(value, minimum), maximum);
    again({ preset, values: { ...values, [parameter.name]: bounded } }, PAUSE);
  };
  return (
    <section class="preset-panel" aria-label="Segmentation" aria-busy={busy}>
      <div class="panel-head">
        <h2>Segmentation</h2>
        {busy && <span class="busy" role="status" aria-label="Segmenting" />}
        <span class="spacer" />
        <button
          type="button"
          title="The preset’s own values"
          disabled={choice.parameters.every((each) => isDefault(each, values))}
          onClick={() => again({ preset, values: defaults(choice) }, 0)}
        >
          Reset
        </button>
      </div>
      <select
        aria-label="Preset"
        value={preset}
        title={choice.help}
        onChange={(event) => {
          const next = presets.find((each) => each.name === event.currentTarget.value)!;
          again({ preset: next.name, values: defaults(next) }, 0);
        }}
      >
        {presets.map(({ name }) => (
          <option key={name} value={name}>
            {name}
          </option>
        ))}
      </select>
      {choice.parameters.map((parameter) => (
        <Slider
          key={`${preset}.${parameter.name}`}
          parameter={parameter}
          value={values[parameter.name] ?? parameter.value}
          change={(value) => change(parameter, value)}
        />
      ))}
    </section>
  );
}

function Slider(props: {
  parameter: Parameter;
  value: number;
  change: (value: number) => void;
}): JSX.Element {
  const { parameter, value, change } = props;
  const { name, help, minimum, maximum, step, unit } = parameter;
  const title = name.replaceAll("_", " ");
  return (
    <div class="parameter" title={help}>
      <label for={`parameter-${name}`}>
        {title} <span class="quiet">{unit}</span>
      </label>
      <input
        type="number"
        aria-label={unit ? `${title} in ${unit}` : title}
        min={minimum}
        max={maximum}
        step={rounded(step)}
        value={rounded(value)}
        onChange={(event) => change(event.currentTarget.valueAsNumber)}
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

/** What signals are offered: lengths in their own unit, which their tables are in, too. */
function ofSignals(choice: PresetChoice): PresetChoice {
  return { ...choice, parameters: choice.signal_parameters };
}

/** The preset and values that were asked for and have not been answered. */
function onItsWay(edited: EditedRecording): Choice | null {
  const edit = edited.waiting.value.findLast((each) => each.edit.kind === "segment")?.edit;
  return edit?.kind === "segment" ? { preset: edit.preset, values: edit.parameters } : null;
}

/** The preset and values a table was made with; the preset's own where it does not say. */
function usedBy(table: Segments, presets: PresetChoice[], fallback: string): Choice {
  const { preset: name, parameters } = table.provenance;
  const choice =
    presets.find((each) => each.name === name) ?? presets.find((each) => each.name === fallback)!;
  const values = defaults(choice);
  if (choice.name === name && typeof parameters === "object" && parameters !== null)
    for (const key of Object.keys(values)) {
      const value = (parameters as Record<string, unknown>)[key];
      if (typeof value === "number") values[key] = value;
    }
  return { preset: choice.name, values };
}

function defaults(choice: PresetChoice): Values {
  return Object.fromEntries(choice.parameters.map(({ name, value }) => [name, value]));
}

function isDefault({ name, value, step }: Parameter, values: Values): boolean {
  return Math.abs((values[name] ?? value) - value) < step / 2;
}

function rounded(value: number): number {
  return Number(value.toFixed(3));
}
