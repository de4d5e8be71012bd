/** Buttons and fields that all pages use. */
import type { Signal } from "@preact/signals";
import type { ComponentChildren, ComponentProps, JSX } from "preact";

/** Render a button that submits no form; `busy` adds a spinner. */
export function Button(props: ComponentProps<"button"> & { busy?: boolean }): JSX.Element {
  const { busy = false, children, ...rest } = props;
  return (
    <button type="button" {...rest}>
      {children}
      {busy && <span class="busy" />}
    </button>
  );
}

/** Render a cross that closes or removes something. */
export function CloseButton(props: {
  label: string;
  title?: string;
  onClick: () => void;
}): JSX.Element {
  const { label, title = label, onClick } = props;
  return (
    <Button class="icon" aria-label={label} title={title} onClick={onClick}>
      ×
    </Button>
  );
}

/** Render a small square in the colour of a cluster or label. */
export function Swatch({ color }: { color: string }): JSX.Element {
  return <span class="swatch" style={{ background: color }} />;
}

/** Render the head of a table; a column is its title, or title and tooltip. */
export function TableHead(props: {
  columns: readonly (string | readonly [title: string, tooltip: string])[];
}): JSX.Element {
  return (
    <thead>
      <tr>
        {props.columns.map((column) => {
          const [title, tooltip] = typeof column === "string" ? [column] : column;
          return (
            <th key={title} {...(title && { scope: "col" })} {...(tooltip && { title: tooltip })}>
              {title}
            </th>
          );
        })}
      </tr>
    </thead>
  );
}

type TextInputProps = Omit<ComponentProps<"input">, "value"> & { value: Signal<string> };

/** Edit a text signal. */
export function TextInput({ value, ...rest }: TextInputProps): JSX.Element {
  return (
    <input
      type="text"
      {...(rest as object)} // its type is a union that cannot be spread
      value={value.value}
      onInput={(event) => (value.value = event.currentTarget.value)}
    />
  );
}

interface SelectProps<Value extends string | number> {
  /** Accessible name, if no visible label exists. */
  label?: string;
  value: Value;
  options: readonly (readonly [value: Value, text: string])[];
  onSelect: (value: Value) => void;
}

/** Select one of several values. */
export function Select<Value extends string | number>(props: SelectProps<Value>): JSX.Element {
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
}): JSX.Element {
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

/** Return the set with a value added, or removed if it is a member. */
export function toggleMember<Value>(chosen: ReadonlySet<Value>, value: Value): ReadonlySet<Value> {
  const next = new Set(chosen);
  if (!next.delete(value)) next.add(value);
  return next;
}
