/** A field for a name: Enter or leaving it takes the name, Escape leaves it as it was. */
import type { JSX, Ref } from "preact";
import { useDraft } from "./draft";

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
  const draft = useDraft(value, (text) => text.trim() !== value && onName(text.trim()));
  return (
    <input
      ref={field ?? null}
      type="text"
      placeholder={placeholder}
      aria-label={label}
      list={list}
      {...draft}
      onBlur={() => {
        draft.onBlur();
        onDone?.();
      }}
    />
  );
}
