/** A field for a name: Enter or leaving it takes the name, Escape leaves it as it was. */
import type { JSX, Ref } from "preact";

interface Props {
  value: string;
  placeholder?: string;
  label?: string;
  /** The id of a list of names to offer. */
  list?: string;
  field?: Ref<HTMLInputElement>;
  onName: (name: string) => void;
  onDone?: () => void;
}

export function NameInput({
  value,
  placeholder = "no name",
  label,
  list,
  field,
  onName,
  onDone,
}: Props): JSX.Element {
  return (
    <input
      ref={field ?? null}
      type="text"
      placeholder={placeholder}
      aria-label={label}
      list={list}
      defaultValue={value}
      onKeyDown={(event) => {
        if (event.key === "Escape") event.currentTarget.value = value;
        if (event.key === "Enter" || event.key === "Escape") event.currentTarget.blur();
      }}
      onBlur={(event) => {
        const name = event.currentTarget.value.trim();
        if (name !== value) onName(name);
        onDone?.();
      }}
    />
  );
}
