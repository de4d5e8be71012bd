/** The buttons and fields of every page. */
import type { ComponentChildren, ComponentProps, JSX } from "preact";

/** A button that sends no form; `busy` while what it began is under way. */
export function Button(props: ComponentProps<"button"> & { busy?: boolean }): JSX.Element {
  const { busy = false, children, ...rest } = props;
  return (
    <button type="button" {...rest}>
      {children}
      {busy && <span class="busy" />}
    </button>
  );
}

/** A cross that takes something away. */
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

interface SelectProps<Value extends string | number> {
  /** What it chooses, where no visible label says so. */
  label?: string;
  value: Value;
  options: readonly (readonly [value: Value, text: string])[];
  onSelect: (value: Value) => void;
}

/** A choice of one of some values. */
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

/** A box to tick, and what it says. */
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

/** The values with one more, or without that one. */
export function toggled<Value>(chosen: ReadonlySet<Value>, value: Value): ReadonlySet<Value> {
  const next = new Set(chosen);
  if (!next.delete(value)) next.add(value);
  return next;
}
