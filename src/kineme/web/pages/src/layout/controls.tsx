/** Buttons and fields that all pages use. */
import { useSignal, type Signal } from "@preact/signals";
import type {
  ComponentChildren,
  ComponentProps,
  Ref,
  TargetedEvent,
  TargetedKeyboardEvent,
} from "preact";
import { useLayoutEffect, useRef } from "preact/hooks";
import { NO_COLOR } from "../colors";
import { theme, toggleTheme } from "../drawing";
import { findDetailIndex, useStore } from "../store";

/** Render a button that submits no form; `busy` adds a spinner. */
export function Button(props: ComponentProps<"button"> & { busy?: boolean }) {
  const { busy = false, children, ...rest } = props;
  return (
    <button type="button" {...rest}>
      {children}
      {busy && <span class="busy" />}
    </button>
  );
}

/** Render a button that switches a signal on and off. */
export function Toggle({ on, ...rest }: ComponentProps<"button"> & { on: Signal<boolean> }) {
  const onClick = (): void => void (on.value = !on.value);
  return <Button aria-pressed={on.value} onClick={onClick} {...rest} />;
}

/** Render a form that the page submits by itself. */
export function Form({ onSubmit, ...rest }: ComponentProps<"form"> & { onSubmit: () => void }) {
  return (
    <form
      {...rest}
      onSubmit={(event) => {
        event.preventDefault();
        onSubmit();
      }}
    />
  );
}

/** Render a titled field. */
export function Field(props: { title: string; tooltip?: string; children: ComponentChildren }) {
  return (
    <label class="field" title={props.tooltip}>
      <span>{props.title}</span>
      {props.children}
    </label>
  );
}

/** Render a cross that closes or removes something. */
export function CloseButton(props: { label: string; title?: string; onClick: () => void }) {
  const { label, title = label, onClick } = props;
  return (
    <Button class="icon" aria-label={label} title={title} onClick={onClick}>
      ×
    </Button>
  );
}

/** Render a small square in the colour of a cluster or label, if it has one. */
export function Swatch({ color }: { color: string | null | undefined }) {
  return <span class="swatch" style={{ background: color ?? NO_COLOR }} />;
}

type TextInputProps = Omit<ComponentProps<"input">, "value"> & { value: Signal<string> };

/** Edit a text signal. */
export function TextInput({ value, ...rest }: TextInputProps) {
  return (
    <input
      type="text"
      {...(rest as object)} // its type is a union that cannot be spread
      value={value.value}
      onInput={(event) => (value.value = event.currentTarget.value)}
    />
  );
}

/** Select one of several values; `label` is the accessible name if no visible label exists. */
export function Select<Value extends string | number>(props: {
  label?: string;
  value: Value;
  options: readonly (readonly [value: Value, text: string])[];
  onSelect: (value: Value) => void;
}) {
  const { label, value, options, onSelect } = props;
  return (
    <select
      {...(label && { "aria-label": label })}
      value={value}
      onChange={({ currentTarget }) => onSelect(options[currentTarget.selectedIndex]![0])}
    >
      {options.map(([each, text]) => (
        <option key={each} value={each}>
          {text}
        </option>
      ))}
    </select>
  );
}

/** Render a checkbox with its label. */
export function Checkbox(props: {
  checked: boolean;
  title?: string;
  onCheck: (checked: boolean) => void;
  children: ComponentChildren;
}) {
  const { checked, title, onCheck, children } = props;
  return (
    <label class="check" {...(title && { title })}>
      <input
        type="checkbox"
        checked={checked}
        onChange={(event) => onCheck(event.currentTarget.checked)}
      />
      {children}
    </label>
  );
}

/** Choose one of several values by radio buttons, named `name` in their form. */
export function RadioGroup<Value extends string>(props: {
  name: string;
  value: Value;
  options: readonly (readonly [value: Value, text: string, disabled?: boolean])[];
  onSelect: (value: Value) => void;
}) {
  const { name, value, options, onSelect } = props;
  return (
    <fieldset>
      {options.map(([each, text, disabled = false]) => (
        <label class="check" key={each}>
          <input
            type="radio"
            name={name}
            checked={value === each}
            disabled={disabled}
            onChange={() => onSelect(each)}
          />
          {text}
        </label>
      ))}
    </fieldset>
  );
}

