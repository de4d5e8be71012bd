/**
 * Preset and the few parameters that matter. A change shows what it would find below what is
 * there; a button makes it the table, and says what becomes of corrections and names.
 */
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";
import type { Parameter, PresetChoice, Segments } from "../../messages";
import type { EditedRecording } from "../editing/editedRecording";
import { counted } from "../editing/words";
import type { Choice, Proposal } from "../editing/beside";
import type { Session } from "../session";

const PAUSE = 120; // milliseconds without a change before the server is asked

type Values = Record<string, number>;

export function PresetPanel({ session }: { session: Session }): JSX.Element | null {
  const state = session.state.value;
  const edited = session.edited.value;
  if (!state || !edited) return null;
  const signals = edited.confirmed.value.motion === null;
  return (
    <Presets
      key={edited.id}
      session={session}
      edited={edited}
      presets={signals ? state.presets.map(ofSignals) : state.presets}
      fallback={state.default_preset}
    />
  );
}

interface Props {
  session: Session;
  edited: EditedRecording;
  presets: PresetChoice[];
  fallback: string;
}

function Presets({ session, edited, presets, fallback }: Props): JSX.Element {
  const draft = useSignal<Choice | null>(null);
  const keep = useSignal(true);
  const timer = useRef(0);
  const { revision, segmentation: table } = edited.confirmed.value;
  const proposal = session.beside.proposal.value;
  const busy = edited.busy.value || draft.value !== null;
  const used = usedBy(table, presets, fallback);
  const { preset, values } = draft.value ?? proposal?.choice ?? used;
  const choice = presets.find((each) => each.name === preset)!;

  const again = (next: Choice, pause: number): void => {
    draft.value = next;
    window.clearTimeout(timer.current);
    timer.current = window.setTimeout(() => {
      void session.beside.propose(next, keep.value).then(() => {
        if (draft.value === next) draft.value = null;
      });
    }, pause);
  };
  useEffect(() => () => window.clearTimeout(timer.current), []);
  useEffect(() => {
    if (proposal && proposal.revision !== revision) again(proposal.choice, 0); // of another table
  }, [revision]);
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
      {proposal && (
        <Proposed
          session={session}
          proposal={proposal}
          keep={keep.value}
          setKeep={(wanted) => {
            keep.value = wanted;
            again(proposal.choice, 0);
          }}
        />
      )}
    </section>
  );
}

/** What the shown segmentation would do to the table, and the choice to make it. */
function Proposed(props: {
  session: Session;
  proposal: Proposal;
  keep: boolean;
  setKeep: (keep: boolean) => void;
}): JSX.Element {
  const { session, proposal, keep, setKeep } = props;
  const { preview } = proposal;
  const own = `${counted(preview.corrections, "correction")}, ${counted(preview.names, "name")}`;
  const some = preview.corrections + preview.names > 0;
  return (
    <div class="proposed" role="group" aria-label="Preview">
      <p class="quiet">
        Shown below what is there; borders that differ are marked. Nothing has been changed.
      </p>
      {some && (
        <label class="check">
          <input
            type="checkbox"
            checked={keep}
            onChange={(event) => setKeep(event.currentTarget.checked)}
          />
          Take over {own}
        </label>
      )}
      {some && keep && preview.lost.length > 0 && (
        <details open>
          <summary>{counted(preview.lost.length, "name")} would be lost</summary>
          <ul>
            {preview.lost.map((what) => (
              <li key={what}>{what}</li>
            ))}
          </ul>
        </details>
      )}
      <p class="actions">
        <button type="button" onClick={() => session.beside.discard()}>
          Discard
        </button>
        <button
          type="button"
          class="primary"
          disabled={keep !== proposal.keep}
          onClick={() => session.beside.apply()}
        >
          {some ? (keep ? "Apply" : `Apply: replaces ${own}`) : "Apply"}
        </button>
      </p>
    </div>
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