/** Show a modal dialog; Escape and a click outside close it. */
export function Dialog(props: { title: string; close: () => void; children: ComponentChildren }) {
  const { title, close, children } = props;
  const dialog = useRef<HTMLDialogElement>(null);
  useLayoutEffect(() => dialog.current?.showModal(), []);
  return (
    <dialog
      ref={dialog}
      aria-label={title}
      onClose={close}
      onClick={(event) => event.target === dialog.current && close()}
    >
      <div class="dialog-body">
        <div class="panel-head">
          <h1>{title}</h1>
          <span class="spacer" />
          <CloseButton label="Close" onClick={close} />
        </div>
        {children}
      </div>
    </dialog>
  );
}

/** Return the name of the work that is being done, "" if none, and a function that does one. */
export function useBusy(): [string, (name: string, work: () => Promise<unknown>) => Promise<void>] {
  const busy = useSignal("");
  const run = async (name: string, work: () => Promise<unknown>): Promise<void> => {
    busy.value = name;
    try {
      await work();
    } finally {
      busy.value = "";
    }
  };
  return [busy.value, run];
}

/** Render a button that starts a task, and shows while that task runs (its name is in `busy`). */
export function WorkButton(
  props: ComponentProps<"button"> & { name: string; busy: string; work: () => Promise<void> },
) {
  const { name, busy, work, ...rest } = props;
  return (
    <Button disabled={busy !== ""} busy={busy === name} onClick={() => void work()} {...rest}>
      {name}
    </Button>
  );
}

/** Return the set with a value added, or removed if it is a member. */
export function toggleMember<Value>(chosen: ReadonlySet<Value>, value: Value): ReadonlySet<Value> {
  const next = new Set(chosen);
  if (!next.delete(value)) next.add(value);
  return next;
}

type Field = HTMLInputElement | HTMLTextAreaElement;

interface DraftProps {
  value: string;
  onFocus: (event: TargetedEvent<Field>) => void;
  onInput: (event: TargetedEvent<Field>) => void;
  onChange: () => void;
  onBlur: () => void;
  onKeyDown: (event: TargetedKeyboardEvent<Field>) => void;
}

/**
 * Return the properties of a field that shows its draft while focused and `value` otherwise. Each
 * change calls the `onText` that was current when the field got the focus: meanwhile playback or an
 * edit may have put another segment into the panel. Escape discards the draft.
 */
export function useDraft(value: string, onText: (text: string) => void): DraftProps {
  const draft = useSignal<string | null>(null);
  const initial = useRef({ value, onText });
  const commit = (): void => {
    const text = draft.value;
    if (text === null || text === initial.current.value) return;
    initial.current.value = text;
    initial.current.onText(text);
  };
  return {
    value: draft.value ?? value,
    onFocus: (event) => {
      initial.current = { value, onText };
      draft.value = event.currentTarget.value;
    },
    onInput: (event) => (draft.value = event.currentTarget.value),
    onChange: commit,
    onBlur: () => {
      commit();
      draft.value = null;
    },
    onKeyDown: (event) => {
      const isTextArea = event.currentTarget instanceof HTMLTextAreaElement;
      if (event.key === "Escape") draft.value = null;
      if (event.key === "Escape" || (event.key === "Enter" && (!isTextArea || event.ctrlKey)))
        event.currentTarget.blur();
    },
  };
}

interface NameInputProps {
  value: string;
  placeholder?: string;
  "aria-label"?: string;
  /** Id of a datalist with suggestions. */
  list?: string;
  field?: Ref<HTMLInputElement>;
  onName: (name: string) => void;
  onDone?: () => void;
}

/** Edit a name; Enter or leaving the field saves it, Escape restores it. */
export function NameInput({ value, field, onName, onDone, ...rest }: NameInputProps) {
  const draft = useDraft(value, (text) => text.trim() !== value && onName(text.trim()));
  return (
    <input
      ref={field ?? null}
      type="text"
      placeholder="no name"
      {...rest}
      {...draft}
      onBlur={() => {
        draft.onBlur();
        onDone?.();
      }}
    />
  );
}

interface NumberInputProps {
  value: number;
  "aria-label"?: string;
  min?: number;
  max?: number;
  step?: number | "any";
  /** Called with a finite number when the field is left or Enter is pressed. */
  onNumber: (value: number) => void;
}

/** Edit a number; Enter or leaving the field saves it, Escape restores it. */
export function NumberInput({ value, onNumber, ...rest }: NumberInputProps) {
  const draft = useDraft(String(value), (text) => {
    const number = Number(text);
    if (text.trim() && Number.isFinite(number)) onNumber(number);
  });
  return <input {...rest} type="number" class="number" {...draft} />;
}

const PATHS = {
  play: "M4 2.5v11l9-5.5z",
  pause: "M4 2.5h3v11H4zM9 2.5h3v11H9z",
  back: "M11.5 2.5v11L4.5 8z",
  on: "M4.5 2.5v11l7-5.5z",
  before: "M2.5 2.5h2v11h-2zM13 2.5v11L5.5 8z",
  after: "M11.5 2.5h2v11h-2zM3 2.5v11l7.5-5.5z",
  loop: "M4 4.5h6.5V2l4 3.5-4 3.5V6.5H5.5v2h-2V5zM12 11.5H5.5V14l-4-3.5 4-3.5v2.5h5v-2h2V11z",
  minus: "M3 7h10v2H3z",
  plus: "M7 3h2v4h4v2H9v4H7V9H3V7h4z",
  fit: "M2 3h2v10H2zM12 3h2v10h-2zM5 8l2.5-2.5v1.7h1V5.5L11 8l-2.5 2.5V8.8h-1v1.7z",
  full: "M2 2h5v2H4v3H2zM9 2h5v5h-2V4H9zM2 9h2v3h3v2H2zM12 9h2v5H9v-2h3z",
  theme: "M8 2a6 6 0 1 0 0 12zM8 2a6 6 0 1 1 0 12v-1.4a4.6 4.6 0 1 0 0-9.2z",
} as const;

export type Icon = keyof typeof PATHS;

interface IconButtonProps {
  icon: Icon;
  /** Accessible name and tooltip. */
  label: string;
  keys?: string;
  pressed?: boolean;
  onClick: () => void;
}

export function IconButton({ icon, label, keys, pressed, onClick }: IconButtonProps) {
  return (
    <Button
      class="icon"
      aria-label={label}
      title={keys ? `${label} (${keys})` : label}
      onClick={onClick}
      {...(pressed !== undefined && { "aria-pressed": pressed })}
    >
      <svg width="16" height="16" viewBox="0 0 16 16" fill="currentColor" aria-hidden="true">
        <path d={PATHS[icon]} />
      </svg>
    </Button>
  );
}

/** Render a button that switches between the dark and the light theme. */
export function ThemeButton() {
  const other = theme.value === "dark" ? "light" : "dark";
  return <IconButton icon="theme" label={`Show the page ${other}`} onClick={toggleTheme} />;
}

/** Choose how fine the segments are. */
export function DetailSlider() {
  const store = useStore();
  const levels = store.levels.value;
  if (!levels || levels.all.length < 2) return null;
  const { all, detail, choose } = levels;
  const description = detail === 1 ? "as usual" : detail < 1 ? "coarser" : "finer";
  return (
    <label class="detail" title="How fine the segments are (comma coarser, full stop finer)">
      <span>
        Detail <span class="quiet">{description}</span>
      </span>
      <span class="number">{Number(detail.toFixed(3))}</span>
      <input
        type="range"
        aria-label="Detail"
        aria-valuetext={`${detail}, ${description}`}
        min={0}
        max={all.length - 1}
        step={1}
        value={findDetailIndex(detail, all)}
        onInput={(event) => choose(all[event.currentTarget.valueAsNumber]!)}
      />
    </label>
  );
}
